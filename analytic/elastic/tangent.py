"""The equations of elastic links next to a motion, well enough for Newton's method.

By one-sided differences, at the ends and in the middle of windows of time; what lies in between is
interpolated. Where the derivatives themselves are asked for: `analytic.elastic.linearised`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from analytic.elastic.reduced import ReducedForm
from models.array import Array

STEP = 1e-5
"""Of the differences, over the longest link."""


@dataclass(frozen=True)
class SlopesOverWindows:
    """``mass``, ``damping`` and ``stiffness`` at the ends and in the middle of W windows, (2 W + 1,
    m, m)."""

    mass: Array
    damping: Array
    stiffness: Array

    def at_shares(self, shares: Array, matrix: Array) -> Array:
        """One of the matrices at shares (S,) of all windows, (W, S, m, m)."""
        x = 2.0 * shares - 1.0
        parabolas = np.stack([0.5 * x * (x - 1.0), 1.0 - x * x, 0.5 * x * (x + 1.0)], axis=1)
        three = np.stack([matrix[:-2:2], matrix[1:-1:2], matrix[2::2]], axis=1)
        return np.asarray(np.einsum("sk,wkab->wsab", parabolas, three))


def tangent(form: ReducedForm, edges_s: Array, z: Array, rates: Array) -> SlopesOverWindows:
    """Of the windows between edges [s] (W + 1,), where coefficients and rates are (W + 1, m)."""
    time_s, z, rates = (_with_middles(own) for own in (edges_s, z, rates))
    near, m = form.near(time_s), form.size
    base = form.at(time_s, z, rates, near)
    seconds = base.seconds
    by = STEP * form.assembly.scene.longest_m
    per_s = by * max(float(np.abs(form.law.at(time_s)[1]).max()), 1.0 / form.period_s)
    stiffness, damping = np.empty_like(base.mass), np.empty_like(base.mass)
    for k, one in enumerate(np.eye(m)):
        now = form.at(time_s, z + by * one, rates, near)
        pushed = ((now.mass - base.mass) @ seconds[:, :, None])[:, :, 0]
        stiffness[:, :, k] = (pushed - (now.force - base.force)) / by
        now = form.at(time_s, z, rates + per_s * one, near)
        damping[:, :, k] = (base.force - now.force) / per_s
    return SlopesOverWindows(base.mass, damping, stiffness)


def _with_middles(values: Array) -> Array:
    """Values at edges, and means between them."""
    both = np.empty((2 * len(values) - 1, *values.shape[1:]))
    both[::2], both[1::2] = values, 0.5 * (values[1:] + values[:-1])
    return both
