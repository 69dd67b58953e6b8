"""An elastic link as a body of the multibody form: a frame on the line of its pins, and shapes.

::

            P                     r_P = r_A + (x + u) e + w n
        .---o---.                 e along the line from A to B, which turns with the link
      A ---------- B -> e         u = extension - (1/2) int_0^x w'^2 dx: a bent link is shorter

Its coordinates are those of a rigid body, then the coefficients of shapes across and along. All
inertia is kept (Coriolis, centrifugal, Euler's, and gyroscopic between u and w), by quadrature over
the link. Without the shortening, as in the thesis, the stiffness that a pulled link gains is lost.
Source: Thesis on vibration of planar mechanisms with elastic links (2018), chapter 2; A. A.
Shabana, Dynamics of Multibody Systems, chapter 5.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from analytic.elastic.shapes import Shapes, places, shortening
from analytic.multibody.bodies import Marker, Markers
from models.array import Array
from models.scene import Point
from models.scene.cut_links import LinkLine
from models.scene.elastic import ElasticLink
from models.scene.joints import turned


@dataclass(frozen=True)
class ElasticBody:
    """Maker of the body of an elastic link (`Flexible`): its line and its shapes. ``stiffened``
    keeps the shortening of the bent link."""

    link: ElasticLink
    line: LinkLine
    shapes: Shapes
    stiffened: bool = True

    def body(self, markers: Sequence[Marker], gravity: Point) -> BeamBody:
        return BeamBody(self, markers, gravity)


@dataclass(frozen=True)
class _Places:
    """K places of the link: x and y [m] (K,), values and slopes of shapes across (K, m), values of
    shapes along (K, n), the shortening S (K, m, m)."""

    x: Array
    y: Array
    deflection: Array
    slope: Array
    extension: Array
    shortening: Array


@dataclass(frozen=True)
class _Spread:
    """Places of a link at coordinates, in the directions of its frame: ``along`` and ``across`` (T,
    K), and their derivatives by the coefficients, (T, K, m + n) and (K, m + n)."""

    along: Array
    across: Array
    along_by: Array
    across_by: Array


class BeamBody:
    """One elastic link (`Body`)."""

    def __init__(self, own: ElasticBody, markers: Sequence[Marker], gravity: Point) -> None:
        self.link, self.shapes = own.link, own.shapes
        self._lean, self._gravity, self._stiffened = own.line.lean_rad, gravity, own.stiffened
        # A in the frame of the link, along and across the line.
        self._start_x, self._start_y = turned(own.line.start, -self._lean)
        shapes = own.shapes
        self._bent = slice(3, 3 + shapes.across)
        self._drawn = slice(3 + shapes.across, 3 + shapes.across + shapes.along)
        self.size = self._drawn.stop
        self.length_m = own.line.length_m
        self.angular = np.concatenate([[False, False, True], shapes.slopes])
        self._on_link = np.array([place is not None for place, _ in markers], dtype=bool)
        local = [own.line.along(place or own.line.start) for place, _ in markers]
        x, y = np.array(local).reshape(-1, 2).T
        self._marked = self._places(x, y)
        self._ahead = np.array([angle for _, angle in markers])
        x, weights = places(shapes)
        self._within = self._places(x, np.zeros_like(x))
        self._mass = own.line.density_kg_m * weights
        self.stiffness = self._stiffness(x, weights)
        self.damping = own.link.damping_s * self.stiffness

    def _places(self, x: Array, y: Array) -> _Places:
        shapes = self.shapes
        short = shortening(shapes, x) if self._stiffened else 0.0
        return _Places(
            x, y, shapes.deflections(x, 0), shapes.deflections(x, 1), shapes.extensions(x, 0),
            np.broadcast_to(short, (len(x), shapes.across, shapes.across)),
        )  # fmt: skip

    def _stiffness(self, x: Array, weights: Array) -> Array:
        """Return EI int f_i'' f_j'' and EA int g_i' g_j', (m + n, m + n)."""
        shapes = self.shapes
        m = shapes.across
        whole = np.zeros((self.size - 3, self.size - 3))
        if m:
            curved = shapes.deflections(x, 2)
            whole[:m, :m] = self.link.flexural_n_m2 * (curved.T * weights) @ curved
        if shapes.along:
            strained = shapes.extensions(x, 1)
            whole[m:, m:] = self.link.axial_n * (strained.T * weights) @ strained
        return whole

    def _shortened(self, at: _Places, bent: Array) -> Array:
        """Return S q at all places, (T, K, m)."""
        count, m = len(at.x), self.shapes.across
        flat = at.shortening.reshape(count * m, m)
        return np.asarray((bent @ flat.T).reshape(len(bent), count, m))

    def _spread(self, at: _Places, q: Array) -> _Spread:
        """Return the places at coordinates (T, n)."""
        bent, drawn = q[:, self._bent], q[:, self._drawn]
        count, m = len(q), self.shapes.across
        along_by = np.empty((count, len(at.x), self.size - 3))
        along_by[:, :, m:] = at.extension
        along = self._start_x + at.x + drawn @ at.extension.T - at.y * (bent @ at.slope.T)
        along_by[:, :, :m] = -at.y[:, None] * at.slope
        if self._stiffened and m:
            short = self._shortened(at, bent)
            along -= 0.5 * (short @ bent[:, :, None])[:, :, 0]
            along_by[:, :, :m] -= short
        across_by = np.zeros((len(at.x), self.size - 3))
        across_by[:, :m] = at.deflection
        across = self._start_y + at.y + bent @ at.deflection.T
        return _Spread(along, across, along_by, across_by)

    def _drift(self, at: _Places, spread: _Spread, rates: Array) -> tuple[Array, Array]:
        """Return the accelerations along and across (T, K) for q'' = 0."""
        omega, own, bending = rates[:, 2:3], rates[:, 3:], rates[:, self._bent]
        along = (spread.along_by @ own[:, :, None])[:, :, 0]
        across = own @ spread.across_by.T
        gained = -2.0 * omega * across - omega**2 * spread.along
        if self._stiffened and self.shapes.across:
            gained -= (self._shortened(at, bending) @ bending[:, :, None])[:, :, 0]
        return gained, 2.0 * omega * along - omega**2 * spread.across

    def _turned(self, q: Array) -> tuple[Array, Array]:
        """Return cosine and sine of the line's angle, (T, 1)."""
        angle = q[:, 2:3] + self._lean
        return np.cos(angle), np.sin(angle)

    def mark(self, q: Array, rates: Array) -> Markers:
        count, at = len(q), self._marked
        (c, s), spread = self._turned(q), self._spread(at, q)
        free = self._on_link
        place = np.zeros((count, len(at.x), 3))
        place[:, :, 0] = q[:, 0:1] + free * (c * spread.along - s * spread.across)
        place[:, :, 1] = q[:, 1:2] + free * (s * spread.along + c * spread.across)
        place[:, :, 2] = q[:, 2:3] + self._ahead + free * (q[:, self._bent] @ at.slope.T)
        gradient = np.zeros((count, len(at.x), 3, self.size))
        gradient[:, :, 0, 0] = gradient[:, :, 1, 1] = gradient[:, :, 2, 2] = 1.0
        gradient[:, :, 0, 2] = free * (-s * spread.along - c * spread.across)
        gradient[:, :, 1, 2] = free * (c * spread.along - s * spread.across)
        c3, s3, by = c[:, :, None], s[:, :, None], free[None, :, None]
        gradient[:, :, 0, 3:] = by * (c3 * spread.along_by - s3 * spread.across_by)
        gradient[:, :, 1, 3:] = by * (s3 * spread.along_by + c3 * spread.across_by)
        gradient[:, :, 2, self._bent] = free[:, None] * at.slope
        drift = np.zeros_like(place)
        if rates.any():
            along, across = self._drift(at, spread, rates)
            drift[:, :, 0] = free * (c * along - s * across)
            drift[:, :, 1] = free * (s * along + c * across)
        return Markers(place, gradient, drift)

    def weigh(self, q: Array, rates: Array) -> tuple[Array, Array]:
        at, (c, s) = self._within, self._turned(q)
        spread = self._spread(at, q)
        # Motion of every bit of mass, along and across the line, for each coordinate.
        moved = np.empty((len(q), 2, len(at.x), self.size))
        moved[:, 0, :, 0], moved[:, 0, :, 1] = c, s
        moved[:, 1, :, 0], moved[:, 1, :, 1] = -s, c
        moved[:, 0, :, 2], moved[:, 1, :, 2] = -spread.across, spread.along
        moved[:, 0, :, 3:], moved[:, 1, :, 3:] = spread.along_by, spread.across_by
        rows = moved.reshape(len(q), -1, self.size)
        mass = np.concatenate([self._mass, self._mass])
        matrix = np.swapaxes(rows * mass[:, None], 1, 2) @ rows
        along, across = self._drift(at, spread, rates)
        g_x, g_y = self._gravity
        felt = np.concatenate([c * g_x + s * g_y - along, c * g_y - s * g_x - across], axis=1)
        right = (np.swapaxes(rows, 1, 2) @ (mass * felt)[:, :, None])[:, :, 0]
        right[:, 3:] -= q[:, 3:] @ self.stiffness + rates[:, 3:] @ self.damping
        return matrix, right

    def height_energy(self, q: Array) -> Array:
        (c, s), spread = self._turned(q), self._spread(self._within, q)
        x = q[:, 0:1] + c * spread.along - s * spread.across
        y = q[:, 1:2] + s * spread.along + c * spread.across
        strain = 0.5 * np.einsum("ti,ij,tj->t", q[:, 3:], self.stiffness, q[:, 3:])
        return np.asarray(strain - (x * self._gravity[0] + y * self._gravity[1]) @ self._mass)

    def lost(self, rates: Array) -> Array:
        """Return the power that its damping takes [W], (T,)."""
        own = rates[:, 3:]
        return np.asarray(np.einsum("ti,ij,tj->t", own, self.damping, own))

    def deflections(self, q: Array, x: Array) -> Array:
        return np.asarray(q[:, self._bent] @ self.shapes.deflections(x, 0).T)

    def strains(self, q: Array, x: Array) -> Array:
        """Return its strain at places x (X,) [m], (T, X)."""
        return np.asarray(q[:, self._drawn] @ self.shapes.extensions(x, 1).T)

    def extension(self, q: Array) -> Array:
        end = self._places(np.array([self.shapes.length_m]), np.zeros(1))
        return np.asarray(self._spread(end, q).along[:, 0] - self._start_x - end.x)
