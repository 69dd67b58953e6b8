"""Path generation: four-bars are found again from points that they go through."""

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.kinematics import solve_driven
from analytic.lectures.synthesis.examine import examine
from analytic.lectures.synthesis.path.search import PathFit, generate
from analytic.lectures.synthesis.path.task import PathTask
from models.array import Array
from models.errors import CrankcheckError
from tests.analytic.lectures.synthesis.test_path_shapes import random_path
from tests.worlds.tiers import at_length, slow, slowly

KINDS = list(itertools.product((True, False), (True, False)))
NAMES = [f"{'timed' if t else 'free'}-{'closed' if c else 'open'}" for t, c in KINDS]
FEW = 3


def off_by_reference(fit: PathFit, task: PathTask) -> Array:
    """How far the reference is from the points, at the angles of the precision positions [m]."""
    angles = np.array([position.driver_rad for position in fit.examined.positions])
    motion = solve_driven(fit.examined.scene, angles, np.ones(1), np.zeros(1), bound=False)
    return np.abs(motion.points["P"].position @ (1.0, 1j) - task.array)


@pytest.mark.parametrize(
    ("timed", "closed"),
    [KINDS[0], slowly(*KINDS[1], reason="as timed"), KINDS[2], slowly(*KINDS[3], reason="as both")],
    ids=NAMES,
)
def test_a_four_bar_is_found_again_from_its_path(timed: bool, closed: bool) -> None:
    task = random_path(1, 15, timed=timed, closed=closed)
    found = generate(task, starts=FEW)
    assert found.fits[0].rms_m < 1e-4 * task.radius_m
    assert found.complete
    for fit in found.fits:
        off, near = off_by_reference(fit, task), {"rel": 1e-6, "abs": 1e-9 * task.radius_m}
        assert not fit.examined.defects
        assert fit.examined.turns_fully or not closed
        assert np.max(off) == pytest.approx(fit.largest_m, **near)
        assert fit.rms_m == pytest.approx(np.sqrt(np.mean(off**2)), **near)


SHARE = slowly(10, reason="a share that is found takes many of them")
FINE = at_length(40, reason="the share to a few hundredths: two seconds for each of 160")


@pytest.mark.parametrize("count", [SHARE, FINE])
@pytest.mark.parametrize(
    ("timed", "closed", "least"),
    [(True, True, 0.95), (True, False, 0.8), (False, True, 0.9), (False, False, 0.8)],
    ids=NAMES,
)
def test_most_are_found_again(timed: bool, closed: bool, least: float, count: int) -> None:
    tasks = [random_path(seed, 20, timed=timed, closed=closed) for seed in range(count)]
    near = sum(generate(task).fits[0].rms_m < 1e-4 * task.radius_m for task in tasks)
    assert near >= least * count


@slow("half a second; a timed path is found again above")
def test_timing_is_kept() -> None:
    task = random_path(4, 12, timed=True, closed=True)
    for fit in generate(task, starts=FEW).fits:
        assert np.diff(fit.crank_rad) == pytest.approx(np.diff(task.crank_rad), abs=1e-5)
    # Other angles for the same points are another task, that the same four-bar does not do.
    warped = task.turned_rad + 0.15 * np.sin(task.turned_rad)
    other = replace(task, crank_rad=tuple(warped.tolist()))
    assert generate(other, starts=FEW).fits[0].rms_m > 1e-3 * task.radius_m


@slow("a search of forty points")
@pytest.mark.parametrize("timed", [slowly(True, reason="as without timing"), False])
def test_noise_is_not_fitted_and_not_made_worse(timed: bool) -> None:
    noise = 0.01
    task = random_path(1, 40, timed=timed, closed=True, noise=noise)
    best = generate(task, starts=FEW).fits[0]
    # Of both directions of the noise with timing, and of the one across the curve without.
    expected = noise * math.sqrt(2.0 if timed else 1.0) * task.radius_m
    assert 0.6 * expected < best.rms_m < 1.15 * expected
    assert best.rms_m < best.largest_m < 5.0 * expected


@slow("a second: a search of twelve starts")
def test_the_mechanisms_are_distinct_and_the_nearest_is_the_first() -> None:
    task = random_path(0, 12, timed=False, closed=True, noise=0.02)
    fits = generate(task, count=4, starts=12).fits
    assert len(fits) > 2
    errors = [round(fit.rms_m / task.radius_m, 6) for fit in fits]
    assert errors == sorted(errors)
    for one, other in itertools.combinations(fits, 2):
        places = [(f.four_bar.o2, f.four_bar.o4, f.four_bar.arm) for f in (one, other)]
        off = max(abs(p - q) for p, q in zip(*places, strict=True))
        assert off > 1e-3 * task.radius_m or one.four_bar.sign != other.four_bar.sign


@slow("a search: of a path that was found, its cognates as well")
def test_cognates_are_among_them() -> None:
    task = random_path(0, 20, timed=False, closed=True)
    fits = generate(task, count=4, starts=FEW).fits
    assert sum(fit.rms_m < 1e-9 * task.radius_m for fit in fits) >= 2


@slow("three searches; numbers are drawn from the seed alone")
def test_the_same_seed_gives_the_same_answer() -> None:
    task = random_path(3, 10, timed=True, closed=True, noise=0.02)
    one, same, other = (generate(task, starts=1, seed=seed).fits for seed in (1, 1, 2))
    assert [fit.four_bar for fit in one] == [fit.four_bar for fit in same]
    assert one[0].rms_m != other[0].rms_m


