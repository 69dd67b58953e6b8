"""Faults of forces: the engine moves as it should, and its joint forces are wrong.

A log without an inertia or a weight, or of another mechanism, is the healthy log with the
difference that kinetostatics makes of it.
"""

from collections.abc import Callable, Iterable
from dataclasses import replace
from itertools import chain, repeat
from typing import Any

import numpy as np

from analytic.forces.kinetostatics import forces
from models.array import Array
from models.motion import Forces, SliderForces
from models.scene import Scene
from models.scene.characteristics import Sine
from models.scene.loads import Load
from models.scene.moved import scaled
from reports.compare.whole_errors import OF_STEPS
from reports.selftest import fault
from reports.selftest.free_changes import lighter_by, of_coupler, turning_light
from reports.selftest.log_faults import WHEN, last, moved, noisy, spoilt
from sim.engine import Run
from sim.registry import engine

ForceChange = Callable[[Scene, Run, Forces, float], Forces | None]
"""Change of logged forces by a size."""


def in_forces(change: ForceChange) -> fault.Plant:
    """Change the forces of a healthy log by a size; leave them for a size of 0."""

    def changed(scene: Scene, done: Run, size: float) -> Run:
        motion = moved(done)
        if motion.forces is None or not size:
            return done
        forces = change(scene, done, motion.forces, size)
        return replace(done, motion=replace(motion, forces=forces))

    return fault.in_log(changed)


def each_force(change: Callable[[Array, float], Array]) -> ForceChange:
    """Change every series of forces by a size."""
    return lambda scene, done, own, size: own.each_series(lambda x: change(x, size))


def each_pin(own: Forces, change: Callable[[str, str, Array], Array]) -> Forces:
    """Change the reactions of every pin and body."""
    pins = {
        point: {body: change(point, body, force) for body, force in bodies.items()}
        for point, bodies in own.pins.items()
    }
    return replace(own, pins=pins)


def _last_pin(own: Forces, change: Callable[[list[Array]], Iterable[Array]]) -> Forces:
    """Change the reactions of the last pin, one of each body."""
    point, bodies = list(own.pins.items())[-1]
    changed = zip(bodies, change(list(bodies.values())), strict=True)
    return replace(own, pins={**own.pins, point: dict(changed)})


def each_slider(own: Forces, change: Callable[[SliderForces], SliderForces]) -> Forces:
    """Change the forces of the guides of all sliders."""
    return replace(own, sliders={name: change(slider) for name, slider in own.sliders.items()})


def largest_n(own: Forces) -> float:
    """Return the largest logged reaction [N]."""
    every = (force for bodies in own.pins.values() for force in bodies.values())
    return max(float(np.nanmax(np.abs(force))) for force in every)


def in_body_frame(_: Scene, done: Run, own: Forces, size: float) -> Forces:
    """Turn vectors into the frames of the bodies that they act on."""
    links = moved(done).links

    def turned(_: str, body: str, force: Array) -> Array:
        if body not in links:
            return force
        turn = np.exp(-1j * size * links[body].theta)
        there = (force @ np.array([1.0, 1j])) * turn
        return np.stack([there.real, there.imag], axis=-1)

    return each_pin(own, turned)


def stamped(_: Scene, done: Run, own: Forces, steps: float) -> Forces:
    return replace(own, time_s=own.time_s + steps * done.dt_s)


def rows_late(_: Scene, done: Run, own: Forces, samples: float) -> Forces:
    """Put into each row the forces of some samples before."""
    by = round(samples)
    return own.each_series(lambda x: np.concatenate([x[:by], x[:-by]]) if by else x)


def of_the_giver(_: Scene, done: Run, own: Forces, size: float) -> Forces:
    """Exchange the reactions of both bodies in the last pin."""
    return _last_pin(own, reversed)


def pins_swapped(_: Scene, done: Run, own: Forces, size: float) -> Forces:
    """Exchange the reactions of the last two pins of two bodies."""
    one, other = [point for point, bodies in own.pins.items() if len(bodies) == 2][-2:]
    there = {one: own.pins[other].values(), other: own.pins[one].values()}
    swapped = {
        point: dict(zip(own.pins[point], values, strict=True)) for point, values in there.items()
    }
    return replace(own, pins={**own.pins, **swapped})


def of_another(change: fault.SceneChange) -> ForceChange:
    """Return the forces that another scene would have, at the same instants."""
    return lambda scene, _, own, size: changed_by_scene(own, scene, change(scene, size))


