"""A scene whose elastic links are chains of rigid segments: what engines of rigid bodies are given.

::

    A o--1--@--2--@--3--@ ... --n--o B        @ a pin with a spring, n - 1 of them

With segments of length l/n, springs of EI n / l and the inertia of slender rods the chain comes to
the beam of Euler and Bernoulli as 1/n^2: its sag under an even load is too large by 0.80/n^2.
Springs that are stiffer by 1 + pi^2/(12 n^2) mend that, and put its first frequency up by 0.41/n^2
instead. Segments bend, and do not stretch.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from models.elastic import ElasticLink
from models.elastic_line import Line, line_of
from models.errors import CrankcheckError
from models.loads import Load
from models.motion import ElasticMotion, LinkMotion, Motion
from models.scene import Link, Point, Scene
from models.springs import PinSpring, Spring
from models.start import Start


@dataclass(frozen=True)
class SegmentedScene:
    """``scene`` with ``count`` segments for each of its elastic links; ``corrected`` springs give
    the chain the sag of the beam. Raises CrankcheckError for a link that stretches, and for fewer
    than two segments."""

    scene: Scene
    count: int
    corrected: bool = False

    def __post_init__(self) -> None:
        if self.count < 2:
            raise CrankcheckError(
                f"{self.scene.name}: found {self.count} segments; a link bends with 2 or more"
            )
        for name, link in self.scene.elastic.items():
            if link.stretches:
                raise CrankcheckError(
                    f"{self.scene.name}: elastic.{name} stretches, and a chain of segments does "
                    "not; give stretches = false, or an engine that has beams"
                )
        made = {name for link in self.scene.elastic for name in self.segments(link)}
        nodes = {node for link in self.scene.elastic for node in self.nodes(link)[1:-1]}
        twice = (made & {*self.scene.links}) | (nodes & {*self._named})
        if twice:
            raise CrankcheckError(
                f"{self.scene.name}: the segments of its elastic links need the name "
                f"{min(twice)}, which the scene has; give that another one"
            )

    def segments(self, link: str) -> tuple[str, ...]:
        """The names of the segments of an elastic link, from its first pin on."""
        return tuple(f"{link}-{i}" for i in range(1, self.count + 1))

    def nodes(self, link: str) -> tuple[str, ...]:
        """The points between and at the ends of its segments."""
        first, last = line_of(self.scene, link).pins
        return (first, *(f"{link}-{i}-{i + 1}" for i in range(1, self.count)), last)

    @cached_property
    def with_nodes(self) -> Scene:
        """The elastic scene, its elastic links with their nodes as named points."""
        links = dict(self.scene.links)
        for name in self.scene.elastic:
            link, line = links[name], line_of(self.scene, name)
            points = dict(link.points)
            for i, node in enumerate(self.nodes(name)[1:-1], start=1):
                points[node] = line.at(i * line.length_m / self.count)
            links[name] = replace(link, points=points)
        return replace(self.scene, links=links)

    @cached_property
    def rigid(self) -> Scene:
        """The scene that an engine is given."""
        links: dict[str, Link] = {}
        springs = {name: self._held(spring) for name, spring in self.scene.springs.items()}
        for name, link in self.scene.links.items():
            if name not in self.scene.elastic:
                links[name] = link
                continue
            own = self.scene.elastic[name]
            links |= self._chain(link, line_of(self.scene, name))
            springs |= self._springs(own, line_of(self.scene, name))
        loads = {name: self._put(load) for name, load in self.scene.loads.items()}
        return replace(
            self.scene, links=links, springs=springs, loads=loads, elastic={}, start=Start()
        )

    def _segment(self, line: Line, place: Point) -> tuple[int, Point]:
        """The segment that carries a place of the link, and where it is in the segment's frame."""
        piece = line.length_m / self.count
        x, y = line.along(place)
        i = min(max(int(x / piece + 1e-9), 0), self.count - 1)
        return i, (x - i * piece, y)

    def _carrier(self, link: str, point: str) -> str:
        """The segment that carries a named point of an elastic link."""
        place = self.scene.links[link].points[point]
        return self.segments(link)[self._segment(line_of(self.scene, link), place)[0]]

    def _put(self, load: Load) -> Load:
        """A load on the segment that has its point."""
        if load.body not in self.scene.elastic or load.point is None:
            return load
        lean = line_of(self.scene, load.body).lean_rad if load.frame == "body" else 0.0
        return replace(
            load,
            body=self._carrier(load.body, load.point),
            direction_rad=load.direction_rad - lean,
        )

    def _held(self, spring: Spring) -> Spring:
        """A spring in a pin between the segments that meet there."""
        if not isinstance(spring, PinSpring):
            return spring
        bodies, ahead = [], []
        for body in spring.bodies:
            elastic = body in self.scene.elastic
            bodies.append(self._carrier(body, spring.point) if elastic else body)
            ahead.append(line_of(self.scene, body).lean_rad if elastic else 0.0)
        free = spring.free + ahead[1] - ahead[0]
        return replace(spring, bodies=(bodies[0], bodies[1]), free=free)

    def _chain(self, link: Link, line: Line) -> dict[str, Link]:
        """The segments, each in a frame of its own from its first point on."""
        piece, nodes = line.length_m / self.count, self.nodes(link.name)
        points: list[dict[str, Point]] = [
            {nodes[i]: (0.0, 0.0), nodes[i + 1]: (piece, 0.0)} for i in range(self.count)
        ]
        for name, place in link.points.items():
            if name not in line.pins:
                i, there = self._segment(line, place)
                points[i][name] = there
        mass = line.density_kg_m * piece
        return {
            name: Link(name, points[i], mass, (0.5 * piece, 0.0), mass * piece**2 / 12.0)
            for i, name in enumerate(self.segments(link.name))
        }

    def _springs(self, own: ElasticLink, line: Line) -> dict[str, PinSpring]:
        """In all pins between segments."""
        names, nodes = self.segments(own.link), self.nodes(own.link)
        rate = segment_spring(own, line.length_m, self.count, corrected=self.corrected)
        return {
            node: PinSpring(node, rate, rate * own.damping_s, 0.0, node, (names[i], names[i + 1]))
            for i, node in enumerate(nodes[1:-1])
        }

    def folded(self, motion: Motion) -> Motion:
        """A motion of the chain as one of the scene with its elastic links."""
        points = {name: motion.points[name] for name in self._named}
        links = {name: own for name, own in motion.links.items() if name in self.scene.links}
        elastic = {}
        for name in self.scene.elastic:
            links[name] = self._line_motion(motion, name)
            elastic[name] = self._shape(motion, name)
        in_order = {name: links[name] for name in self.scene.links}
        return replace(motion, links=in_order, points=points, elastic=elastic)

    @property
    def _named(self) -> tuple[str, ...]:
        """The points of the scene itself."""
        own = {point: None for link in self.scene.links.values() for point in link.points}
        own |= dict.fromkeys(self.scene.ground)
        own |= {slider.point: None for slider in self.scene.sliders.values()}
        return tuple(own)

    def _line_motion(self, motion: Motion, link: str) -> LinkMotion:
        """The line between the two pins of an elastic link, as that of a rigid one."""
        line = line_of(self.scene, link)
        a, b = (motion.points[pin] for pin in line.pins)
        way, drift, push = (
            getattr(b, key) - getattr(a, key) for key in ("position", "velocity", "acceleration")
        )
        far = np.hypot(way[:, 0], way[:, 1])
        along = way / far[:, None]
        across = np.stack([-along[:, 1], along[:, 0]], axis=1)
        omega = (across * drift).sum(axis=1) / far
        alpha = ((across * push).sum(axis=1) - 2.0 * omega * (along * drift).sum(axis=1)) / far
        # The first segment counts whole turns.
        theta = np.arctan2(way[:, 1], way[:, 0]) - line.lean_rad
        near = motion.links[self.segments(link)[0]].theta - line.lean_rad
        theta = theta + math.tau * np.round((near - theta) / math.tau)
        return LinkMotion(theta, omega, alpha)

    def _shape(self, motion: Motion, link: str) -> ElasticMotion:
        """How the chain is bent."""
        nodes = [motion.points[node].position for node in self.nodes(link)]
        way = nodes[-1] - nodes[0]
        far = np.hypot(way[:, 0], way[:, 1])
        across = np.stack([-way[:, 1], way[:, 0]], axis=1) / far[:, None]
        low, high = (nodes[k] - nodes[0] for k in (self.count // 2, (self.count + 1) // 2))
        middle = 0.5 * ((low + high) * across).sum(axis=1)
        return ElasticMotion(middle, far - line_of(self.scene, link).length_m)


def segment_spring(own: ElasticLink, length_m: float, count: int, *, corrected: bool) -> float:
    """The rate of a spring between two of ``count`` segments [N m/rad]."""
    rate = own.flexural_n_m2 * count / length_m
    return rate * (1.0 + math.pi**2 / (12.0 * count**2)) if corrected else rate
