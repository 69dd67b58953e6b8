"""Faults of forces: the engine moves as it should, and its joint forces are wrong."""

from dataclasses import replace
from typing import Any

from models.scene.moved import scaled
from reports.compare.whole_errors import OF_STEPS
from reports.selftest import force_changes as change
from reports.selftest.fault import FOURBAR, SHAPER, SLIDER, Fault
from reports.selftest.free_changes import lighter_by, of_coupler, turning_light
from reports.selftest.log_faults import WHEN, noisy
from sim.registry import engine

SLIDING = (SLIDER, SHAPER)
START = slice(5, 39)
"""Samples of the start, in which an engine takes up its pins."""


def _fault(
    name: str,
    what: str,
    rule: str,
    changed: change.ForceChange,
    size: float | None = None,
    unit: str = "",
    forces_of: str = "",
    **more: Any,
) -> Fault:
    """Return a fault of logged forces, in all engines that log any, or of some kind."""
    needs = (lambda name: engine(name).forces_of == forces_of) if forces_of else change.gives
    plant = change.in_forces(changed)
    return Fault("force", name, what, rule, plant, size, unit, needs=needs, **more)


FAULTS = (
    _fault("force-sign", "all forces have the other sign", "CC120",
           change.each_force(lambda x, _: -x)),
    _fault("force-giver", "a pin's force said of the other body", "CC120", change.of_the_giver),
    _fault("force-body-frame", "vectors in the bodies' frames", "CC120", change.in_body_frame),
    _fault("force-turned", "x for y: a quarter of a turn", "CC120", change.turned_aside),
    _fault("force-half-step", "stamped too late", "CC120", change.stamped, 0.5, "steps"),
    _fault("force-late", "a row has the forces of a row before", "CC120", change.rows_late,
           1.0, "sample", whole=True),
    _fault("force-far", "stamped far from its sample", "CC115", change.stamped, 2.0, "steps"),
    _fault("pins-swapped", "two pins have each other's forces", "CC120", change.pins_swapped),
    _fault("no-inertia", "mass and inertia of a link left out", "CC120",
           change.of_another(of_coupler(lighter_by)), 1.0, "of it"),
    _fault("no-turning-inertia", "a link's inertia left out", "CC123",
           change.of_another(of_coupler(turning_light)), 1.0, "of it"),
    _fault("weight-added", "forces of a gravity that is not there", "CC120",
           change.of_another(change.weighed), 9.81, "m/s^2"),
    _fault("load-late", "a load over time is felt late", "CC120", change.of_load(change.load_late),
           1.0, "steps"),
    _fault("load-in-body", "a load felt in the body's frame", "CC120",
           change.of_load(change.load_in_body)),
    _fault("load-left-out", "a load is not felt", "CC120", change.of_load(lambda *_: None)),
    _fault("other-scene-forces", "forces of a larger scene", "CC120",
           change.of_another(lambda scene, share: scaled(scene, 1.0 + share)), 1e-2, "longer"),
    _fault("force-doubled", "all forces twice", "CC120",
           change.each_force(lambda x, by: x * (1.0 + by)), 1.0, "of it"),
    _fault("force-of-kgf", "forces in kgf", "CC120", change.each_force(lambda x, _: x / 9.80665)),
    _fault("pin-open", "a pin's forces do not add up to 0", "CC124", change.one_sided,
           1e-6, "of it"),
    _fault("normal-sign", "normal forces have the other sign", "CC121",
           lambda s, d, own, _: change.each_slider(own, lambda x: replace(x, normal=-x.normal)),
           scenes=SLIDING),
    _fault("moment-elsewhere", "moments about another point", "CC122", change.about_another_point,
           1e-1, "L off", scenes=SLIDING),
    _fault("flywheel-in", "the flywheel's share is in the torque", "CC123",
           change.of_torque(lambda torque, share: torque * (1.0 - share)), 1.0, "of it"),
    _fault("torque-off", "a torque of too much power", "CC123",
           change.of_torque(lambda torque, share: torque * (1.0 + share)), 1e-2, "of it"),
    _fault("torque-sign", "what the driver exerts on the drive", "CC123",
           change.of_torque(lambda x, _: -x)),
    _fault("force-smoothed", "the mean over some samples", "CC120",
           change.each_force(change.smoothed), 41.0, "samples", whole=True),
    _fault("force-noise", "noise on all forces (normal)", "CC120",
           lambda s, d, own, x: own.each_series(lambda f: noisy(f, x * change.largest_n(own))),
           1e-2, "F"),
    _fault("force-spike", "a reaction off at a sample", "CC120", change.spoilt_pin(WHEN),
           1e-2, "F"),
    _fault("force-start", "reactions off at the start", "CC116", change.spoilt_pin(START), 0.5, "F",
           forces_of="states"),
    _fault("force-first-steps", "reactions off in the first steps", "CC116",
           change.spoilt_pin(slice(1, OF_STEPS)), 2.0, "F", forces_of="steps"),
    _fault("force-rings", "reactions off after the first steps", "CC120",
           change.spoilt_pin(slice(OF_STEPS + 1, 39)), 1e-2, "F", forces_of="steps"),
    _fault("force-floor", "a reaction off, within the limit", "CC125",
           change.spoilt_pin(slice(None)), 1e-3, "F", scenes=(FOURBAR,), finer=True),
    _fault("forces-copied", "forces of the reference", "CC111", change.of_reference),
    _fault("force-nan", "a reaction not a number at the end", "CC109", change.nan_at_end),
    _fault("pin-missing", "a pin is not in the log", "CC109", change.without_last_pin),
    _fault("forces-missing", "no force is in the log", "CC109", lambda *_: None),
)  # fmt: skip