def changed_by_scene(own: Forces, right: Scene, wrong: Scene) -> Forces:
    """Return the forces of a log, with the difference of a wrong scene to the right one."""
    times = np.where(np.isfinite(own.time_s), own.time_s, 0.0)
    before, after = (
        forces(each, times, bound=False, skip_dead_points=True) for each in (right, wrong)
    )
    pins = {
        point: {
            body: force + after.pins[point][body] - before.pins[point][body]
            for body, force in bodies.items()
        }
        for point, bodies in own.pins.items()
    }
    sliders = {
        name: SliderForces(
            slider.normal + after.sliders[name].normal - before.sliders[name].normal,
            slider.moment + after.sliders[name].moment - before.sliders[name].moment,
        )
        for name, slider in own.sliders.items()
    }
    torque = own.torque + after.torque - before.torque
    return replace(own, pins=pins, sliders=sliders, torque=torque)


def weighed(scene: Scene, more_m_s2: float) -> Scene:
    """Add to gravity."""
    x, y = scene.gravity_m_s2
    return replace(scene, gravity_m_s2=(x, y - more_m_s2))


def of_reference(scene: Scene, done: Run, own: Forces, size: float) -> Forces:
    """Put the reference's forces in the engine's place."""
    times = np.where(np.isfinite(own.time_s), own.time_s, 0.0)
    return forces(scene, times, bound=False, skip_dead_points=True)


def smoothed(series: Array, samples: float) -> Array:
    """Return the mean over so many samples around each."""
    reach = round(samples) // 2
    if not reach:
        return series
    rows = np.pad(series, [(reach, reach)] + [(0, 0)] * (series.ndim - 1), mode="edge")
    sums = np.cumsum(np.concatenate([np.zeros_like(rows[:1]), np.nan_to_num(rows)]), axis=0)
    width = 2 * reach + 1
    return np.asarray((sums[width:] - sums[:-width]) / width)


def about_another_point(scene: Scene, done: Run, own: Forces, share: float) -> Forces:
    """Take the moment about a point so far from the slider's along its line."""
    arm = share * scene.longest_m
    return each_slider(own, lambda one: replace(one, moment=one.moment + arm * one.normal))


def spoilt_pin(at: int | slice) -> ForceChange:
    """Change the reactions of the last pin at some samples, opposite on its bodies."""

    def changed(_: Scene, done: Run, own: Forces, share: float) -> Forces:
        off = share * largest_n(own)
        by = chain((-off, off), repeat(0.0))
        return _last_pin(own, lambda forces: [spoilt(x, at, next(by)) for x in forces])

    return changed


def one_sided(_: Scene, done: Run, own: Forces, share: float) -> Forces:
    """Let a pin push one of its bodies more than the other."""
    return _last_pin(own, lambda forces: [forces[0] * (1.0 + share), *forces[1:]])


def without_last_pin(_: Scene, done: Run, own: Forces, size: float) -> Forces:
    return replace(own, pins=dict(list(own.pins.items())[:-1]))


def nan_at_end(_: Scene, done: Run, own: Forces, size: float) -> Forces:
    return _last_pin(own, lambda forces: [spoilt(x, slice(-1, None), np.nan) for x in forces])


def of_torque(change: Callable[[Array, float], Array]) -> ForceChange:
    return lambda scene, done, own, size: replace(own, torque=change(own.torque, size))


def turned_aside(_: Scene, done: Run, own: Forces, size: float) -> Forces:
    """Turn all reactions by a quarter of a turn, as x for y would."""
    angle = size * np.pi / 2
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    return each_pin(own, lambda point, body, force: force @ turn)


def of_load(wrong: Callable[[Load, Run, float], Load | None]) -> ForceChange:
    """Let a load, as large as the largest reaction, be felt otherwise than it acts, or not at all.
    Loads add up linearly, so that the scene need have none."""

    def changed(scene: Scene, done: Run, own: Forces, size: float) -> Forces:
        name = last(scene)
        point = [each for each in scene.links[name].points if each not in scene.ground][-1]
        right = Load("push", name, point, Sine(largest_n(own), scene.driver.law.period_s))
        felt = wrong(right, done, size)
        return changed_by_scene(own, _loaded(scene, right), _loaded(scene, felt) if felt else scene)

    return changed


def _loaded(scene: Scene, load: Load) -> Scene:
    return replace(scene, loads={**scene.loads, load.name: load})


def load_late(load: Load, done: Run, steps: float) -> Load:
    """Return a load over time, felt some steps later."""
    return replace(load, characteristic=load.characteristic.carried(1.0, shift=steps * done.dt_s))


SLIDING = (fault.SLIDER, fault.SHAPER)
START = slice(5, 39)
"""Samples of the start, in which an engine takes up its pins."""


