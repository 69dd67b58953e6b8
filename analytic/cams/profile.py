"""Profile of a cam: pitch curve, contact point, pressure angle, radius of curvature.

Vectors are complex numbers, x + iy. In the frame of the ground, with sigma the sense,

    tip P:   e + i (s0 + s)     or   d - l exp(-i psi),    psi = psi0 + s
    face:    normal N = i       or   i exp(-i psi),  its distance h from the cam's centre
             h = r_b + s        or   d sin(psi) + f

The frame of the cam turns by sigma phi (inversion): there the tip is at exp(-i sigma phi) P, which
traces the pitch curve, and the face envelopes the profile with h as its support function.

Sources: R. L. Norton, Design of Machinery, 5th ed. 2012, ch. 8 (pressure angle, radius of
curvature); F. L. Litvin, A. Fuentes, Gear Geometry and Applied Theory, 2nd ed. 2004, ch. 6
(envelopes). The oscillating follower is derived here.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.array import Array
from models.errors import CrankcheckError
from models.scene.cam_laws import CamLaw, CamLift
from models.scene.cams import Cam, OscillatingFollower

Plane = NDArray[np.complex128]
SAMPLES = 48
"""Samples of a law between two knots; local extremes between them are refined."""


@dataclass(frozen=True, eq=False)
class CamContact:
    """Contact of cam and follower at angles ``phi`` (T,), in the frame of the ground.

    ``lift`` is the law's; ``contact`` and ``normal`` (from the cam to the follower, unit) are
    complex (T,), ``pitch`` is the centre of the roller, or None of a flat face.
    ``pressure_rad`` is the signed angle from the velocity of a rising follower to the normal.
    ``pitch_radius_m`` and ``radius_m`` are radii of curvature of pitch curve and profile, positive
    where convex; of a flat face both are the profile's. ``lever`` is the speed of the contact along
    the normal over that of the lift: cos(alpha), or a length [m] for an oscillating follower.
    """

    phi: Array
    sense: int
    lift: CamLift
    contact: Plane
    normal: Plane
    pitch: Plane | None
    pressure_rad: Array
    pitch_radius_m: Array
    radius_m: Array
    lever: Array

    def on_cam(self, points: Plane) -> Plane:
        """Return points (T,) of the ground in the frame of the cam."""
        return np.asarray(points * np.exp(-1j * self.sense * self.phi))


def touch(cam: Cam, phi: Array) -> CamContact:
    """Return the contact at angles of the cam (T,) [rad]; in a knot that after it.

    Raises CrankcheckError where an oscillating flat face turns as fast as the cam, against it, or
    the follower swings through its dead position. Accurate to rounding over sin(psi).
    """
    lift, flat = cam.law.at(phi), cam.follower.is_flat
    psi, limit = cam.start + lift.value, 0.5 * np.pi if flat else np.pi
    if isinstance(cam.follower, OscillatingFollower) and (
        psi.min() <= -limit * flat or psi.max() >= limit  # where a lift has no force
    ):
        low, high = np.degrees([psi.min(), psi.max()])
        raise CrankcheckError(
            f"psi of the follower goes from {low:.6g} to {high:.6g} deg; its dead positions are at "
            f"{'-90 and 90' if flat else '0 and 180'}: give another base radius, arm or stroke"
        )
    return (_touch_face if flat else _touch_tip)(cam, phi, lift)


def _touch_tip(cam: Cam, phi: Array, lift: CamLift) -> CamContact:
    """Contact of a knife edge or roller, by the derivatives of the pitch curve."""
    follower, sense = cam.follower, cam.sense
    s = cam.start + lift.value
    if isinstance(follower, OscillatingFollower):
        arm = follower.arm_m * np.exp(-1j * s)
        tip, first = follower.pivot_m - arm, 1j * arm * lift.first
        second = arm * (1j * lift.second + lift.first**2)
        along, length = 1j * np.exp(-1j * s), follower.arm_m
    else:
        tip, first, second = follower.offset_m + 1j * s, 1j * lift.first, 1j * lift.second
        along, length = np.full(s.shape, 1j), 1.0
    # Derivatives of exp(-i sigma phi) P, turned back into the ground's frame.
    tangent = first - 1j * sense * tip
    bent = second - 2j * sense * first - tip
    speed = np.abs(tangent)
    normal = 1j * sense * tangent / speed
    # Clockwise round a counter-clockwise cam: its curvature is counted positive where convex.
    curvature = -sense * (tangent.conj() * bent).imag / speed**3
    with np.errstate(divide="ignore"):
        radius = 1.0 / curvature
    cosine = (normal * along.conj()).real
    pressure = np.arctan2((normal * along.conj()).imag, cosine)
    contact = tip - follower.roller_m * normal
    return CamContact(
        phi, sense, lift, contact, normal, tip, pressure, radius,
        radius - follower.roller_m, length * cosine,
    )  # fmt: skip


def _touch_face(cam: Cam, phi: Array, lift: CamLift) -> CamContact:
    """Contact of a flat face, by the derivatives of its support function h(beta)."""
    follower, sense, s = cam.follower, cam.sense, cam.start + lift.value
    h, first, second = s, lift.first, lift.second
    normal, pressure, lever = np.full(s.shape, 1j), np.zeros_like(s), np.ones_like(s)
    turn, faster = lever, pressure  # beta' = -sigma turn: rate of the face against the cam
    if isinstance(follower, OscillatingFollower):
        d, f = follower.pivot_m, follower.face_m
        turn, faster = 1.0 + sense * lift.first, sense * lift.second
        if turn.min() <= 0.0:
            raise CrankcheckError(
                f"the flat face turns by {abs(first).max():.6g} of the cam's speed, with it: the "
                "contact runs to infinity at 1; give the motion a longer span"
            )
        h, first = d * np.sin(s) + f, d * np.cos(s) * lift.first
        second = d * (np.cos(s) * lift.second - np.sin(s) * lift.first**2)
        lever = d * np.cos(s) / turn  # from the pivot's foot on the face to the contact
        normal, pressure = 1j * np.exp(-1j * s), np.arctan2(f, lever)
    contact = normal * (h - 1j * sense * first / turn)
    radius = h + second / turn**2 - first * faster / turn**3
    return CamContact(phi, sense, lift, contact, normal, None, pressure, radius, radius, lever)


def largest(knots: Sequence[float], quantity: Callable[[Array], Array]) -> tuple[float, float]:
    """Return the largest value of a quantity of one argument, and that argument.

    The quantity is smooth between the knots (n,), and takes limits from both sides there. Extremes
    are refined until the value stands still: accurate to rounding, where no two of them stand
    between neighbouring samples.
    """
    ends = np.asarray(knots)
    first, last = ends[:-1, None], np.nextafter(ends[1:, None], ends[0])
    grid = first + (last - first) * np.linspace(0.0, 1.0, SAMPLES)
    grid = np.minimum(grid, last)
    values = quantity(grid.ravel()).reshape(grid.shape)
    best = int(np.argmax(values))
    found = float(values.flat[best]), float(grid.flat[best])
    # A sample above its neighbours may hide more beside it, but no more than the row bends.
    padded = np.pad(values, ((0, 0), (1, 1)), constant_values=-math.inf)
    bend = np.abs(np.diff(values, 2, axis=1)).max(axis=1, keepdims=True)
    peak = (values > padded[:, :-2]) & (values >= padded[:, 2:]) & (values + bend >= found[0])
    row, column = np.nonzero(peak)
    low = grid[row, np.maximum(column - 1, 0)]
    high = grid[row, np.minimum(column + 1, SAMPLES - 1)]
    shares = np.linspace(0.0, 1.0, 33)[:, None]
    for _ in range(8):  # 16^-8 of two samples: below the root of rounding
        fine = low + (high - low) * shares
        values = quantity(fine.ravel()).reshape(fine.shape)
        best = int(np.argmax(values))
        found = max(found, (float(values.flat[best]), float(fine.flat[best])))
        centre, step = np.argmax(values, axis=0), (high - low) / 32
        low, high = (
            np.maximum(low + (centre - 1) * step, low),
            np.minimum(low + (centre + 1) * step, high),
        )
    return found


def corners(law: CamLaw, sign: int = 1) -> list[float]:
    """Return the angles [rad] of the corners of a profile: where the velocity of its law drops, or,
    with ``sign`` -1, grows, and the corner is concave."""
    return [one.angle_rad for one in law.jumps if sign * one.velocity < 0.0]
