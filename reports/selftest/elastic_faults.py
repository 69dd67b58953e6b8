"""Faults of elastic links: in an engine's segments or beams, in its steps, and in its log.

The pins of the scene move as they should to a millionth: only the bending shows the fault.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from reports.selftest import engines
from reports.selftest.elastic_changes import (
    BENT,
    ELASTIC_RUNS,
    LOOSE,
    at_next_node,
    bent_by,
    in_beam,
    in_chain_log,
    in_given,
    of_beam,
    of_exact_chain,
    started,
    stiffer_beam,
)
from reports.selftest.fault import Fault, Plant
from reports.selftest.free_changes import heavier_by, later, of_link, of_load, reversed_load
from reports.selftest.log_faults import late
from reports.selftest.segment_changes import (
    as_corrected,
    at_its_ends,
    damped,
    in_elastic_scene,
    longer,
    middle_spring,
    modulus_and_mass,
    node_moved,
    of_as_many_springs,
    prebent,
    reversed_spring,
    segments,
    springs,
    stiffer,
)
from sim.registry import engine

_STEP_S = (ELASTIC_RUNS[LOOSE].lasts_s or 0.0) / ELASTIC_RUNS[LOOSE].steps


def _fault(
    group: str,
    name: str,
    what: str,
    plant: Plant,
    size: float | None = None,
    unit: str = "",
    *,
    rule: str = "CC132",
    scene: str = BENT,
    needs: Callable[[str], bool] = lambda _: True,
    whole: bool = False,
) -> Fault:
    return Fault(
        group, name, what, rule, plant, size, unit, scenes=(scene,), needs=needs, whole=whole
    )


_chain = partial(_fault, "segments")
_inside = partial(_fault, "vibration")
_log = partial(_fault, "deflection")
_beam = partial(_fault, "beam", rule="CC131", needs=lambda name: engine(name).applies_beams)
_loose = partial(_fault, "segments", scene=LOOSE)
FAULTS = (
    _chain("springs-of-fewer", "springs as of n - 1 segments, not n",
           in_given(springs(of_as_many_springs))),
    _chain("springs-corrected", "corrected springs, not plain ones",
           in_given(springs(as_corrected))),
    _chain("modulus-off", "the modulus is too large", in_given(springs(stiffer)), 1e-2, "of it"),
    _chain("spring-missing", "the middle spring is soft, or gone",
           in_given(middle_spring(lambda one, n, share: stiffer(one, n, -share))), 1.0, "of it"),
    _chain("bending-reversed", "it pushes the wrong way", in_given(middle_spring(reversed_spring))),
    _chain("spring-prebent", "it is slack at another angle", in_given(middle_spring(prebent)),
           1e-3, "rad"),
    _chain("spring-damping", "the springs damp", in_given(springs(damped)), 1e-3, "s"),
    _chain("inertia-at-ends", "segments' mass is at their ends", in_given(segments(at_its_ends)),
           1.0, "of it"),
    _chain("segments-heavy", "segments are too heavy", in_given(segments(heavier_by)),
           1e-2, "of it"),
    _chain("rocker-heavy", "what it moves is too heavy", in_given(of_link(heavier_by, -1)),
           10.0, "of it"),
    _chain("node-moved", "a node is elsewhere on the link", node_moved, 0.1, "of it"),
    _chain("elastic-other", "softer, heavier, moves as it should",
           in_elastic_scene(modulus_and_mass), 1e-2, "of it"),
    _chain("elastic-long", "the elastic link is too long", in_elastic_scene(longer), 1e-2, "of it",
           rule="CC103"),
    _chain("start-straight", "starts straight, and rings", started("straight")),
    _chain("start-unswung", "starts as if it did not swing", started("quasi-static")),
    _inside("vibration-damped", "something damps all joints",
            engines.after_look(lambda tools: tools.damp), 1.0, "1/s"),
    _inside("bending-explicit", "explicit steps: it is flung out", engines.explicit, 1.0, "of it"),
    _inside("vibration-fed", f"speeds made larger, {engines.TIMES} times",
            engines.done_to(lambda tools: tools.quicken, engines.now_and_then), 1e-2, "of it"),
    _inside("weight-later", "gravity is switched on in mid-run",
            engines.after_a_third(lambda tools: tools.pull), 1.0, "m/s^2"),
    _log("deflection-sign", "the deflection has the other sign",
         in_chain_log(bent_by(lambda off, _: np.negative(off)))),
    _log("deflection-scaled", "the deflection is too large",
         in_chain_log(bent_by(lambda off, share: (1.0 + share) * off)), 1e-2, "of it"),
    _log("other-node", "the next node's deflection", in_chain_log(at_next_node)),
    _log("bend-later", "every sample is a later one", late, 1.0, "sample", whole=True,
         rule="CC102"),
    _log("linear-given", "the linear theory, handed in", in_chain_log(of_beam(stiffened=False))),
    _log("beam-given", "the beam, handed back", in_chain_log(of_beam(stiffened=True))),
    _log("chain-given", "the exact chain, handed back", in_chain_log(of_exact_chain), rule="CC111"),
    _beam("beam-modulus", "the modulus is too large", in_beam(stiffer_beam), 1e-2, "of it"),
    _beam("beam-mass", "the beam is too heavy",
          in_beam(lambda one, x: replace(one, density_kg_m=(1.0 + x) * one.density_kg_m)),
          1e-2, "of it"),
    _beam("beam-damping", "the beam damps",
          in_beam(lambda one, time_s: replace(one, damping_s=one.damping_s + time_s)), 1e-3, "s"),
    _beam("beam-stretches", "EA is that many times too small",
          in_beam(lambda one, x: replace(one, axial_n=one.axial_n / (1.0 + x))), 1e4, "times"),
    _beam("beam-straight", "starts straight, and rings", started("straight")),
    _beam("beam-unswung", "starts as if it did not swing", started("quasi-static")),
    _beam("beam-bend-scaled", "the deflection is too large",
          in_chain_log(bent_by(lambda off, share: (1.0 + share) * off)), 1e-2, "of it"),
    _beam("beam-linear-given", "the linear theory, handed in",
          in_chain_log(of_beam(stiffened=False))),
    _beam("beam-theory-given", "the beam, handed back", in_chain_log(of_beam(stiffened=True)),
          rule="CC111"),
    _loose("loose-torque-late", "let go: the torque acts late",
           in_given(of_load("pulse", later(_STEP_S))), 1.0, "steps", rule="CC127"),
    _loose("loose-torque-back", "let go: it turns the other way",
           in_given(of_load("pulse", reversed_load)), rule="CC127"),
    _loose("loose-modulus-off", "let go: the modulus is too large", in_given(springs(stiffer)),
           1e-2, "of it"),
    _loose("loose-damping", "let go: the springs damp", in_given(springs(damped)), 1e-3, "s"),
    _loose("loose-rocker-heavy", "let go: what it moves is too heavy",
           in_given(of_link(heavier_by, -1)), 1e-2, "of it", rule="CC127"),
    _inside("loose-damped", "let go: something damps all joints",
            engines.after_look(lambda tools: tools.damp), 1.0, "1/s", scene=LOOSE, rule="CC129"),
)  # fmt: skip
