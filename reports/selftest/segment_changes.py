"""Make another chain of the segments of an engine: springs, matter, lengths, start."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from analytic.elastic.engine_start import segment_start
from models.motion import State
from models.scene import Link, Scene
from models.scene.cut_scenes import SegmentedScene
from models.scene.loads import PinSpring
from models.scene.moved import of_mass, with_link
from reports.selftest.elastic_changes import truth_of_chain
from reports.selftest.fault import Plant, SceneChange, planting
from reports.selftest.free_changes import LinkChange, scaled_points
from sim.engine import Run
from sim.run import run

SpringChange = Callable[[PinSpring, int, float], PinSpring]
"""Change of a spring of a chain of so many segments, by a size."""


def in_elastic_scene(change: SceneChange) -> Plant:
    """Give the engine the segments of another scene, on its periodic motion: sound, but another."""

    @planting
    def runner(size: float, scene: Scene, _: State, *args: Any, **options: Any) -> Run:
        right = truth_of_chain(scene)
        wrong = SegmentedScene(change(right.scene, size), right.chain.count)
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
    chain = truth_of_chain(scene).chain
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


def prebent(spring: PinSpring, _: int, angle_rad: float) -> PinSpring:
    return replace(spring, free=spring.free + angle_rad)


def reversed_spring(spring: PinSpring, _: int, swap: float) -> PinSpring:
    return replace(spring, rate=(1.0 - 2.0 * swap) * spring.rate)


def segments(change: LinkChange) -> SceneChange:
    """Change every segment."""

    def changed(scene: Scene, size: float) -> Scene:
        chain = truth_of_chain(scene).chain
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
    return replace(of_mass(scene, name, 1.0 + share), elastic={**scene.elastic, name: soft})


def longer(scene: Scene, share: float) -> Scene:
    """Lengthen the elastic link by a share, with the spring rates of its new length."""
    name, link = next((n, scene.links[n]) for n in scene.elastic)
    more = 1.0 + share
    centre = (more * link.centre_m[0], more * link.centre_m[1])
    return with_link(scene, name, points=scaled_points(link, more), centre_m=centre)


@planting
def node_moved(share: float, scene: Scene, state: State, *args: Any, **options: Any) -> Run:
    """Lengthen the first segment by a share of it, and shorten the second as much; both start where
    they still meet, with the speeds that keep them together."""
    if not share:
        return run(scene, state, *args, **options)
    chain = truth_of_chain(scene).chain
    name = next(iter(chain.scene.elastic))
    parts, nodes = chain.segments(name)[:2], chain.nodes(name)[:3]
    sizes = []
    for part, more in zip(parts, (1.0 + share, 1.0 - share), strict=True):
        link = scene.links[part]
        sizes.append(_length(link) * more)
        centre = (more * link.centre_m[0], link.centre_m[1])
        scene = with_link(scene, part, points=scaled_points(link, more), centre_m=centre)
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
