"""By how many shapes, and of which kind, elastic links are described."""

from __future__ import annotations

from dataclasses import dataclass

from analytic.elastic.beam import ElasticBody
from analytic.elastic.elements import HermiteElements
from analytic.elastic.modes import SineModes
from analytic.elastic.segments import SegmentedBody
from models.elastic import ElasticLink
from models.elastic_line import line_of
from models.scene import Scene


@dataclass(frozen=True)
class Modes:
    """Ritz and Galerkin's method with so many sines across, and along, each elastic link; those of
    a kind that it has none of are left out."""

    across: int = 5
    along: int = 2

    @property
    def finer(self) -> Modes:
        return Modes(self.across + 2, self.along + 1)


@dataclass(frozen=True)
class Elements:
    """So many beam elements of each elastic link."""

    count: int = 4

    @property
    def finer(self) -> Elements:
        return Elements(2 * self.count)


@dataclass(frozen=True)
class Segments:
    """So many rigid segments with springs between them: not the beam, but what engines are given
    for it. ``corrected`` springs give the chain the sag of the beam."""

    count: int = 16
    corrected: bool = False


Discretisation = Modes | Elements | Segments


def flexible_links(
    scene: Scene, by: Discretisation, *, stiffened: bool = True
) -> dict[str, ElasticBody | SegmentedBody]:
    """The elastic links of a scene as what makes their bodies, by name."""
    return {name: _flexible(scene, link, by, stiffened) for name, link in scene.elastic.items()}


def _flexible(
    scene: Scene, link: ElasticLink, by: Discretisation, stiffened: bool
) -> ElasticBody | SegmentedBody:
    line = line_of(scene, link.link)
    if isinstance(by, Segments):
        return SegmentedBody(link, line, by.count, by.corrected)
    if isinstance(by, Elements):
        shapes: SineModes | HermiteElements = HermiteElements(
            line.length_m, by.count, link.bends, link.stretches
        )
    else:
        across, along = by.across if link.bends else 0, by.along if link.stretches else 0
        shapes = SineModes(line.length_m, across, along)
    return ElasticBody(link, line, shapes, stiffened)
