"""Scenes for engines, with elastic links cut into rigid segments or beam elements."""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from models.array import Array
from models.errors import CrankcheckError
from models.motion import Motion
from models.scene import Link, Point, Scene
from models.scene.cut_links import CutScene, LinkLine, line_of
from models.scene.elastic import Beam, ElasticLink
from models.scene.loads import SegmentSpring


@dataclass(frozen=True)
class SegmentedScene(CutScene):
    """``scene`` with ``count`` segments for each of its elastic links; ``corrected`` springs give
    the chain the sag of the beam. Raises CrankcheckError as `CutScene`, and for a link that
    stretches.

    ::

        A o--1--@--2--@--3--@ ... --n--o B        @ a pin with a spring, n - 1 of them

    With segments of length l/n, springs of EI n / l and the inertia of slender rods the chain
    converges to the beam of Euler and Bernoulli as 1/n^2: its sag under an even load is too large
    by 0.80/n^2. Springs stiffer by 1 + pi^2/(12 n^2) correct that, and raise its first frequency by
    0.41/n^2 instead. Segments bend, and do not stretch.
    """

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
        """Names of the segments of an elastic link, from its first pin on."""
        return self.bodies(link)

    @cached_property
    def with_nodes(self) -> Scene:
        """Scene with the nodes of its elastic links as named points."""
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
        """Scene for an engine of rigid bodies."""
        return self.given

    def _carried(self, line: LinkLine, place: Point) -> tuple[int, Point]:
        piece = line.length_m / self.count
        x, y = line.along(place)
        i = min(max(int(x / piece + 1e-9), 0), self.count - 1)
        return i, (x - i * piece, y)

    def _links(self, link: Link, line: LinkLine) -> dict[str, Link]:
        """Make the segments, each in a frame of its own from its first point on."""
        piece, nodes = line.length_m / self.count, self.nodes(link.name)
        points: list[dict[str, Point]] = [
            {nodes[i]: (0.0, 0.0), nodes[i + 1]: (piece, 0.0)} for i in range(self.count)
        ]
        self._carry(link, line, points)
        mass = line.density_kg_m * piece
        return {
            name: Link(name, points[i], mass, (0.5 * piece, 0.0), mass * piece**2 / 12.0)
            for i, name in enumerate(self.segments(link.name))
        }

    def _springs(self, link: str) -> dict[str, SegmentSpring]:
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
    """Return the rate of a spring between two of ``count`` segments [N m/rad]."""
    rate = own.flexural_n_m2 * count / length_m
    return rate * (1.0 + math.pi**2 / (12.0 * count**2)) if corrected else rate


HARDLY = 1e6
"""EA l^2/EI of a beam that does not stretch, as of a strip l/290 high: a force F lengthens it by
1e-6 F l^3/EI, and bends it across by 2e4 times that. More gains nothing: elements that cannot
stretch lock, by an error that grows with EA and falls with the fourth power of their number."""
AT_NODE = 1e-9
"""Largest distance from a node of a place that it carries, over the length of an element."""


@dataclass(frozen=True)
class BeamedScene(CutScene):
    """``scene`` with a beam of ``count`` elements for each of its elastic links. Raises
    CrankcheckError as `CutScene`, for a link that does not bend, and for a point of a link that is
    not at a node.

    ::

        A o===1===@===2===@===3===@ ... ===n===o B        @ a node, whose angle is the tangent's

    An engine that has beams (absolute nodal coordinates) bends and stretches the elements itself,
    so they converge to the beam as 1/n^4. The nodes carry places and tangents.
    """

    def __post_init__(self) -> None:
        super().__post_init__()
        for name, link in self.scene.elastic.items():
            if not link.bends:
                raise CrankcheckError(
                    f"{self.scene.name}: elastic.{name} stretches and does not bend, and a beam "
                    "bends; give bends = true"
                )

    @cached_property
    def stretching(self) -> Scene:
        """Elastic scene whose links are as stiff along their line as their beams: a beam that
        starts without the strain of its own axial force rings."""
        elastic = {
            name: replace(own, axial_n=self.given.beams[name].axial_n)
            for name, own in self.scene.elastic.items()
        }
        return replace(self.scene, elastic=elastic)

    def bodies(self, link: str) -> tuple[str, ...]:
        return tuple(f"{link}-node-{i}" for i in range(self.count + 1))

    def _carried(self, line: LinkLine, place: Point) -> tuple[int, Point]:
        piece = line.length_m / self.count
        x, y = line.along(place)
        i = round(x / piece)
        if abs(x - i * piece) > AT_NODE * piece or not 0 <= i <= self.count:
            raise CrankcheckError(
                f"{self.scene.name}: an elastic link has a point {x:g} m from its first pin, which "
                f"is no node of {self.count} elements of {piece:g} m; take as many as put one there"
            )
        return i, (0.0, y)

    def _links(self, link: Link, line: LinkLine) -> dict[str, Link]:
        """Make the nodes, each with its point and half of the mass of the adjacent elements."""
        points: list[dict[str, Point]] = [{node: (0.0, 0.0)} for node in self.nodes(link.name)]
        self._carry(link, line, points)
        mass = line.density_kg_m * line.length_m / self.count
        masses = [0.5 * mass, *[mass] * (self.count - 1), 0.5 * mass]
        return {
            name: Link(name, points[i], masses[i], (0.0, 0.0), 0.0)
            for i, name in enumerate(self.bodies(link.name))
        }

    def _beam(self, link: str) -> Beam:
        own, line = self.scene.elastic[link], line_of(self.scene, link)
        hardly = HARDLY * own.flexural_n_m2 / line.length_m**2
        return Beam(
            link,
            self.bodies(link),
            line.length_m,
            line.density_kg_m,
            own.flexural_n_m2,
            own.axial_n if own.stretches else hardly,
            own.damping_s,
        )

    def _middle(self, motion: Motion, link: str) -> Array:
        """Return a node, or the middle of an element's cubic by its two nodes' tangents."""
        middle = super()._middle(motion, link)
        if self.count % 2 == 0:
            return middle
        names, low = self.bodies(link), self.count // 2
        first, second = (motion.links[name].theta for name in names[low : low + 2])
        bulge = np.stack([np.cos(first) - np.cos(second), np.sin(first) - np.sin(second)], axis=1)
        return middle + line_of(self.scene, link).length_m / self.count / 8.0 * bulge
