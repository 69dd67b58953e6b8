"""Elastic links over time, driven by a law: Gauss' collocation on the reduced form.

The method is implicit, of order 2 s for s nodes, stable at every step, and keeps the energy of
undamped shapes: those whose cycles are shorter than its windows ring on at the wrong frequency, and
do no harm where they are hardly excited. Some windows are solved for at once by Newton's method,
with derivatives of the equations taken at a few instants of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.polynomial import legendre

from analytic.elastic.reduced import ReducedForm
from analytic.free.window import gauss
from models.array import Array
from models.errors import CrankcheckError

NODES = 10
RULE = gauss(NODES)
TWICE, END_TWICE = RULE.once @ RULE.once, RULE.end_once @ RULE.once
"""Rates are integrated as accelerations are, from their values at the nodes; integrated as the
polynomials that they are, the method would not be stable."""
BLOCK = 16
"""Number of windows that are solved at once."""
SHORTEST = 1.0 / 16.0
"""Shortest window, over the requested ones, below which none is halved to meet the equations."""
MOST_ROUNDS, MOST_TANGENTS = 40, 6
CLOSE, NEARLY = 1e-13, 1e-9
"""Largest change of accelerations in a last round, over the largest. Where rounding leaves more, in
stiff or hardly bent links: the change of coefficients, over the longest link, or nearly over their
size and movement in a window."""
SLOW = 0.3
"""Largest ratio of a round's step to the last before the derivatives are computed again."""


@dataclass(frozen=True)
class VibrationHistory:
    """Coefficients and rates (W, m) at the beginnings of W windows between ``edges_s`` [s] (W +
    1,), and the series of their second derivatives in Legendre's polynomials, (W, NODES, m)."""

    edges_s: Array
    z: Array
    rates: Array
    series: Array

    def at(self, time_s: Array) -> tuple[Array, Array, Array]:
        """Return the coefficients, their rates and second derivatives at times [s], (T, m) each."""
        found = np.searchsorted(self.edges_s, time_s, side="right") - 1
        window = np.clip(found, 0, len(self.z) - 1)
        begin, h = self.edges_s[window], np.diff(self.edges_s)[window]
        share, series = (time_s - begin) / h, self.series[window]
        second, first, zeroth = (
            np.einsum(
                "tk,tkm->tm", legendre.legvander(2.0 * share - 1.0, NODES - 1 + k) @ lift, series
            )
            for k, lift in enumerate((np.eye(NODES), RULE.lift_once, RULE.lift_twice))
        )
        h, rates = h[:, None], self.rates[window]
        return (
            self.z[window] + h * share[:, None] * rates + h * h * zeroth,
            rates + h * first,
            second,
        )


