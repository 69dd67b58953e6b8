"""Three linkages moved by somebody who has never heard of us: plain numpy, imports nothing of ours.

Redundant coordinates: x, y and theta of every moving body. Two bodies that carry the same point are
pinned there, a block slides on its line, and the crank is turned by a driving constraint. With the
constraints phi(q, t) = 0 and their Jacobian J:

    J q' = nu       nu = the crank's speed, else 0      velocities, at every stage of RK4
    J q'' = gamma   gamma = what turns with omega^2     accelerations, at the samples

The start is solved for by Newton's method from a rough guess, which also says in which of its two
ways the linkage is put together. Numbers are those that anybody reads off the drawings.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Point = tuple[float, float]
Pose = tuple[float, float, float]
"""x [m], y [m], theta [deg]."""
STEPS_PER_TURN = 240
"""Of RK4, at least: they leave 1e-9 of a length or an angle after two turns."""


@dataclass(frozen=True)
class Linkage:
    """Bars with their points, each in the frame of its bar [m]; blocks, each on a line through a
    point of the ground and at an angle [deg], as the point that they carry; a crank.

    ``guess`` is where the bodies are at the start, roughly; in ``other`` they are put together the
    other way.
    """

    ground: Mapping[str, Point]
    bars: Mapping[str, Mapping[str, Point]]
    blocks: Mapping[str, tuple[Point, float]]
    crank: str
    speed_rad_s: float
    start_deg: float
    guess: Mapping[str, Pose]
    other: Mapping[str, Pose]

    @property
    def period_s(self) -> float:
        return math.tau / abs(self.speed_rad_s)

    @cached_property
    def bodies(self) -> Mapping[str, Mapping[str, Point]]:
        return {**self.bars, **{name: {name: (0.0, 0.0)} for name in self.blocks}}

    def otherwise(self) -> Linkage:
        """The same bars, put together the other way."""
        return replace(self, guess=self.other, other=self.guess)

    def stretched(self, bar: str, factor: float) -> Linkage:
        """The linkage with one bar that much longer."""
        points = {name: (factor * x, factor * y) for name, (x, y) in self.bars[bar].items()}
        return replace(self, bars={**self.bars, bar: points})


FOURBAR = Linkage(
    ground={"A": (0.0, 0.0), "D": (0.3, 0.0)},
    bars={
        "crank": {"A": (0.0, 0.0), "B": (0.1, 0.0)}, "coupler": {"B": (0.0, 0.0), "C": (0.25, 0.0)},
        "rocker": {"D": (0.0, 0.0), "C": (0.2, 0.0)}},
    blocks={}, crank="crank", speed_rad_s=10.0, start_deg=90.0,
    guess={"crank": (0, 0, 90), "coupler": (0, 0.1, 20), "rocker": (0.3, 0, 110)},
    other={"crank": (0, 0, 90), "coupler": (0, 0.1, -60), "rocker": (0.3, 0, 220)})  # fmt: skip
SLIDER_CRANK = Linkage(
    ground={"A": (0.0, 0.0)},
    bars={"crank": {"A": (0.0, 0.0), "B": (0.1, 0.0)}, "rod": {"B": (0.0, 0.0), "C": (0.3, 0.0)}},
    blocks={"C": ((0.0, 0.0), 0.0)},
    crank="crank",
    speed_rad_s=10.0,
    start_deg=30.0,
    guess={"crank": (0, 0, 30), "rod": (0.09, 0.05, -10), "C": (0.4, 0, 0)},
    other={"crank": (0, 0, 30), "rod": (0.09, 0.05, 190), "C": (-0.2, 0, 0)},
)
SIXBAR = Linkage(
    ground={**FOURBAR.ground, "G": (0.65, 0.0)},
    bars={
        **FOURBAR.bars, "rocker": {"D": (0.0, 0.0), "C": (0.2, 0.0), "E": (0.12, -0.12)},
        "rod": {"E": (0.0, 0.0), "F": (0.3, 0.0)}, "lever": {"G": (0.0, 0.0), "F": (0.25, 0.0)}},
    blocks={}, crank="crank", speed_rad_s=10.0, start_deg=90.0,
    guess={**FOURBAR.guess, "rod": (0.37, 0.15, 20), "lever": (0.65, 0, 90)},
    other={**FOURBAR.guess, "rod": (0.37, 0.15, -70), "lever": (0.65, 0, 210)})  # fmt: skip
LINKAGES = {
    "fourbar-lecture-1": FOURBAR,
    "slider-crank-central": SLIDER_CRANK,
    "sixbar-watt": SIXBAR,
}
"""By the name of the same mechanism among the shipped scenes."""


@dataclass(frozen=True)
class Course:
    """What a linkage did: its coordinates with their first two rates, each (T, 3 n)."""

    linkage: Linkage
    time_s: Array
    q: Array
    v: Array
    a: Array

    def angle(self, body: str) -> tuple[Array, Array, Array]:
        k = 3 * list(self.linkage.bodies).index(body) + 2
        return self.q[:, k], self.v[:, k], self.a[:, k]

    def point(self, name: str, on: str = "") -> tuple[Array, Array, Array]:
        """Position, velocity, acceleration (T, 2) of a point, as the first body, or that ``on``
        which it is said to be, carries it."""
        bodies = self.linkage.bodies
        on = on or next(body for body, points in bodies.items() if name in points)
        x, y = bodies[on][name]
        k = 3 * list(bodies).index(on)
        theta, omega, alpha = (series[:, None] for series in self.angle(on))
        along = np.hstack([np.cos(theta) * x - np.sin(theta) * y] * 2)
        along[:, 1:] = np.sin(theta) * x + np.cos(theta) * y
        across = np.stack([-along[:, 1], along[:, 0]], axis=1)
        return (
            self.q[:, k : k + 2] + along,
            self.v[:, k : k + 2] + omega * across,
            self.a[:, k : k + 2] + alpha * across - omega**2 * along,
        )


def course(linkage: Linkage, time_s: Array) -> Course:
    """Integrate from time 0 to every one of the times [s], which rise."""
    equations = _Equations(linkage)
    q, now = equations.assembled(), 0.0
    longest = linkage.period_s / STEPS_PER_TURN
    samples = np.empty((len(time_s), q.size))
    for k, time in enumerate(time_s):
        steps = math.ceil((time - now) / longest)
        for _ in range(steps):
            q = equations.stepped(q, (time - now) / steps)
        samples[k], now = q, time
    velocity = equations.velocity(samples)
    return Course(linkage, time_s, samples, velocity, equations.acceleration(samples, velocity))


class _Equations:
    """The constraints of a linkage: two of every pin, two of each block, one of the crank. ``ends``
    at the pins are the constraint's first row, the body, its side (1 or -1), and its point."""

    def __init__(self, linkage: Linkage) -> None:
        self.linkage = linkage
        names = list(linkage.bodies)
        pins = list(_pins(linkage))
        ends = [(2 * k, *end) for k, (pair, _) in enumerate(pins) for end in pair]
        self.row = np.array([end[0] for end in ends])
        self.body = np.array([3 * names.index(end[1]) for end in ends])
        self.side = np.array([end[2] for end in ends], dtype=float)
        self.x, self.y = (np.array([end[3][axis] for end in ends]) for axis in (0, 1))
        size = 3 * len(names)
        self.fixed = np.zeros((size, size))  # the part of the Jacobian that never changes
        self.fixed[self.row, self.body] = self.side
        self.fixed[self.row + 1, self.body + 1] = self.side
        self.target = np.zeros(size)
        for k, (_, place) in enumerate(pins):
            self.target[2 * k : 2 * k + 2] = place
        row = 2 * len(pins)
        for name, (through, degrees) in linkage.blocks.items():
            k, angle = 3 * names.index(name), math.radians(degrees)
            normal = np.array([-math.sin(angle), math.cos(angle)])
            self.fixed[row, k : k + 2] = normal
            self.fixed[row + 1, k + 2] = 1.0
            self.target[row : row + 2] = normal @ np.array(through), angle
            row += 2
        self.fixed[row, 3 * names.index(linkage.crank) + 2] = 1.0
        self.target[row] = math.radians(linkage.start_deg)
        self.nu = np.zeros(size)
        self.nu[row] = linkage.speed_rad_s
        assert row + 1 == size

    def assembled(self) -> Array:
        """The coordinates (3 n,) at the start, by Newton's method."""
        poses = np.array([self.linkage.guess[name] for name in self.linkage.bodies], dtype=float)
        poses[:, 2] = np.radians(poses[:, 2])
        q = poses.ravel()
        for _ in range(20):
            jacobian, arm = self._jacobian(q)
            residual = self.fixed @ q - self.target
            np.add.at(residual, self.row, self.side * arm[0])
            np.add.at(residual, self.row + 1, self.side * arm[1])
            q = q - np.linalg.solve(jacobian, residual)
        assert np.max(np.abs(residual)) < 1e-14, "the guess is too rough"
        return q

    def stepped(self, q: Array, step_s: float) -> Array:
        k1 = self.velocity(q)
        k2 = self.velocity(q + step_s / 2 * k1)
        k3 = self.velocity(q + step_s / 2 * k2)
        k4 = self.velocity(q + step_s * k3)
        return np.asarray(q + step_s / 6 * (k1 + 2 * k2 + 2 * k3 + k4))

    def velocity(self, q: Array) -> Array:
        return _solved(self._jacobian(q)[0], self.nu)

    def acceleration(self, q: Array, v: Array) -> Array:
        jacobian, arm = self._jacobian(q)
        gamma = np.zeros_like(q)
        inward = self.side * v[..., self.body + 2] ** 2
        for axis in (0, 1):
            np.add.at(gamma, (..., self.row + axis), inward * arm[axis])
        return _solved(jacobian, gamma)

    def _jacobian(self, q: Array) -> tuple[Array, tuple[Array, Array]]:
        """The Jacobian (..., 3 n, 3 n), and from every body's origin to its ends."""
        theta = q[..., self.body + 2]
        cos, sin = np.cos(theta), np.sin(theta)
        right, up = cos * self.x - sin * self.y, sin * self.x + cos * self.y
        jacobian = np.empty((*q.shape, q.shape[-1]))
        jacobian[...] = self.fixed
        jacobian[..., self.row, self.body + 2] = -self.side * up
        jacobian[..., self.row + 1, self.body + 2] = self.side * right
        return jacobian, (right, up)


def _pins(linkage: Linkage) -> Iterator[tuple[list[tuple[str, int, Point]], Point]]:
    """The ends of each pin, (body, side, point), and where the ground holds it (0, 0 between two
    bodies)."""
    first: dict[str, tuple[str, Point]] = {}
    for body, points in linkage.bodies.items():
        for name, place in points.items():
            if name in linkage.ground:
                yield [(body, 1, place)], linkage.ground[name]
            elif name in first:
                other, there = first[name]
                yield [(body, 1, place), (other, -1, there)], (0.0, 0.0)
            else:
                first[name] = body, place


def _solved(matrix: Array, right: Array) -> Array:
    """The solutions of linear equations, for one right side or for as many as matrices."""
    return np.asarray(np.linalg.solve(matrix, right[..., None])[..., 0])
