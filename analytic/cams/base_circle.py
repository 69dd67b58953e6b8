"""Limits of a cam: undercutting, pressure angle, curvature, and the base circle that keeps them.

A profile undercuts where the radius of curvature of the pitch curve is convex and not above the
roller's, or where that of a flat-faced cam is not above 0 (Norton, Design of Machinery, 5th ed.
2012, ch. 8). A knife edge undercuts nothing.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from analytic.cams.profile import largest, touch, turn_of
from models.array import Array
from models.errors import CrankcheckError
from models.scene.cam_laws import CamLaw
from models.scene.cams import Cam, Follower, OscillatingFollower

LADDER = 40
"""Number of base radii that are tried before the smallest one is refined."""
Margin = Callable[[Cam], float]
"""Distance of a cam from a limit: above 0 where it keeps it."""


def sharpest(cam: Cam) -> tuple[float, float]:
    """Return the largest convex curvature [1/m] of the pitch curve, and where [rad]; for a flat
    face minus the least radius of curvature of the profile [m], which may pass 0 there."""
    if cam.follower.is_flat:
        return largest(turn_of(cam), lambda phi: -touch(cam, phi).radius_m)
    return largest(turn_of(cam), lambda phi: 1.0 / touch(cam, phi).pitch_radius_m)


def curvature_margin(least_m: float = 0.0) -> Margin:
    """Return the margin of a least convex radius of curvature of the profile; 0 is undercutting."""

    def margin(cam: Cam) -> float:
        limit = cam.follower.roller_m + least_m
        most = sharpest(cam)[0]
        if cam.follower.is_flat:
            return -most - limit
        return 1.0 - most * limit

    return margin


def steepest(cam: Cam, *, rising: bool) -> tuple[float, float]:
    """Return the largest magnitude of the pressure angle [rad] where the follower rises or rests,
    or where it returns, and its angle [rad]."""

    def quantity(phi: Array) -> Array:
        contact = touch(cam, phi)
        counts = (contact.lift.first >= 0.0) if rising else (contact.lift.first < 0.0)
        return np.where(counts, np.abs(contact.pressure_rad), 0.0)

    return largest(turn_of(cam), quantity)


def pressure_margin(rise_rad: float, return_rad: float | None = None) -> Margin:
    """Return the margin of permitted pressure angles; without ``return_rad`` returns are free, as
    a spring drives them."""

    def margin(cam: Cam) -> float:
        rise = rise_rad - steepest(cam, rising=True)[0]
        if return_rad is None:
            return rise
        return min(rise, return_rad - steepest(cam, rising=False)[0])

    return margin


def least_base(
    law: CamLaw, follower: Follower, sense: int, margin: Margin, *, from_m: float = 0.0
) -> float:
    """Return the smallest base radius [m] above ``from_m`` with which a cam keeps a limit.

    Raises CrankcheckError where none does. Found on a ladder of radii, and refined to 1e-14 of
    itself.
    """

    def at(start: float) -> float:
        try:
            return margin(Cam(law, follower.base(start), follower, sense))
        except (CrankcheckError, ValueError):
            return -math.inf

    tried = [(float(start), at(start)) for start in _starts(law, follower, from_m)]
    kept = next((k for k, (_, off) in enumerate(tried) if off > 0.0), None)
    if kept is None:
        best = max(tried, key=lambda each: each[1], default=(0.0, -math.inf))
        nearest = f"; the nearest to it is {follower.base(best[0]):.6g} m" if best[0] else ""
        raise CrankcheckError(
            f"no base radius keeps the limit{nearest}: change the stroke, the spans or the follower"
        )
    high = tried[kept][0]
    if kept and math.isfinite(tried[kept - 1][1]):
        # scipy is slow to import, and few need it
        from scipy.optimize import brentq  # type: ignore[import-untyped]  # ships no stubs

        high = brentq(at, tried[kept - 1][0], high, xtol=1e-15, rtol=1e-14)
    return float(follower.base(high))


def _starts(law: CamLaw, follower: Follower, from_m: float) -> Array:
    """Return starts of the follower to try, of growing base radius."""
    stroke = law.extremes(0)[1]
    if not isinstance(follower, OscillatingFollower):
        size = max(stroke, abs(follower.offset_m), follower.roller_m)
        starts = size * np.geomspace(1e-3, 1e3, LADDER)
        least = max(from_m, 1e-3 * size)
    else:
        top = (0.5 if follower.is_flat else 1.0) * math.pi - stroke
        starts = top * np.linspace(-1.0 if follower.is_flat else 0.0, 1.0, LADDER)[1:-1]
        least = max(from_m, 1e-3 * follower.pivot_m)
    bases = np.array([follower.base(start) for start in starts])
    kept = starts[bases > least]
    return np.concatenate([[follower.start(from_m)], kept]) if from_m > 0.0 else kept


def refuse_corners(law: CamLaw, follower: Follower) -> None:
    """Refuse a law whose velocity drops, but for a knife edge. Raises CrankcheckError."""
    drops = [one for one in law.jumps if one.velocity < 0.0]
    if drops and follower.contact != "knife":
        raise CrankcheckError(
            f"the profile undercuts with every base radius: the velocity of its law drops at "
            f"{math.degrees(drops[0].angle_rad):.6g} deg, where only a knife edge follows; give a "
            "law with continuous velocity"
        )


def refuse_undercut(cam: Cam) -> None:
    """Refuse a cam that undercuts. Raises CrankcheckError that says from which base radius on it
    does not."""
    refuse_corners(cam.law, cam.follower)
    if cam.follower.contact == "knife" or curvature_margin()(cam) > 0.0:
        return
    most, phi = sharpest(cam)
    roller = cam.follower.roller_m
    found = (
        f"its radius of curvature is {-most:.6g} m"
        if cam.follower.is_flat
        else f"the pitch curve's convex radius of curvature is {1.0 / most:.6g} m, the roller's "
        f"{roller:.6g} m"
    )
    try:
        least = least_base(cam.law, cam.follower, cam.sense, curvature_margin(), from_m=cam.base_m)
        cure = f"from a base radius of {least:.9g} m on it does not"
    except CrankcheckError as error:
        cure = str(error)
    raise CrankcheckError(
        f"the profile undercuts at {math.degrees(phi):.6g} deg with a base radius of "
        f"{cam.base_m:.6g} m: {found}; {cure}"
    )
