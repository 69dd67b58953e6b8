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

from models.cut_links import CutScene
from models.elastic import ElasticLink
from models.elastic_line import Line, line_of
from models.errors import CrankcheckError
from models.scene import Link, Point, Scene
from models.springs import SegmentSpring


@dataclass(frozen=True)
class SegmentedScene(CutScene):
    """``scene`` with ``count`` segments for each of its elastic links; ``corrected`` springs give
    the chain the sag of the beam. Raises CrankcheckError as `CutScene`, and for a link that
    stretches."""

    corrected: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        for name, link in self.scene.elastic.items():
            if link.stretches:
                raise CrankcheckError(
                    f"{self.scene.name}: elastic.{name} stretches, and a chain of segments does "
                    "not; give stretches = false, or an engine that has beams (--springs beam)"
                )

    def bodies(self, link: str) -> tuple[str, ...]:
        return tuple(f"{link}-{i}" for i in range(1, self.count + 1))

    def segments(self, link: str) -> tuple[str, ...]:
        """The names of the segments of an elastic link, from its first pin on."""
        return self.bodies(link)

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

    @property
    def rigid(self) -> Scene:
        """The scene that an engine of rigid bodies is given."""
        return self.given

    def _carried(self, line: Line, place: Point) -> tuple[int, Point]:
        piece = line.length_m / self.count
        x, y = line.along(place)
        i = min(max(int(x / piece + 1e-9), 0), self.count - 1)
        return i, (x - i * piece, y)

    def _links(self, link: Link, line: Line) -> dict[str, Link]:
        """The segments, each in a frame of its own from its first point on."""
        piece, nodes = line.length_m / self.count, self.nodes(link.name)
        points: list[dict[str, Point]] = [
            {nodes[i]: (0.0, 0.0), nodes[i + 1]: (piece, 0.0)} for i in range(self.count)
        ]
        for name, place in link.points.items():
            if name not in line.pins:
                i, there = self._carried(line, place)
                points[i][name] = there
        mass = line.density_kg_m * piece
        return {
            name: Link(name, points[i], mass, (0.5 * piece, 0.0), mass * piece**2 / 12.0)
            for i, name in enumerate(self.segments(link.name))
        }

    def _springs(self, link: str) -> dict[str, SegmentSpring]:
        """In all pins between segments."""
        own, line = self.scene.elastic[link], line_of(self.scene, link)
        names, nodes = self.segments(link), self.nodes(link)
        rate = segment_spring(own, line.length_m, self.count, corrected=self.corrected)
        return {
            node: SegmentSpring(
                node, rate, rate * own.damping_s, 0.0, node, (names[i], names[i + 1])
            )
            for i, node in enumerate(nodes[1:-1])
        }


def segment_spring(own: ElasticLink, length_m: float, count: int, *, corrected: bool) -> float:
    """The rate of a spring between two of ``count`` segments [N m/rad]."""
    rate = own.flexural_n_m2 * count / length_m
    return rate * (1.0 + math.pi**2 / (12.0 * count**2)) if corrected else rate