def test_a_search_ends_with_its_time_and_tells_how_far_it_is() -> None:
    task = random_path(0, 12, timed=False, closed=True)
    told: list[tuple[float, float]] = []
    found = generate(task, time_s=0.0, progress=lambda *each: told.append(each))
    assert not found.complete
    assert found.fits
    assert len(told) <= 3
    told.clear()
    assert generate(task, starts=FEW, progress=lambda *each: told.append(each)).complete
    shares, best = map(list, zip(*told, strict=True))
    assert (shares, shares[-1]) == (sorted(shares), 1.0)
    assert best == sorted(best, reverse=True)
    assert best[-1] < 1e-2 * task.radius_m


@slow("a search; in the others each position is met in its order")
@pytest.mark.parametrize("closed", [True, slowly(False, reason="as of a closed path")])
def test_points_in_a_wrong_order_are_never_met_as_if_in_order(closed: bool) -> None:
    task = random_path(5, 14, timed=False, closed=closed)
    points = list(task.points)
    points[4], points[8] = points[8], points[4]
    try:
        fits = generate(PathTask(tuple(points), closed=closed), starts=FEW).fits
    except CrankcheckError as error:
        assert "in their order" in str(error)  # noqa: PT017  # either answer is a true one
        return
    for fit in fits:
        assert fit.examined.defect == "none"
        assert fit.rms_m > 0.03 * task.radius_m
        steps = np.diff([position.driver_rad for position in fit.examined.positions])
        assert np.all(steps > 0.0) or np.all(steps < 0.0)


def test_a_distance_that_is_not_allowed_is_told_as_a_defect_and_the_steps_draw_all() -> None:
    task = random_path(1, 12, timed=True, closed=True, noise=0.02)
    proposal = generate(task, starts=8).fits[0].proposal
    assert not examine(proposal).defects
    (told,) = examine(replace(proposal, allowed=0.0)).defects
    assert told.startswith("misses a position by")
    assert examine(replace(proposal, allowed=0.5 * proposal.allowed)).defects
    assert [len(step.elements) for step in proposal.steps] == [12, 1, 7]  # points, curve and links


def test_few_points_leave_freedom_and_are_met_exactly() -> None:
    points = (0j, 0.1 + 0.05j, 0.22 + 0.06j, 0.3 + 0.02j, 0.34 - 0.06j)
    best = generate(PathTask(points), starts=2).fits[0]
    assert best.rms_m < 1e-8
    assert best.proposal.chosen["freedom"].startswith("4 numbers")
    timed = random_path(1, 5, timed=True, closed=False)
    determined = generate(timed, starts=FEW).fits[0]
    assert "freedom" not in determined.proposal.chosen
    assert determined.rms_m < 1e-6 * timed.radius_m


SQUARE = (0j, 1 + 0j, 1 + 1j, 1j)


@pytest.mark.parametrize(
    ("ask", "told"),
    [
        (lambda: PathTask(SQUARE[:3]), "path of 3 points was requested; give 4 to 50"),
        (lambda: PathTask(tuple(complex(k, k**2) for k in range(51))), "path of 51 points"),
        (lambda: PathTask((*SQUARE, 1j)), "points 4 and 5 of the path coincide"),
        (lambda: PathTask((*SQUARE, 0j), closed=True), "lists its first point once"),
        (lambda: PathTask((*SQUARE, complex(math.nan, 0.0))), "finite"),
        (lambda: PathTask(SQUARE, (0.0, 1.0, 2.0)), "3 angles of the crank were given for 4"),
        (lambda: PathTask(SQUARE, (0.0, 1.0, 0.5, 2.0)), "turn back, or stay"),
        (lambda: PathTask(SQUARE, (0.0, 1.0, 1.0, 2.0)), "turn back, or stay"),
        (lambda: PathTask(SQUARE, (0.0, 2.0, 4.0, 7.0)), "span 401.07 deg"),
        (lambda: generate(PathTask(SQUARE), starts=0), "5 mechanisms from 0 starts"),
        (lambda: generate(PathTask(SQUARE), least_transmission_rad=1.5), "angle of 85.94"),
    ],
)
def test_what_is_no_path_is_refused(ask, told: str) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(CrankcheckError, match=told):
        ask()
    assert len(PathTask((*SQUARE, 0j)).points) == 5  # but an open one may come back to its start


@pytest.mark.parametrize("timed", [True, slowly(False, reason="its search takes longer")])
def test_a_transmission_angle_is_kept_at_the_cost_of_the_distance(timed: bool) -> None:
    turn = math.tau * (np.arange(14) + 0.1) / 14
    heart = 16 * np.sin(turn) ** 3 + 1j * (13 * np.cos(turn) - 5 * np.cos(2 * turn))
    crank = tuple(turn.tolist()) if timed else None
    task = PathTask(tuple(heart.tolist()), crank, closed=True)
    least = math.radians(30.0)
    loose = generate(task, starts=FEW).fits
    strict = generate(task, starts=FEW, least_transmission_rad=least).fits
    assert min(fit.examined.least_transmission_rad for fit in strict) >= least
    assert min(fit.examined.least_transmission_rad for fit in loose) < least
    assert strict[0].rms_m < 0.5 * task.radius_m


@slow("0.4 s: rare, a circle")
def test_what_a_crank_does_alone_is_refused_with_the_reason() -> None:
    angles = math.tau * np.arange(12) / 12
    points = tuple(np.exp(1j * angles).tolist())
    with pytest.raises(CrankcheckError, match=r"of the nearest one: .*length AP is"):
        generate(PathTask(points, tuple(angles.tolist()), closed=True), starts=4)
    assert generate(PathTask(points, closed=True), starts=4).fits[0].rms_m < 1e-2
