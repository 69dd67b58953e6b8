"""Faults of elastic links: in an engine's segments or beams, in its steps, and in its log.

The pins of the scene move as they should to a millionth: only the bending shows the fault.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from analytic.elastic.engine_start import segment_start
from models.motion import State
from models.scene import Link, Scene, cut_scenes, moved
from models.scene.loads import PinSpring
from reports.selftest import elastic_changes as elastic
from reports.selftest import engines, log_faults
from reports.selftest import free_changes as machine
from reports.selftest.fault import Fault, Plant, SceneChange, planting
from sim.engine import Run
from sim.registry import engine
from sim.run import run

SpringChange = Callable[[PinSpring, int, float], PinSpring]
"""Change of a spring of a chain of so many segments, by a size."""


def in_elastic_scene(change: SceneChange) -> Plant:
    """Give the engine the segments of another scene, on its periodic motion: sound, but another."""

    @planting
    def runner(size: float, scene: Scene, _: State, *args: Any, **options: Any) -> Run:
        right = elastic.truth_of_chain(scene)
        wrong = cut_scenes.SegmentedScene(change(right.scene, size), right.chain.count)
        return run(wrong.rigid, segment_start(wrong, right.theory.shape), *args, **options)

    return runner


def springs(change: SpringChange) -> SceneChange:
    """Change every spring between segments."""
    return lambda scene, size: _sprung(scene, size, change, slice(None))


def middle_spring(change: SpringChange) -> SceneChange:
    """Change the spring in the middle alone."""

    def changed(scene: Scene, size: float) -> Scene:
        middle = len(_between(scene)) // 2
        return _sprung(scene, size, change, slice(middle, middle + 1))

    return changed


def _between(scene: Scene) -> list[str]:
    """Return the springs between segments of the first elastic link, in order."""
    chain = elastic.truth_of_chain(scene).chain
    name = next(iter(chain.scene.elastic))
    return list(chain.nodes(name)[1:-1])


def _sprung(scene: Scene, size: float, change: SpringChange, which: slice) -> Scene:
    names = _between(scene)
    own = dict(scene.springs)
    for name in names[which]:
        spring = own[name]
        assert isinstance(spring, PinSpring)
        own[name] = change(spring, len(names) + 1, size)
    return replace(scene, springs=own)


def stiffer(spring: PinSpring, _: int, share: float) -> PinSpring:
    return replace(spring, rate=(1.0 + share) * spring.rate)


def of_as_many_springs(spring: PinSpring, count: int, swap: float) -> PinSpring:
    """Take the rate of a link cut into as many parts as there are springs, n - 1."""
    return replace(spring, rate=spring.rate * (1.0 - swap / count))


def as_corrected(spring: PinSpring, count: int, swap: float) -> PinSpring:
    """Apply the factor that gives the chain the sag of the beam."""
    return replace(spring, rate=spring.rate * (1.0 + swap * math.pi**2 / (12.0 * count**2)))


def damped(spring: PinSpring, _: int, time_s: float) -> PinSpring:
    return replace(spring, damping=spring.damping + time_s * spring.rate)


def segments(change: machine.LinkChange) -> SceneChange:
    """Change every segment."""

    def changed(scene: Scene, size: float) -> Scene:
        chain = elastic.truth_of_chain(scene).chain
        names = [part for name in chain.scene.elastic for part in chain.segments(name)]
        own = {name: change(scene.links[name], size) for name in names}
        return replace(scene, links={**scene.links, **own})

    return changed


def at_its_ends(link: Link, share: float) -> Link:
    """Put the mass of a rod into its ends: three times the inertia, or a share of the way there."""
    return replace(link, inertia_kg_m2=(1.0 + 2.0 * share) * link.inertia_kg_m2)


def modulus_and_mass(scene: Scene, share: float) -> Scene:
    """Make an elastic link softer by a share, and as much heavier."""
    name, own = next(iter(scene.elastic.items()))
    soft = replace(own, flexural_n_m2=own.flexural_n_m2 / (1.0 + share))
    return replace(moved.of_mass(scene, name, 1.0 + share), elastic={**scene.elastic, name: soft})


def longer(scene: Scene, share: float) -> Scene:
    """Lengthen the elastic link by a share, with the spring rates of its new length."""
    name, link = next((n, scene.links[n]) for n in scene.elastic)
    more = 1.0 + share
    centre = (more * link.centre_m[0], more * link.centre_m[1])
    return moved.with_link(scene, name, points=machine.scaled_points(link, more), centre_m=centre)


@planting
def node_moved(share: float, scene: Scene, state: State, *args: Any, **options: Any) -> Run:
    """Lengthen the first segment by a share of it, and shorten the second as much; both start where
    they still meet, with the speeds that keep them together."""
    if not share:
        return run(scene, state, *args, **options)
    chain = elastic.truth_of_chain(scene).chain
    name = next(iter(chain.scene.elastic))
    parts, nodes = chain.segments(name)[:2], chain.nodes(name)[:3]
    sizes = []
    for part, more in zip(parts, (1.0 + share, 1.0 - share), strict=True):
        link = scene.links[part]
        sizes.append(_length(link) * more)
        centre = (more * link.centre_m[0], link.centre_m[1])
        scene = moved.with_link(
            scene, part, points=machine.scaled_points(link, more), centre_m=centre
        )
    return run(scene, _met(state, parts, nodes, sizes), *args, **options)


def _length(link: Link) -> float:
    return math.dist(*list(link.points.values())[:2])


def _met(state: State, parts: tuple[str, ...], nodes: tuple[str, ...], sizes: list[float]) -> State:
    """Return the state with two segments of these lengths [m] between the outer two of three nodes,
    bent to the same side: circles about both, and their first and second derivatives."""
    (p, v, a), (q, w, b) = (
        [np.array(each[node]) for each in (state.position, state.velocity, state.acceleration)]
        for node in (nodes[0], nodes[2])
    )
    way = q - p
    far, turned = math.hypot(*way), state.theta[parts[1]] - state.theta[parts[0]]
    first = math.acos((far**2 + sizes[0] ** 2 - sizes[1] ** 2) / (2.0 * far * sizes[0]))
    angle = math.atan2(way[1], way[0]) - math.copysign(first, turned)
    angle += math.tau * round((state.theta[parts[0]] - angle) / math.tau)
    node = p + sizes[0] * np.array([math.cos(angle), math.sin(angle)])
    rest = q - node
    second = math.atan2(rest[1], rest[0])
    second += math.tau * round((state.theta[parts[1]] - second) / math.tau)
    arms = np.array([(node - p), rest])
    across = np.stack([-arms[:, 1], arms[:, 0]], axis=1)
    omega = np.linalg.solve(across.T, w - v)
    alpha = np.linalg.solve(across.T, b - a + (omega**2) @ arms)
    return replace(
        state,
        theta={**state.theta, parts[0]: angle, parts[1]: second},
        omega={**state.omega, **dict(zip(parts, map(float, omega), strict=True))},
        alpha={**state.alpha, **dict(zip(parts, map(float, alpha), strict=True))},
        position={**state.position, nodes[1]: (float(node[0]), float(node[1]))},
        velocity={**state.velocity, nodes[1]: _pair(v + omega[0] * across[0])},
        acceleration={
            **state.acceleration,
            nodes[1]: _pair(a + alpha[0] * across[0] - omega[0] ** 2 * arms[0]),
        },
    )


def _pair(row: np.ndarray) -> tuple[float, float]:
    return float(row[0]), float(row[1])


_LOOSE_RUN = elastic.ELASTIC_RUNS[elastic.LOOSE]
_STEP_S = (_LOOSE_RUN.lasts_s or 0.0) / _LOOSE_RUN.steps


def _fault(
    group: str,
    name: str,
    what: str,
    plant: Plant,
    size: float | None = None,
    unit: str = "",
    *,
    rule: str = "CC132",
    scene: str = elastic.BENT,
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
_loose = partial(_fault, "segments", scene=elastic.LOOSE)
FAULTS = (
    _chain("springs-of-fewer", "springs as of n - 1 segments, not n",
           elastic.in_given(springs(of_as_many_springs))),
    _chain("springs-corrected", "corrected springs, not plain ones",
           elastic.in_given(springs(as_corrected))),
    _chain("modulus-off", "the modulus is too large",
           elastic.in_given(springs(stiffer)), 1e-2, "of it"),
    _chain("spring-missing", "the middle spring is soft, or gone",
           elastic.in_given(middle_spring(lambda one, n, share: stiffer(one, n, -share))),
           1.0, "of it"),
    _chain("bending-reversed", "it pushes the wrong way",
           elastic.in_given(middle_spring(lambda one, n, swap: stiffer(one, n, -2.0 * swap)))),
    _chain("spring-prebent", "it is slack at another angle",
           elastic.in_given(middle_spring(lambda one, _, rad: replace(one, free=one.free + rad))),
           1e-3, "rad"),
    _chain("spring-damping", "the springs damp", elastic.in_given(springs(damped)), 1e-3, "s"),
    _chain("inertia-at-ends", "segments' mass is at their ends",
           elastic.in_given(segments(at_its_ends)), 1.0, "of it"),
    _chain("segments-heavy", "segments are too heavy",
           elastic.in_given(segments(machine.heavier_by)), 1e-2, "of it"),
    _chain("rocker-heavy", "what it moves is too heavy",
           elastic.in_given(machine.of_link(machine.heavier_by, -1)), 10.0, "of it"),
    _chain("node-moved", "a node is elsewhere on the link", node_moved, 0.1, "of it"),
    _chain("elastic-other", "softer, heavier, moves as it should",
           in_elastic_scene(modulus_and_mass), 1e-2, "of it"),
    _chain("elastic-long", "the elastic link is too long", in_elastic_scene(longer), 1e-2, "of it",
           rule="CC103"),
    _chain("start-straight", "starts straight, and rings", elastic.started("straight")),
    _chain("start-unswung", "starts as if it did not swing", elastic.started("quasi-static")),
    _inside("vibration-damped", "something damps all joints",
            engines.after_look(lambda tools: tools.damp), 1.0, "1/s"),
    _inside("bending-explicit", "explicit steps: it is flung out", engines.explicit, 1.0, "of it"),
    _inside("vibration-fed", f"speeds made larger, {engines.TIMES} times",
            engines.done_to(lambda tools: tools.quicken, engines.now_and_then), 1e-2, "of it"),
    _inside("weight-later", "gravity is switched on in mid-run",
            engines.after_a_third(lambda tools: tools.pull), 1.0, "m/s^2"),
    _log("deflection-sign", "the deflection has the other sign",
         elastic.in_chain_log(elastic.bent_by(lambda off, _: np.negative(off)))),
    _log("deflection-scaled", "the deflection is too large",
         elastic.in_chain_log(elastic.bent_by(lambda off, share: (1.0 + share) * off)),
         1e-2, "of it"),
    _log("other-node", "the next node's deflection", elastic.in_chain_log(elastic.at_next_node)),
    _log("bend-later", "every sample is a later one", log_faults.late, 1.0, "sample", whole=True,
         rule="CC102"),
    _log("linear-given", "the linear theory, handed in",
         elastic.in_chain_log(elastic.of_beam(stiffened=False))),
    _log("beam-given", "the beam, handed back",
         elastic.in_chain_log(elastic.of_beam(stiffened=True))),
    _log("chain-given", "the exact chain, handed back",
         elastic.in_chain_log(elastic.of_exact_chain), rule="CC111"),
    _beam("beam-modulus", "the modulus is too large",
          elastic.in_beam(elastic.stiffer_beam), 1e-2, "of it"),
    _beam("beam-mass", "the beam is too heavy",
          elastic.in_beam(lambda one, x: replace(one, density_kg_m=(1.0 + x) * one.density_kg_m)),
          1e-2, "of it"),
    _beam("beam-damping", "the beam damps",
          elastic.in_beam(lambda one, time_s: replace(one, damping_s=one.damping_s + time_s)),
          1e-3, "s"),
    _beam("beam-stretches", "EA is that many times too small",
          elastic.in_beam(lambda one, x: replace(one, axial_n=one.axial_n / (1.0 + x))),
          1e4, "times"),
    _beam("beam-straight", "starts straight, and rings", elastic.started("straight")),
    _beam("beam-unswung", "starts as if it did not swing", elastic.started("quasi-static")),
    _beam("beam-bend-scaled", "the deflection is too large",
          elastic.in_chain_log(elastic.bent_by(lambda off, share: (1.0 + share) * off)),
          1e-2, "of it"),
    _beam("beam-linear-given", "the linear theory, handed in",
          elastic.in_chain_log(elastic.of_beam(stiffened=False))),
    _beam("beam-theory-given", "the beam, handed back",
          elastic.in_chain_log(elastic.of_beam(stiffened=True)), rule="CC111"),
    _loose("loose-torque-late", "free motion: the torque acts late",
           elastic.in_given(machine.of_load("pulse", machine.later(_STEP_S))),
           1.0, "steps", rule="CC127"),
    _loose("loose-torque-back", "free motion: it turns the other way",
           elastic.in_given(machine.of_load("pulse", machine.reversed_load)), rule="CC127"),
    _loose("loose-modulus-off", "free motion: the modulus is too large",
           elastic.in_given(springs(stiffer)), 1e-2, "of it"),
    _loose("loose-damping", "free motion: the springs damp",
           elastic.in_given(springs(damped)), 1e-3, "s"),
    _loose("loose-rocker-heavy", "free motion: a driven body is too heavy",
           elastic.in_given(machine.of_link(machine.heavier_by, -1)), 1e-2, "of it", rule="CC127"),
    _inside("loose-damped", "free motion: something damps all joints",
            engines.after_look(lambda tools: tools.damp),
            1.0, "1/s", scene=elastic.LOOSE, rule="CC129"),
)  # fmt: skip
