"""One assembly followed along the driver: it is one of all, and does not jump."""

from __future__ import annotations

import math

import numpy as np
import pytest

from analytic.assur.platform import solve_platform
from analytic.assur.step import AssurStep
from analytic.dyads.plane import BodyKinematics
from models.array import Array
from tests.analytic.assur.test_triad_bounds import few_kinds, start_of, step_of
from tests.analytic.assur.triad_scenes import on_branch, triad
from tests.worlds.tiers import few, slowly


def followed(step: AssurStep, theta: Array) -> BodyKinematics:
    """The central link at driver angles within the track."""
    track = step.track({})
    chunk = step.before.chunk(theta, 0.0, {})
    rows = step.mounting.rows(chunk)
    place, turn = track.guess(track.home(theta))
    solved = solve_platform(rows, place, turn, step.mounting.size_m, certified=True)
    assert solved.closed.all()
    return solved.body


def inside(step: AssurStep, count: int) -> Array:
    """Driver angles over the way of an assembly, not quite to its ends."""
    low, high = step.track({}).range
    margin = 1e-3 * (high - low)
    return np.linspace(low + margin, high - margin, count)


@pytest.mark.parametrize(
    "seeds",
    [range(1), slowly(range(1, 60), reason="random triads, some with a narrow way")],
    ids=len,
)
@few_kinds
def test_what_is_followed_is_an_assembly_all_along_and_moves_at_its_rate(
    kinds: tuple[str, str, str], seeds: range
) -> None:
    for seed in seeds:
        step = step_of(triad(kinds, 3 + seed)[0])
        theta = inside(step, 9)
        body = followed(step, theta)
        for k, at in enumerate(theta):
            apart = [
                abs(
                    math.remainder(
                        one.angle_rad - math.atan2(body.turn.y[k], body.turn.x[k]), math.tau
                    )
                )
                + math.hypot(one.place[0] - body.anchor.p.x[k], one.place[1] - body.anchor.p.y[k])
                for one in step.assemblies(float(at), {})
            ]
            assert min(apart) < 1e-7
        fine = inside(step, 4001)
        body = followed(step, fine)
        angle = np.unwrap(np.arctan2(body.turn.y, body.turn.x))
        rates = np.broadcast_to(body.omega, fine.shape)
        led = 0.5 * (rates[1:] + rates[:-1]) * np.diff(fine)
        gain = np.abs(np.diff(angle) - led)
        assert (gain <= 0.05 * np.abs(led) + 0.02).all()


def test_every_assembly_has_a_track_of_its_own() -> None:
    """At any angle no two of the six pins' tracks are at the same place."""
    scene = triad(("RR", "RR", "RR"), 12)[0]
    count = len(step_of(scene).assemblies(start_of(scene), {}))
    assert count >= 2
    steps = [step_of(on_branch(scene, k + 1)) for k in range(count)]
    ranges = [step.track({}).range for step in steps]
    low, high = max(r[0] for r in ranges), min(r[1] for r in ranges)
    theta = np.linspace(low + 1e-3, high - 1e-3, 50)
    angles = [np.arctan2(b.turn.y, b.turn.x) for b in (followed(s, theta) for s in steps)]
    for i in range(count):
        for j in range(i):
            apart = angles[i] - angles[j]
            assert (np.abs(apart - math.tau * np.round(apart / math.tau)) > 1e-6).all()


@pytest.mark.parametrize("seed", few(range(2), [0], "another random triad"))
def test_two_assemblies_are_gone_beyond_a_limit_position(seed: int) -> None:
    step = step_of(triad(("RR", "RR", "RR"), seed, crank_m=0.6)[0])
    ends = [(step.track({}).low, -1.0), (step.track({}).high, 1.0)]
    assert all(end is not None and end.kind == "limit position" for end, _ in ends)
    for end, way in ends:
        counts = [len(step.assemblies(end.theta - way * off, {})) for off in (1e-9, -1e-9)]
        assert counts[0] == counts[1] + 2
