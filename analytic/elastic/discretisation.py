"""By how many shapes, and of which kind, elastic links are described."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from analytic.elastic.beam import ElasticBody
from analytic.elastic.segments import SegmentedBody
from analytic.elastic.shapes import HermiteElements, LegendrePolynomials, Shapes, SineModes
from models.array import Array
from models.cut_links import line_of
from models.elastic import ElasticLink
from models.errors import CrankcheckError
from models.files.elastic_table import SLENDER
from models.motion import Motion
from models.scene import Scene


@dataclass(frozen=True)
class Modes:
    """Ritz and Galerkin's method with so many sines across, and along, each elastic link; those of
    a kind that it has none of are left out."""

    across: int = 5
    along: int = 2

    @property
    def finer(self) -> Polynomials:
        """Polynomials: modes come to what they leave out too slowly to tell how much it is."""
        return Polynomials(max(REFERENCE.across, self.across + 2), self.along + 2)


@dataclass(frozen=True)
class Polynomials:
    """So many polynomials across, and along, each elastic link: what the reference takes."""

    across: int = 8
    along: int = 3

    @property
    def finer(self) -> Polynomials:
        return Polynomials(self.across + 2, self.along + 1)


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

    @property
    def finer(self) -> Segments:
        """As many: a chain is what it is."""
        return self


Discretisation = Polynomials | Modes | Elements | Segments
REFERENCE = Polynomials()
"""Where none is asked for: good to 1e-9 of the largest deflection, and with its resonances where
those of the beam are."""


def flexible_links(
    scene: Scene, by: Discretisation, *, stiffened: bool = True
) -> dict[str, ElasticBody | SegmentedBody]:
    """The elastic links of a scene as what makes their bodies, by name.

    Raises
    ------
    CrankcheckError
        Modes that are too short for a beam; none at all.
    """
    _check(scene, by)
    return {name: _flexible(scene, link, by, stiffened) for name, link in scene.elastic.items()}


def _check(scene: Scene, by: Discretisation) -> None:
    """Raises CrankcheckError for a description that no elastic link can have."""
    for name, link in scene.elastic.items():
        if isinstance(by, Modes | Polynomials):
            counts = [by.across] * link.bends + [by.along] * link.stretches
        else:
            counts = [by.count - isinstance(by, Segments)]
        if min(counts) < 0 or max(counts) < 1:
            raise CrankcheckError(f"{scene.name}: {by} does not describe elastic.{name}; take more")
        if isinstance(by, Modes) and link.bends and link.height_m:
            _check_waves(scene, name, by.across, SLENDER * link.height_m)


def _check_waves(scene: Scene, name: str, count: int, shortest_m: float) -> None:
    length = line_of(scene, name).length_m
    most = int(length / shortest_m * (1.0 + 1e-9))
    if count > most:
        raise CrankcheckError(
            f"{scene.name}: found {count} modes across; the half-waves of the last are "
            f"{length / count:.3g} m long on elastic.{name}, under {SLENDER:g} heights of its "
            f"section, where a beam bends by shear as well; use {most} or fewer"
        )


def _flexible(
    scene: Scene, link: ElasticLink, by: Discretisation, stiffened: bool
) -> ElasticBody | SegmentedBody:
    line = line_of(scene, link.link)
    if isinstance(by, Segments):
        return SegmentedBody(link, line, by.count, by.corrected)
    if isinstance(by, Elements):
        shapes: Shapes = HermiteElements(line.length_m, by.count, link.bends, link.stretches)
    else:
        across, along = by.across if link.bends else 0, by.along if link.stretches else 0
        kind = SineModes if isinstance(by, Modes) else LegendrePolynomials
        shapes = kind(line.length_m, across, along)
    return ElasticBody(link, line, shapes, stiffened)


@dataclass(frozen=True)
class ElasticDoubt:
    """The largest distances from any of the others, (T,) each: ``middle_m`` and ``extension_m`` of
    each elastic link [m], ``theta_rad`` of each link [rad], and ``torque_n_m`` of the driver [N m],
    0 where nothing drives it.

    Where the error at least halves from a description to the next finer one, it is at most twice
    that change.
    """

    middle_m: Mapping[str, Array]
    extension_m: Mapping[str, Array]
    theta_rad: Mapping[str, Array]
    torque_n_m: Array

    @staticmethod
    def between(motion: Motion, *others: Motion) -> ElasticDoubt:
        """Of a motion from others at the same instants."""
        shapes, links = motion.elastic, motion.links
        return ElasticDoubt(
            {
                n: _furthest(x.middle, (o.elastic[n].middle for o in others))
                for n, x in shapes.items()
            },
            {
                n: _furthest(x.extension, (o.elastic[n].extension for o in others))
                for n, x in shapes.items()
            },
            {n: _furthest(x.theta, (o.links[n].theta for o in others)) for n, x in links.items()},
            _furthest(_torque(motion), (_torque(other) for other in others)),
        )

    @property
    def so_far(self) -> ElasticDoubt:
        """The largest up to each instant: what has gone astray does not come back by itself."""
        return ElasticDoubt(
            _running(self.middle_m),
            _running(self.extension_m),
            _running(self.theta_rad),
            np.maximum.accumulate(self.torque_n_m),
        )


def _running(series: Mapping[str, Array]) -> Mapping[str, Array]:
    return {name: np.maximum.accumulate(each) for name, each in series.items()}


def _furthest(one: Array, others: Iterable[Array]) -> Array:
    return np.asarray(np.max([np.abs(one - other) for other in others], axis=0))


def _torque(motion: Motion) -> Array:
    return np.zeros(motion.time_s.size) if motion.forces is None else motion.forces.torque
