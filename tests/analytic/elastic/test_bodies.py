"""Beams and chains as bodies: markers against differences, a free one's momentum and energy."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import solve_ivp  # type: ignore[import-untyped]

from analytic.elastic.beam import Beam
from analytic.elastic.segments import SegmentChain
from tests.analytic.elastic.beams import ASKEW, LENGTH_M, SHAPES, beam, chain

ON, OFF = ASKEW.at(0.3), (0.4, 0.25)
MARKERS = [(None, 0.0), (ON, 0.2), (OFF, 0.0), (ASKEW.at(LENGTH_M), 0.0)]
GRAVITY = (1.3, -9.81)
Body = Beam | SegmentChain
BODIES: dict[str, Callable[[], Body]] = {
    **{
        f"{kind} {'stiffened' if stiffened else 'linear'}": (
            lambda shapes=shapes, stiffened=stiffened: beam(
                shapes, ASKEW, MARKERS, GRAVITY, stiffened=stiffened
            )
        )
        for kind, shapes in SHAPES.items()
        for stiffened in (True, False)
    },
    "chain": lambda: chain(5, ASKEW, MARKERS, GRAVITY),
}


@pytest.mark.parametrize("name", BODIES)
def test_markers_move_by_their_derivatives(name: str) -> None:
    own, rng = BODIES[name](), np.random.default_rng(1)
    q, rates = 0.1 * rng.standard_normal((1, own.size)), rng.standard_normal((1, own.size))
    q[0, 2] = 0.8
    by, now = 1e-5, own.mark(q, rates)
    for k, one in enumerate(np.eye(own.size)):
        ahead, behind = (own.mark(q + sign * by * one, rates).place for sign in (1.0, -1.0))
        assert now.gradient[..., k] == pytest.approx((ahead - behind) / (2.0 * by), abs=1e-7)
    # Along a straight way through the coordinates the q'' are 0.
    ahead, behind = (own.mark(q + sign * 1e-4 * rates, rates).place for sign in (1.0, -1.0))
    drift = (ahead - 2.0 * now.place + behind) / 1e-8
    assert now.drift == pytest.approx(drift, abs=2e-5 * np.abs(drift).max())


@pytest.mark.parametrize("name", BODIES)
def test_a_body_that_flies_keeps_its_energy_and_gains_momentum_by_its_weight(name: str) -> None:
    own, rng = BODIES[name](), np.random.default_rng(2)
    n = own.size
    rates, q = rng.standard_normal(n), np.zeros(n)
    q[3:] = 1e-3 * rng.standard_normal(n - 3)
    q[2], rates[3:] = 0.4, 1e-2 * rates[3:]

    def slope(_: float, state: np.ndarray) -> np.ndarray:
        matrix, right = own.weigh(state[None, :n], state[None, n:])
        return np.concatenate([state[n:], np.linalg.solve(matrix[0], right[0])])

    until = 2e-4
    run = solve_ivp(
        slope, (0.0, until), np.concatenate([q, rates]), method="DOP853", rtol=1e-11, atol=1e-13
    )
    q, rates = run.y[:n].T, run.y[n:].T
    matrix, _ = own.weigh(q, rates)
    kinetic = 0.5 * np.einsum("ti,tij,tj->t", rates, matrix, rates)
    energy = kinetic + own.height_energy(q)
    assert np.ptp(energy) < 1e-10 * kinetic.max()
    momentum = np.einsum("tij,tj->ti", matrix, rates)[:, :2]
    gained = np.array(GRAVITY) * ASKEW.density_kg_m * LENGTH_M * until
    assert momentum[-1] - momentum[0] == pytest.approx(gained, rel=1e-9)
