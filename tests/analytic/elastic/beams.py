"""Elastic links of their own, without a mechanism around them (synthetic)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from analytic.elastic.beam import Beam, ElasticBody
from analytic.elastic.elements import HermiteElements
from analytic.elastic.modes import SineModes
from analytic.elastic.polynomials import LegendrePolynomials
from analytic.elastic.segments import SegmentChain, SegmentedBody
from analytic.elastic.shapes import Shapes
from analytic.multibody.body_set import Marker
from models.array import Array
from models.elastic import ElasticLink
from models.elastic_line import Line
from models.scene import Point

LENGTH_M, DENSITY_KG_M, FLEXURAL_N_M2, AXIAL_N = 0.75, 0.243, 4.725, 6.3e6
LINK = ElasticLink("rod", FLEXURAL_N_M2, AXIAL_N)
STRAIGHT = Line(("A", "B"), (0.0, 0.0), 0.0, LENGTH_M, DENSITY_KG_M)
ASKEW = Line(("A", "B"), (0.11, -0.07), 0.6, LENGTH_M, DENSITY_KG_M)
"""A line that does not start at the origin of the link's frame."""

SHAPES: dict[str, Shapes] = {
    "modes": SineModes(LENGTH_M, 4, 3),
    "polynomials": LegendrePolynomials(LENGTH_M, 5, 3),
    "elements": HermiteElements(LENGTH_M, 3, bends=True, stretches=True),
}


def beam(
    shapes: Shapes,
    line: Line = STRAIGHT,
    markers: Sequence[Marker] = (),
    gravity: Point = (0.0, 0.0),
    *,
    stiffened: bool = True,
) -> Beam:
    return ElasticBody(LINK, line, shapes, stiffened).body(markers, gravity)


def chain(
    count: int,
    line: Line = STRAIGHT,
    markers: Sequence[Marker] = (),
    gravity: Point = (0.0, 0.0),
    *,
    corrected: bool = False,
) -> SegmentChain:
    link = ElasticLink("rod", FLEXURAL_N_M2)
    return SegmentedBody(link, line, count, corrected).body(markers, gravity)


def mass_between_pins(own: Beam | SegmentChain, across: int) -> Array:
    """The mass matrix of the coefficients of so many shapes across (m, m) about the straight link,
    whose line is held still."""
    matrix, _ = own.weigh(np.zeros((1, own.size)), np.zeros((1, own.size)))
    if isinstance(own, Beam):
        return np.asarray(matrix[0, 3 : 3 + across, 3 : 3 + across])
    # The first segment turns so that the far end stays on the line: minus the mean of the others.
    n = own.own.count
    by = np.zeros((own.size, n - 1))
    by[3:] = np.eye(n - 1)
    by[2] = -(n - 1 - np.arange(n - 1)) / n
    return np.asarray(by.T @ matrix[0] @ by)


def frequencies(mass: Array, stiffness: Array) -> Array:
    """Natural frequencies [rad/s], the lowest first."""
    return np.asarray(np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real)))