def _fault(
    name: str,
    what: str,
    rule: str,
    changed: ForceChange,
    size: float | None = None,
    unit: str = "",
    forces_of: str = "",
    **more: Any,
) -> fault.Fault:
    """Return a fault of logged forces, in all engines that log any, or of some kind."""

    def needs(name: str) -> bool:
        own = engine(name).forces_of
        return own == forces_of if forces_of else own != "nothing"

    plant = in_forces(changed)
    return fault.Fault("force", name, what, rule, plant, size, unit, needs=needs, **more)


FAULTS = (
    _fault("force-sign", "all forces have the other sign", "CC120", each_force(lambda x, _: -x)),
    _fault("force-giver", "a pin's force given for the other body", "CC120", of_the_giver),
    _fault("force-body-frame", "vectors in the bodies' frames", "CC120", in_body_frame),
    _fault("force-turned", "x for y: a quarter of a turn", "CC120", turned_aside),
    _fault("force-half-step", "stamped too late", "CC120", stamped, 0.5, "steps"),
    _fault("force-late", "a row has the forces of a row before", "CC120", rows_late,
           1.0, "sample", whole=True),
    _fault("force-far", "stamped far from its sample", "CC115", stamped, 2.0, "steps"),
    _fault("pins-swapped", "two pins have each other's forces", "CC120", pins_swapped),
    _fault("no-inertia", "mass and inertia of a link left out", "CC120",
           of_another(of_coupler(lighter_by)), 1.0, "of it"),
    _fault("no-turning-inertia", "a link's inertia left out", "CC123",
           of_another(of_coupler(turning_light)), 1.0, "of it"),
    _fault("weight-added", "forces of a gravity that is not there", "CC120",
           of_another(weighed), 9.81, "m/s^2"),
    _fault("load-late", "a load over time is felt late", "CC120", of_load(load_late), 1.0, "steps"),
    _fault("load-in-body", "a load felt in the body's frame", "CC120",
           of_load(lambda load, *_: replace(load, frame="body"))),
    _fault("load-left-out", "a load is not felt", "CC120", of_load(lambda *_: None)),
    _fault("other-scene-forces", "forces of a larger scene", "CC120",
           of_another(lambda scene, share: scaled(scene, 1.0 + share)), 1e-2, "longer"),
    _fault("force-doubled", "all forces twice", "CC120",
           each_force(lambda x, by: x * (1.0 + by)), 1.0, "of it"),
    _fault("force-of-kgf", "forces in kgf", "CC120", each_force(lambda x, _: x / 9.80665)),
    _fault("pin-open", "a pin's forces do not add up to 0", "CC124", one_sided, 1e-6, "of it"),
    _fault("normal-sign", "normal forces have the other sign", "CC121",
           lambda s, d, own, _: each_slider(own, lambda x: replace(x, normal=-x.normal)),
           scenes=SLIDING),
    _fault("moment-elsewhere", "moments about another point", "CC122", about_another_point,
           1e-1, "L off", scenes=SLIDING),
    _fault("flywheel-in", "the flywheel's share is in the torque", "CC123",
           of_torque(lambda torque, share: torque * (1.0 - share)), 1.0, "of it"),
    _fault("torque-off", "a torque of too much power", "CC123",
           of_torque(lambda torque, share: torque * (1.0 + share)), 1e-2, "of it"),
    _fault("torque-sign", "what the driver exerts on the drive", "CC123",
           of_torque(lambda x, _: -x)),
    _fault("force-smoothed", "the mean over some samples", "CC120",
           each_force(smoothed), 41.0, "samples", whole=True),
    _fault("force-noise", "noise on all forces (normal)", "CC120",
           lambda s, d, own, x: own.each_series(lambda f: noisy(f, x * largest_n(own))),
           1e-2, "F"),
    _fault("force-spike", "a reaction off at a sample", "CC120", spoilt_pin(WHEN), 1e-2, "F"),
    _fault("force-start", "reactions off at the start", "CC116", spoilt_pin(START), 0.5, "F",
           forces_of="states"),
    _fault("force-first-steps", "reactions off in the first steps", "CC116",
           spoilt_pin(slice(1, OF_STEPS)), 2.0, "F", forces_of="steps"),
    _fault("force-rings", "reactions off after the first steps", "CC120",
           spoilt_pin(slice(OF_STEPS + 1, 39)), 1e-2, "F", forces_of="steps"),
    _fault("force-floor", "a reaction off, within the limit", "CC125",
           spoilt_pin(slice(None)), 1e-3, "F", scenes=(fault.FOURBAR,), finer=True),
    _fault("forces-copied", "forces of the reference", "CC111", of_reference),
    _fault("force-nan", "a reaction not a number at the end", "CC109", nan_at_end),
    _fault("pin-missing", "a pin is not in the log", "CC109", without_last_pin),
    _fault("forces-missing", "no force is in the log", "CC109", lambda *_: None),
)  # fmt: skip
