"""Scene for engines, its elastic links cut into bodies, and the conversion of its motion back.

::

    A o-----@-----@-----@ ... -----o B        n pieces, n - 1 nodes between them and one at each pin

The bodies are the pieces or the nodes (`models.scene.cut_scenes`).
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from models.array import Array
from models.errors import CrankcheckError
from models.motion import ElasticMotion, LinkMotion, Motion
from models.scene import Link, Point, Scene, Start
from models.scene.elastic import Beam
from models.scene.joints import joined_at, less, turned
from models.scene.loads import Load, PinSpring, Spring


@dataclass(frozen=True)
class CutScene(ABC):
    """``scene`` with its elastic links in ``count`` pieces each. Raises CrankcheckError for fewer
    than two, and where the scene already has a name that the pieces need."""

    scene: Scene
    count: int

    def __post_init__(self) -> None:
        if self.count < 2:
            raise CrankcheckError(
                f"{self.scene.name}: found {self.count} segments; a link bends with 2 or more"
            )
        made = {name for link in self.scene.elastic for name in self.bodies(link)}
        nodes = {node for link in self.scene.elastic for node in self.nodes(link)[1:-1]}
        twice = (made & {*self.scene.links}) | (nodes & {*self._named})
        if twice:
            raise CrankcheckError(
                f"{self.scene.name}: the segments of its elastic links need the name "
                f"{min(twice)}, which the scene has; give that another one"
            )

    @abstractmethod
    def bodies(self, link: str) -> tuple[str, ...]:
        """Names of the bodies of an elastic link, from its first pin on; the first body counts its
        turns."""

    @abstractmethod
    def _links(self, link: Link, line: LinkLine) -> dict[str, Link]:
        """Make these bodies."""

    @abstractmethod
    def _carried(self, line: LinkLine, place: Point) -> tuple[int, Point]:
        """Return the index of the body that carries a place of the link, and the place in it."""

    def _carry(self, link: Link, line: LinkLine, points: Sequence[dict[str, Point]]) -> None:
        """Add the points of a link, except for its pins, to those of the bodies that carry them."""
        for name, place in link.points.items():
            if name not in line.pins:
                body, there = self._carried(line, place)
                points[body][name] = there

    def _springs(self, link: str) -> Mapping[str, Spring]:
        return {}

    def _beam(self, link: str) -> Beam | None:
        return None

    def nodes(self, link: str) -> tuple[str, ...]:
        """Points between its pieces and at their ends."""
        first, last = line_of(self.scene, link).pins
        return (first, *(f"{link}-{i}-{i + 1}" for i in range(1, self.count)), last)

    @cached_property
    def given(self) -> Scene:
        """Scene for the engine."""
        links: dict[str, Link] = {}
        springs = {name: self._held(spring) for name, spring in self.scene.springs.items()}
        for name, link in self.scene.links.items():
            if name in self.scene.elastic:
                links |= self._links(link, line_of(self.scene, name))
                springs |= self._springs(name)
            else:
                links[name] = link
        loads = {name: self._put(load) for name, load in self.scene.loads.items()}
        beams = {name: beam for name in self.scene.elastic if (beam := self._beam(name))}
        return replace(
            self.scene,
            links=links,
            springs=springs,
            loads=loads,
            beams=beams,
            elastic={},
            start=Start(),
        )

    def _carrier(self, body: str, point: str) -> tuple[str, float]:
        """Return the body that carries a named point of a body, and the lean of the body's frame
        [rad]."""
        if body not in self.scene.elastic:
            return body, 0.0
        line = line_of(self.scene, body)
        piece, _ = self._carried(line, self.scene.links[body].points[point])
        return self.bodies(body)[piece], line.lean_rad

    def _put(self, load: Load) -> Load:
        if load.point is None:
            return load
        body, lean = self._carrier(load.body, load.point)
        turned = load.direction_rad - lean if load.frame == "body" else load.direction_rad
        return replace(load, body=body, direction_rad=turned)

    def _held(self, spring: Spring) -> Spring:
        """Move a spring in a pin to the bodies that meet there."""
        if not isinstance(spring, PinSpring):
            return spring
        (first, lean), (second, other) = (self._carrier(b, spring.point) for b in spring.bodies)
        return replace(spring, bodies=(first, second), free=spring.free + other - lean)

    def folded(self, motion: Motion) -> Motion:
        """Convert a motion of the bodies to one of the scene with its elastic links."""
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
        own = {point: None for link in self.scene.links.values() for point in link.points}
        own |= dict.fromkeys(self.scene.ground)
        own |= {slider.point: None for slider in self.scene.sliders.values()}
        return tuple(own)

    def _line_motion(self, motion: Motion, link: str) -> LinkMotion:
        """Return the motion of the line between an elastic link's two pins, as of a rigid link."""
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
        theta = np.arctan2(way[:, 1], way[:, 0]) - line.lean_rad
        near = motion.links[self.bodies(link)[0]].theta - line.lean_rad
        theta = theta + math.tau * np.round((near - theta) / math.tau)
        return LinkMotion(theta, omega, alpha)

    def _shape(self, motion: Motion, link: str) -> ElasticMotion:
        first, last = (motion.points[pin].position for pin in line_of(self.scene, link).pins)
        way = last - first
        far = np.hypot(way[:, 0], way[:, 1])
        across = np.stack([-way[:, 1], way[:, 0]], axis=1) / far[:, None]
        middle = ((self._middle(motion, link) - first) * across).sum(axis=1)
        return ElasticMotion(middle, far - line_of(self.scene, link).length_m)

    def _middle(self, motion: Motion, link: str) -> Array:
        """Return the middle of an elastic link (T, 2) [m]: a node, or the mean of two."""
        nodes = self.nodes(link)
        low, high = nodes[self.count // 2], nodes[(self.count + 1) // 2]
        return 0.5 * (motion.points[low].position + motion.points[high].position)


@dataclass(frozen=True)
class LinkLine:
    """Line from the first of two ``pins`` to the second, in the frame of the link: from ``start``
    [m], at ``lean_rad``, ``length_m`` long."""

    pins: tuple[str, str]
    start: Point
    lean_rad: float
    length_m: float
    density_kg_m: float

    def at(self, x: float) -> Point:
        """Return the place on the line at x from the first pin [m], in the frame of the link."""
        c, s = turned((x, 0.0), self.lean_rad)
        return self.start[0] + c, self.start[1] + s

    def along(self, place: Point) -> Point:
        """Return a place in the link's frame as x along the line from its first pin, and y."""
        return turned(less(place, self.start), -self.lean_rad)


def line_of(scene: Scene, link: str) -> LinkLine:
    """Return the line of a link with two pins."""
    own, joined = scene.links[link], joined_at(scene)
    first, second = (point for point in own.points if link in joined.get(point, ()))
    (ax, ay), (bx, by) = own.points[first], own.points[second]
    length = math.hypot(bx - ax, by - ay)
    lean = math.atan2(by - ay, bx - ax)
    return LinkLine((first, second), (ax, ay), lean, length, own.mass_kg / length)


def with_rigid_links(scene: Scene) -> Scene:
    """Return the scene with all its links rigid."""
    return replace(scene, elastic={}, start=replace(scene.start, shape=None))
