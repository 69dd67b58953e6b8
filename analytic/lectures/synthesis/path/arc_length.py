"""Curves by their own length: what is left of a curve when nobody says how fast it is drawn."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline  # type: ignore[import-untyped]  # ships no stubs

from analytic.lectures.synthesis.path.unit_four_bar import Complexes
from models.array import Array

FINE = 32
"""Chords to which each piece of a spline is cut, to measure it."""


def shares(curves: Complexes) -> Array:
    """Which share of the whole length is drawn at each point of curves (E, M), from 0 to 1."""
    steps = np.abs(np.diff(curves, axis=1))
    total = np.cumsum(steps, axis=1)
    share = np.concatenate([np.zeros((len(curves), 1)), total], axis=1)
    return np.asarray(share / np.maximum(share[:, -1:], np.finfo(np.float64).tiny))


def at_shares(share: Array, values: Complexes | Array, wanted: Array) -> Complexes | Array:
    """Values (E, M) between their own shares, at wanted shares (E, W), each within 0 to 1.

    All rows at once: each is moved by its number, so that they follow each other on one axis.
    """
    rows = 2.0 * np.arange(len(share))[:, None]
    flat = (share + rows).ravel()
    upper = np.searchsorted(flat, (wanted + rows).ravel(), side="right").reshape(wanted.shape)
    first = np.arange(len(share))[:, None] * share.shape[1]
    upper = np.clip(upper, first + 1, first + share.shape[1] - 1)
    low, high = share.ravel()[upper - 1], share.ravel()[upper]
    part = (wanted - low) / np.maximum(high - low, 1e-300)
    before, after = values.ravel()[upper - 1], values.ravel()[upper]
    between: Complexes | Array = before + part * (after - before)
    return between


def smooth(points: Complexes, closed: bool) -> tuple[Complexes, Array]:
    """A fine curve through points, in order, and the shares of its length in them, (N,).

    It is a cubic spline over the length of the chords; a closed curve ends where it starts, and
    the shares are below 1.
    """
    knots = np.append(points, points[0]) if closed else points
    at = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(knots)))])
    spline = CubicSpline(at, knots, bc_type="periodic" if closed else "not-a-knot")
    inner = np.linspace(0.0, 1.0, FINE, endpoint=False)
    fine = np.append((at[:-1, None] + np.diff(at)[:, None] * inner).ravel(), at[-1])
    curve = spline(fine)
    share = shares(curve[None])[0][::FINE]
    return curve, share[: len(points)]
