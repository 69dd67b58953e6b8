"""Three rows of given kinds, drawn at random."""

from __future__ import annotations

import itertools
import math

import numpy as np

from analytic.assur.leg_rows import AngleRow, CircleRow, LegRow, LegRows, LineRow, ThroughRow
from models.scene import Point

KINDS = ("RR", "PR", "RP", "PP")
MOST = {
    ("RR", "RR", "RR"): 6,
    ("RR", "RR", "PR"): 6,
    ("RR", "RR", "RP"): 6,
    ("RR", "RR", "PP"): 2,
    ("RR", "PR", "PR"): 4,
    ("RR", "PR", "RP"): 6,
    ("RR", "PR", "PP"): 2,
    ("RR", "RP", "RP"): 4,
    ("RR", "RP", "PP"): 2,
    ("PR", "PR", "PR"): 2,
    ("PR", "PR", "RP"): 4,
    ("PR", "PR", "PP"): 1,
    ("PR", "RP", "RP"): 4,
    ("PR", "RP", "PP"): 1,
    ("RP", "RP", "RP"): 2,
    ("RP", "RP", "PP"): 1,
}
"""All choices of three legs that can be solved, in any order, and how many assemblies they have at
most. Two legs PP hold the same angle twice."""
SINGULAR = tuple(
    kinds for kinds in itertools.combinations_with_replacement(KINDS, 3) if kinds.count("PP") > 1
)


def drawn(kinds: tuple[str, str, str], seed: int) -> LegRows:
    """Rows of size 1: every other one of a pose that they have, so that there is an assembly."""
    draw = np.random.default_rng([seed, *(KINDS.index(kind) for kind in kinds)])
    pose = (complex(*draw.normal(size=2)), draw.uniform(-math.pi, math.pi)) if seed % 2 else None
    one, two, three = (_row(kind, draw, pose) for kind in kinds)
    return one, two, three


def _row(kind: str, draw: np.random.Generator, pose: tuple[complex, float] | None) -> LegRow:
    a, at = complex(*draw.normal(size=2)), complex(*draw.normal(size=2))
    length, way = draw.uniform(0.3, 2.0), draw.uniform(-math.pi, math.pi)
    if pose is None:
        there, phi = at + length * np.exp(1j * draw.uniform(-math.pi, math.pi)), way
    else:
        there, phi = pose[0] + np.exp(1j * pose[1]) * a, pose[1]  # of the point a of the link
    if kind == "RR":
        return CircleRow(_pair(a), _pair(at), float(abs(at - there)))
    if kind == "PR":
        return LineRow(_pair(a), _pair(np.exp(1j * way)), _pair(there))
    if kind == "RP":
        return ThroughRow(
            _pair(1j * (at - there) / abs(at - there) * np.exp(-1j * phi)), _pair(a), _pair(at)
        )
    return AngleRow(_pair(np.exp(1j * phi)))


def _pair(number: complex) -> Point:
    return float(number.real), float(number.imag)
