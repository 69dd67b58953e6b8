"""Which pairs of many dyads make four-bars without a defect, told for all of them at once.

Only for choosing among thousands: what is chosen is examined by the reference afterwards.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analytic.lectures.synthesis.guided_body import Dyad
from analytic.lectures.synthesis.pose import Pose
from models.array import Array


@dataclass(frozen=True)
class SoundPairs:
    """All pairs of dyads, driven at the first, (K, 2): those without a defect first, ``sound`` of
    them, the best transmitting before others."""

    pairs: NDArray[np.intp]
    sound: int


def sound_pairs(poses: Sequence[Pose], dyads: Sequence[Dyad]) -> SoundPairs:
    """The pairs, those first whose first crank leads through the poses in order and in one
    assembly; each part by the least sine of the transmission angle in the poses."""
    fixed = np.array([dyad.fixed for dyad in dyads])
    own = np.array([dyad.moving for dyad in dyads])
    places = np.array([[pose.at(dyad.moving) for dyad in dyads] for pose in poses])
    radius = np.abs(places[0] - fixed)
    i, k = np.nonzero(~np.eye(len(dyads), dtype=bool))
    ground, coupler = fixed[k] - fixed[i], np.abs(own[k] - own[i])
    a, c, d = radius[i], radius[k], np.abs(ground)
    with np.errstate(divide="ignore", invalid="ignore"):
        crank = (places[:, i] - fixed[i]) / ground * d
        side = ((fixed[k] - places[:, i]).conj() * (places[:, k] - places[:, i])).imag
        sine = np.abs(_cross(places[:, k] - places[:, i], places[:, k] - fixed[k])) / (coupler * c)
    same_sign = np.all(side > 0.0, axis=0) | np.all(side < 0.0, axis=0)
    turns = (a + d <= coupler + c) & (np.abs(a - d) >= np.abs(coupler - c))
    angles = np.angle(crank)
    sound = same_sign & np.where(turns, _in_turn(angles), _in_swing(angles, a, coupler, c, d))
    sound &= np.isfinite(sine).all(axis=0)
    least = np.nan_to_num(np.min(sine, axis=0), nan=-1.0) + 2.0 * sound
    order = np.argsort(-least, kind="stable")
    return SoundPairs(np.stack([i[order], k[order]], axis=1), int(np.count_nonzero(sound)))


def _cross(one: NDArray[np.complex128], other: NDArray[np.complex128]) -> Array:
    return np.asarray((one.conj() * other).imag)


def _in_turn(angles: Array) -> NDArray[np.bool_]:
    """Whether a crank that turns one way meets its angles (N, K) in order within a turn."""
    ways = np.diff(angles, axis=0) % (2.0 * np.pi)
    back = -np.diff(angles, axis=0) % (2.0 * np.pi)
    in_order = (ways.sum(axis=0) < 2.0 * np.pi) | (back.sum(axis=0) < 2.0 * np.pi)
    return np.asarray(in_order)


def _in_swing(angles: Array, a: Array, b: Array, c: Array, d: Array) -> NDArray[np.bool_]:
    """Whether a crank that swings meets its angles (N, K), from the ground's direction, in order
    and within one of its ranges: about 0, about pi, or one on either side."""
    # B is |a - d| from D at angle 0, a + d at pi: beyond what coupler and output span, or too near.
    no_pi, no_zero = a + d > b + c, np.abs(a - d) < np.abs(b - c)
    turned = np.where(no_zero, angles % (2.0 * np.pi), angles)
    ways = np.diff(turned, axis=0)
    in_order = np.all(ways > 0.0, axis=0) | np.all(ways < 0.0, axis=0)
    one_side = np.all(angles > 0.0, axis=0) | np.all(angles < 0.0, axis=0)
    return np.asarray(in_order & np.where(no_pi & no_zero, one_side, True))
