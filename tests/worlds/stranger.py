"""Three linkages moved by somebody who has never heard of us: plain numpy, imports nothing of ours.

In complex numbers: a crank, and pairs of bars, or a rod and a block, that hang on what moves
already. Where they meet is the intersection of two circles, or of one with the x-axis; rates follow
from the loops once differentiated, accelerations from the loops twice differentiated. Numbers are
those that anybody reads off the drawings.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Vectors = NDArray[np.complex128]
Point = tuple[float, float]


@dataclass(frozen=True)
class Linkage:
    """Bars with their points, each in the frame of its bar [m], whose first is the origin; blocks
    on the x-axis, by the point that they carry. By pin, the ``pairs``: the bars that are placed by
    meeting there, to the left of the line between their origins, or the one bar, ahead."""

    ground: Mapping[str, Point]
    bars: Mapping[str, Mapping[str, Point]]
    blocks: tuple[str, ...]
    pairs: Mapping[str, tuple[str, ...]]
    speed_rad_s: float = 10.0
    start_deg: float = 90.0

    @property
    def period_s(self) -> float:
        return math.tau / abs(self.speed_rad_s)


ORIGIN = (0.0, 0.0)
FOURBAR = Linkage(
    ground={"A": ORIGIN, "D": (0.3, 0.0)},
    bars={
        "crank": {"A": ORIGIN, "B": (0.1, 0.0)},
        "coupler": {"B": ORIGIN, "C": (0.25, 0.0)},
        "rocker": {"D": ORIGIN, "C": (0.2, 0.0)},
    },
    blocks=(),
    pairs={"C": ("coupler", "rocker")},
)
SLIDER_CRANK = Linkage(
    ground={"A": ORIGIN},
    bars={"crank": FOURBAR.bars["crank"], "rod": {"B": ORIGIN, "C": (0.3, 0.0)}},
    blocks=("C",),
    pairs={"C": ("rod",)},
    start_deg=30.0,
)
SIXBAR = Linkage(
    ground={**FOURBAR.ground, "G": (0.65, 0.0)},
    bars={
        **FOURBAR.bars,
        "rocker": {"D": ORIGIN, "C": (0.2, 0.0), "E": (0.12, -0.12)},
        "rod": {"E": ORIGIN, "F": (0.3, 0.0)},
        "lever": {"G": ORIGIN, "F": (0.25, 0.0)},
    },
    blocks=(),
    pairs={**FOURBAR.pairs, "F": ("rod", "lever")},
)
LINKAGES = {
    "fourbar-lecture-1": FOURBAR,
    "slider-crank-central": SLIDER_CRANK,
    "sixbar-watt": SIXBAR,
}
"""By the name of the same mechanism among the shipped scenes."""


@dataclass(frozen=True)
class Course:
    """What a linkage did: of each bar the angle with its first two rates, each (T,)."""

    linkage: Linkage
    time_s: Array
    angles: dict[str, tuple[Array, Array, Array]]

    def angle(self, bar: str) -> tuple[Array, Array, Array]:
        return self.angles[bar]

    def point(self, name: str, on: str = "") -> tuple[Array, Array, Array]:
        """Position, velocity, acceleration (T, 2) of a point, as the first bar, or that ``on``
        which it is said to be, carries it."""
        place, velocity, acceleration = (
            np.stack([each.real, each.imag], axis=1) for each in self.moved(name, on)
        )
        return place, velocity, acceleration

    def moved(self, name: str, on: str = "") -> tuple[Vectors, Vectors, Vectors]:
        """As `point`, in complex numbers."""
        still, bars = np.zeros(len(self.time_s), complex), self.linkage.bars
        if name in self.linkage.ground:
            return still + complex(*self.linkage.ground[name]), still, still
        on = on or next(bar for bar, points in bars.items() if name in points)
        place, velocity, acceleration = self.moved(next(iter(bars[on])))
        theta, omega, alpha = self.angles[on]
        arm = complex(*bars[on][name]) * np.exp(1j * theta)
        return (
            place + arm,
            velocity + 1j * omega * arm,
            acceleration + (1j * alpha - omega**2) * arm,
        )

    def hang(self, pin: str, bars: tuple[str, ...]) -> None:
        """Find the angles of the bars that meet in a pin."""
        ends = [self.moved(next(iter(self.linkage.bars[bar]))) for bar in bars]
        own = [complex(*self.linkage.bars[bar][pin]) for bar in bars]
        find = _two_bars if len(bars) == 2 else _rod_and_block
        for bar, at, (arm, omega, alpha) in zip(bars, own, find(ends, own), strict=True):
            self.angles[bar] = np.unwrap(np.angle(arm / at)), omega, alpha


Found = list[tuple[Vectors, Array, Array]]
"""Of each bar the way from its origin to the pin, its angular velocity and acceleration."""


def _two_bars(ends: Sequence[tuple[Vectors, ...]], own: list[complex]) -> Found:
    (p, vp, ap), (q, vq, aq) = ends
    apart = q - p
    span = np.abs(apart)
    along = (abs(own[0]) ** 2 - abs(own[1]) ** 2 + span**2) / (2.0 * span)
    one = apart / span * (along + 1j * np.sqrt(abs(own[0]) ** 2 - along**2))
    other = one - apart

    def turning(difference: Vectors) -> tuple[Array, Array]:
        """The real m and n of i (m one - n other) = difference."""
        across = (1j * one * other.conj()).real
        return (difference * other.conj()).real / across, (difference * one.conj()).real / across

    m, n = turning(vq - vp)
    gains = turning(aq - ap + m**2 * one - n**2 * other)
    return list(zip((one, other), (m, n), gains, strict=True))


def _rod_and_block(ends: Sequence[tuple[Vectors, ...]], own: list[complex]) -> Found:
    ((p, v, a),) = ends
    arm = np.sqrt(abs(own[0]) ** 2 - p.imag**2) - 1j * p.imag
    omega = -v.imag / arm.real
    return [(arm, omega, (omega**2 * arm.imag - a.imag) / arm.real)]


def course(linkage: Linkage, time_s: Array) -> Course:
    """The motion at those times [s], before the start as well."""
    theta = math.radians(linkage.start_deg) + linkage.speed_rad_s * time_s
    constant = np.full_like(time_s, linkage.speed_rad_s), np.zeros_like(time_s)
    found = Course(linkage, time_s, {"crank": (theta, *constant)})
    for pin, bars in linkage.pairs.items():
        found.hang(pin, bars)
    return found