def vibrate(
    form: ReducedForm,
    z: Array,
    rates: Array,
    until_s: float,
    windows: int,
    kinks_s: Sequence[float] = (),
) -> VibrationHistory:
    """Integrate the motion from coefficients and rates (m,) at time 0, in so many windows of time,
    or a few more: some end at ``kinks_s``, where the equations are not smooth, and windows in which
    they are not met are halved.

    Raises
    ------
    CrankcheckError
        A window in which the equations are not met; links that bend too far.
    """
    edges = _edges(until_s, windows, kinks_s)
    kept: list[_StepBlock] = []
    done, most = 0, BLOCK
    while done < len(edges) - 1:
        block = _StepBlock.solved(form, edges[done : done + most + 1], z, rates)
        if block is None:
            begin, end = edges[done : done + 2]
            if most > 1:
                most = max(1, most // 4)
            elif end - begin > SHORTEST * until_s / windows:
                edges = np.insert(edges, done + 1, 0.5 * (begin + end))
            else:
                raise CrankcheckError(
                    f"{form.assembly.scene.name}: at {begin:g} s the equations of its elastic "
                    f"links are not met, not even in {end - begin:.3g} s: they bend too far for a "
                    "beam; make them stiffer, or drive slower"
                )
            continue
        kept.append(block)
        done += len(block.seconds)
        most = min(BLOCK, 2 * most)
        z, rates = block.z[-1], block.rates[-1]
    return VibrationHistory(
        edges,
        np.concatenate([block.z[:-1] for block in kept]),
        np.concatenate([block.rates[:-1] for block in kept]),
        np.concatenate([RULE.series @ block.seconds for block in kept]),
    )


def _edges(until_s: float, windows: int, kinks_s: Sequence[float]) -> Array:
    """Return the ends of all windows, (W + 1,)."""
    ends = [0.0, *sorted({kink for kink in kinks_s if 0.0 < kink < until_s}), until_s]
    longest = until_s / windows
    pieces = [
        np.linspace(begin, end, max(1, int(np.ceil((end - begin) / longest - 1e-9))) + 1)[:-1]
        for begin, end in pairwise(ends)
    ]
    return np.array([*np.concatenate(pieces), until_s])


@dataclass(frozen=True)
class _StepBlock:
    """W windows: coefficients and rates at their beginnings and at the end of the last, (W + 1, m),
    and second derivatives at their nodes, (W, NODES, m)."""

    z: Array
    rates: Array
    seconds: Array

    @staticmethod
    def along(h: Array, z: Array, rates: Array, seconds: Array) -> _StepBlock:
        """Integrate second derivatives from coefficients and rates (m,) at the beginning."""
        gained = h[:, None] * np.tensordot(seconds, RULE.end_once, (1, 0))
        every = rates + np.concatenate([np.zeros_like(gained[:1]), np.cumsum(gained, axis=0)])
        moved = h[:, None] * every[:-1]
        moved += (h**2)[:, None] * np.tensordot(seconds, END_TWICE, (1, 0))
        places = z + np.concatenate([np.zeros_like(moved[:1]), np.cumsum(moved, axis=0)])
        return _StepBlock(places, every, seconds)

    def reach(self, h: Array) -> float:
        """Return the largest coefficient, or change of one by rates or accelerations."""
        longest = float(h.max())
        each = (self.z, longest * self.rates, longest**2 * self.seconds)
        return max(float(np.abs(own).max()) for own in each)

    def nodes(self, h: Array) -> tuple[Array, Array]:
        """Return coefficients and rates at the nodes, (W, NODES, m)."""
        step = h[:, None, None]
        rates = self.rates[:-1, None] + step * (RULE.once @ self.seconds)
        z = self.z[:-1, None] + step * RULE.places[:, None] * self.rates[:-1, None]
        return z + step**2 * (TWICE @ self.seconds), rates

    @staticmethod
    def solved(form: ReducedForm, edges: Array, z: Array, rates: Array) -> _StepBlock | None:
        """Solve the windows between edges (W + 1,); None if Newton's method does not converge."""
        h, m = np.diff(edges), form.size
        times = (edges[:-1, None] + h[:, None] * RULE.places).ravel()
        near, shape = form.near(times), (len(h), NODES, m)
        # The first guess holds still; the rates at the beginning are part of the first step.
        still = np.zeros(shape)
        at, block, owed = (still + z, still), _StepBlock.along(h, z, 0.0 * rates, still), rates
        sweep, last, tangents = None, np.inf, 0
        for _ in range(MOST_ROUNDS):
            try:
                now = form.at(times, at[0].reshape(-1, m), at[1].reshape(-1, m), near)
                if sweep is None:
                    tangents += 1
                    sweep = _Sweep.over(h, tangent(form, edges, block.z, block.rates))
            except CrankcheckError:
                return None  # thrown too far
            left = now.force.reshape(shape) - (now.mass @ block.seconds.reshape(-1, m, 1)).reshape(
                shape
            )
            step = sweep.step(left, owed)
            block, owed = _StepBlock.along(h, z, rates, block.seconds + step), 0.0 * rates
            at = block.nodes(h)
            size = float(np.abs(step).max()) / (float(np.abs(block.seconds).max()) or 1.0)
            moved = float(h.max()) ** 2 * float(np.abs(step).max())
            small = moved < max(CLOSE * form.assembly.scene.longest_m, NEARLY * block.reach(h))
            if size <= CLOSE or (small and size >= 0.5 * last):
                return block
            if not np.isfinite(size) or (tangents >= MOST_TANGENTS and size > last):
                return None
            if size > SLOW * last and not small:
                sweep = None
            last = size
        return None


@dataclass(frozen=True)
class _Sweep:
    """The linear equations of W windows: inverses (W, NODES m, NODES m) of M + h C A + h^2 K A^2,
    and C and K at the nodes."""

    h: Array
    damping: Array
    stiffness: Array
    inverse: Array

    @staticmethod
    def over(h: Array, own: SlopesOverWindows) -> _Sweep:
        mass, damping, stiffness = (
            own.at_shares(RULE.places, matrix) for matrix in (own.mass, own.damping, own.stiffness)
        )
        step = h[:, None, None, None, None]
        whole = step * np.einsum("ij,wiab->wiajb", RULE.once, damping)
        whole += step**2 * np.einsum("ij,wiab->wiajb", TWICE, stiffness)
        whole[:, range(NODES), :, range(NODES)] += np.swapaxes(mass, 0, 1)
        size = NODES * mass.shape[-1]
        return _Sweep(h, damping, stiffness, np.linalg.inv(whole.reshape(-1, size, size)))

    def step(self, left: Array, rates: Array) -> Array:
        """Return the change of second derivatives (W, NODES, m) for residuals ``left`` of the
        equations, from no change of the coefficients and a change of the rates (m,)."""
        shape, changed = left.shape[1:], np.empty_like(left)
        z = np.zeros_like(rates)
        for w, h in enumerate(self.h):
            moved = z + h * RULE.places[:, None] * rates
            right = left[w] - self.damping[w] @ rates
            right -= (self.stiffness[w] @ moved[:, :, None])[:, :, 0]
            own = changed[w] = (self.inverse[w] @ right.ravel()).reshape(shape)
            z = z + h * rates + h * h * END_TWICE @ own
            rates = rates + h * RULE.end_once @ own
        return changed


STEP = 1e-5
"""Step of the differences, over the longest link."""


@dataclass(frozen=True)
class SlopesOverWindows:
    """``mass``, ``damping`` and ``stiffness`` at the ends and in the middle of W windows, (2 W + 1,
    m, m)."""

    mass: Array
    damping: Array
    stiffness: Array

    def at_shares(self, shares: Array, matrix: Array) -> Array:
        """Return one of the matrices at shares (S,) of all windows, (W, S, m, m)."""
        x = 2.0 * shares - 1.0
        parabolas = np.stack([0.5 * x * (x - 1.0), 1.0 - x * x, 0.5 * x * (x + 1.0)], axis=1)
        three = np.stack([matrix[:-2:2], matrix[1:-1:2], matrix[2::2]], axis=1)
        return np.asarray(np.einsum("sk,wkab->wsab", parabolas, three))


def tangent(form: ReducedForm, edges_s: Array, z: Array, rates: Array) -> SlopesOverWindows:
    """Linearise over the windows between edges [s] (W + 1,), at coefficients and rates (W + 1, m).

    One-sided differences at the ends and in the middle of windows, interpolated between. For the
    derivatives themselves: `analytic.elastic.periodic`.
    """
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
    both = np.empty((2 * len(values) - 1, *values.shape[1:]))
    both[::2], both[1::2] = values, 0.5 * (values[1:] + values[:-1])
    return both
