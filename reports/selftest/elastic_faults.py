"""Faults of elastic links: in an engine's segments or beams, in its steps, and in its log.

The pins of the scene move as they should to a millionth: only the bending shows the fault.
"""

from collections.abc import Callable
from functools import partial

import numpy as np

from reports.selftest import elastic_changes, engines, segment_changes
from reports.selftest.fault import Fault, Plant
from reports.selftest.free_changes import later, of_load, reversed_load
from reports.selftest.log_faults import late
from sim.registry import engine

_STEP_S = (
    elastic_changes.ELASTIC_RUNS[elastic_changes.LOOSE].lasts_s or 0.0
) / elastic_changes.ELASTIC_RUNS[elastic_changes.LOOSE].steps


def _fault(
    group: str,
    name: str,
    what: str,
    plant: Plant,
    size: float | None = None,
    unit: str = "",
    *,
    rule: str = "CC132",
    scene: str = elastic_changes.BENT,
    needs: Callable[[str], bool] = lambda _: True,
    whole: bool = False,
) -> Fault:
    """Return a fault of the elastic links of a scene."""
    return Fault(
        group, name, what, rule, plant, size, unit, scenes=(scene,), needs=needs, whole=whole
    )


_chain = partial(_fault, "segments")
_inside = partial(_fault, "vibration")
_log = partial(_fault, "deflection")
_beam = partial(_fault, "beam", rule="CC131", needs=lambda name: engine(name).applies_beams)
_loose = partial(_fault, "segments", scene=elastic_changes.LOOSE)
FAULTS = (
    _chain(
        "springs-of-fewer",
        "springs as of n - 1 segments, not n",
        segment_changes.in_chain(segment_changes.springs(segment_changes.of_as_many_springs)),
    ),
    _chain(
        "springs-corrected",
        "corrected springs, not plain ones",
        segment_changes.in_chain(segment_changes.springs(segment_changes.as_corrected)),
    ),
    _chain(
        "modulus-off",
        "the modulus is too large",
        segment_changes.in_chain(segment_changes.springs(segment_changes.stiffer)),
        1e-2,
        "of it",
    ),
    _chain(
        "spring-missing",
        "the middle spring is soft, or gone",
        segment_changes.in_chain(
            segment_changes.middle_spring(
                lambda one, n, share: segment_changes.stiffer(one, n, -share)
            )
        ),
        1.0,
        "of it",
    ),
    _chain(
        "bending-reversed",
        "it pushes the wrong way",
        segment_changes.in_chain(segment_changes.middle_spring(segment_changes.reversed_spring)),
    ),
    _chain(
        "spring-prebent",
        "it is slack at another angle",
        segment_changes.in_chain(segment_changes.middle_spring(segment_changes.prebent)),
        1e-3,
        "rad",
    ),
    _chain(
        "spring-damping",
        "the springs damp",
        segment_changes.in_chain(segment_changes.springs(segment_changes.damped)),
        1e-3,
        "s",
    ),
    _chain(
        "inertia-at-ends",
        "segments' mass is at their ends",
        segment_changes.in_chain(segment_changes.segments(segment_changes.at_its_ends)),
        1.0,
        "of it",
    ),
    _chain(
        "segments-heavy",
        "segments are too heavy",
        segment_changes.in_chain(segment_changes.segments(segment_changes.heavier)),
        1e-2,
        "of it",
    ),
    _chain(
        "rocker-heavy",
        "what it moves is too heavy",
        segment_changes.in_chain(segment_changes.heavy_rocker),
        10.0,
        "of it",
    ),
    _chain(
        "node-moved", "a node is elsewhere on the link", segment_changes.node_moved, 0.1, "of it"
    ),
    _chain(
        "elastic-other",
        "softer, heavier, moves as it should",
        segment_changes.in_elastic_scene(segment_changes.modulus_and_mass),
        1e-2,
        "of it",
    ),
    _chain(
        "elastic-long",
        "the elastic link is too long",
        segment_changes.in_elastic_scene(segment_changes.longer),
        1e-2,
        "of it",
        rule="CC103",
    ),
    _chain("start-straight", "starts straight, and rings", segment_changes.started("straight")),
    _chain(
        "start-unswung", "starts as if it did not swing", segment_changes.started("quasi-static")
    ),
    _inside(
        "vibration-damped",
        "something damps all joints",
        engines.after_look(lambda tools: tools.damp),
        1.0,
        "1/s",
    ),
    _inside("bending-explicit", "explicit steps: it is flung out", engines.explicit, 1.0, "of it"),
    _inside(
        "vibration-fed",
        f"speeds made larger, {engines.TIMES} times",
        engines.done_to(lambda tools: tools.quicken, engines.now_and_then),
        1e-2,
        "of it",
    ),
    _inside(
        "weight-later",
        "gravity is switched on in mid-run",
        engines.after_a_third(lambda tools: tools.pull),
        1.0,
        "m/s^2",
    ),
    _log(
        "deflection-sign",
        "the deflection has the other sign",
        elastic_changes.in_chain_log(elastic_changes.bent_by(lambda off, _: np.negative(off))),
    ),
    _log(
        "deflection-scaled",
        "the deflection is too large",
        elastic_changes.in_chain_log(
            elastic_changes.bent_by(lambda off, share: (1.0 + share) * off)
        ),
        1e-2,
        "of it",
    ),
    _log(
        "other-node",
        "the next node's deflection",
        elastic_changes.in_chain_log(elastic_changes.at_next_node),
    ),
    _log(
        "bend-later", "every sample is a later one", late, 1.0, "sample", whole=True, rule="CC102"
    ),
    _log(
        "linear-given",
        "the linear theory, handed in",
        elastic_changes.in_chain_log(elastic_changes.of_beam(stiffened=False)),
    ),
    _log(
        "beam-given",
        "the beam, handed back",
        elastic_changes.in_chain_log(elastic_changes.of_beam(stiffened=True)),
    ),
    _log(
        "chain-given",
        "the exact chain, handed back",
        elastic_changes.in_chain_log(elastic_changes.of_exact_chain),
        rule="CC111",
    ),
    _beam(
        "beam-modulus",
        "the modulus is too large",
        elastic_changes.in_beam(elastic_changes.stiffer_beam),
        1e-2,
        "of it",
    ),
    _beam(
        "beam-mass",
        "the beam is too heavy",
        elastic_changes.in_beam(elastic_changes.heavier_beam),
        1e-2,
        "of it",
    ),
    _beam(
        "beam-damping",
        "the beam damps",
        elastic_changes.in_beam(elastic_changes.damped_beam),
        1e-3,
        "s",
    ),
    _beam(
        "beam-stretches",
        "EA is that many times too small",
        elastic_changes.in_beam(elastic_changes.stretchier),
        1e4,
        "times",
    ),
    _beam("beam-straight", "starts straight, and rings", elastic_changes.begun("straight")),
    _beam("beam-unswung", "starts as if it did not swing", elastic_changes.begun("quasi-static")),
    _beam(
        "beam-bend-scaled",
        "the deflection is too large",
        elastic_changes.in_chain_log(
            elastic_changes.bent_by(lambda off, share: (1.0 + share) * off)
        ),
        1e-2,
        "of it",
    ),
    _beam(
        "beam-linear-given",
        "the linear theory, handed in",
        elastic_changes.in_chain_log(elastic_changes.of_beam(stiffened=False)),
    ),
    _beam(
        "beam-theory-given",
        "the beam, handed back",
        elastic_changes.in_chain_log(elastic_changes.of_beam(stiffened=True)),
        rule="CC111",
    ),
    _loose(
        "loose-torque-late",
        "let go: the torque acts late",
        segment_changes.in_chain(of_load("pulse", later(_STEP_S))),
        1.0,
        "steps",
        rule="CC127",
    ),
    _loose(
        "loose-torque-back",
        "let go: it turns the other way",
        segment_changes.in_chain(of_load("pulse", reversed_load)),
        rule="CC127",
    ),
    _loose(
        "loose-modulus-off",
        "let go: the modulus is too large",
        segment_changes.in_chain(segment_changes.springs(segment_changes.stiffer)),
        1e-2,
        "of it",
    ),
    _loose(
        "loose-damping",
        "let go: the springs damp",
        segment_changes.in_chain(segment_changes.springs(segment_changes.damped)),
        1e-3,
        "s",
    ),
    _loose(
        "loose-rocker-heavy",
        "let go: what it moves is too heavy",
        segment_changes.in_chain(segment_changes.heavy_rocker),
        1e-2,
        "of it",
        rule="CC127",
    ),
    _inside(
        "loose-damped",
        "let go: something damps all joints",
        engines.after_look(lambda tools: tools.damp),
        1.0,
        "1/s",
        scene=elastic_changes.LOOSE,
        rule="CC129",
    ),
)
