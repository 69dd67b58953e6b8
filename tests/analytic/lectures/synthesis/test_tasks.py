"""Random tasks are met at every position; tolerances by closed forms and a Monte Carlo."""

import functools
import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.kinematics import solve
from analytic.lectures.synthesis.design import AskedSlide
from analytic.lectures.synthesis.examine import Examined, examine, passing_times
from analytic.lectures.synthesis.sensitivity import is_measured, monte_carlo, sensitivity
from analytic.lectures.synthesis.slider_crank_strokes import stroke_proposals
from analytic.lectures.synthesis.solutions import Solutions, followed, solutions_of
from analytic.mechanism.cycle import travel
from models.errors import CrankcheckError, ReachError
from models.lectures.tasks import load_task
from models.lectures.tasks.positions import StrokeTask
from models.scene.laws import Oscillating
from tests.analytic.lectures.synthesis.random_tasks import HEAD, TASKS, random_solutions
from tests.worlds.tiers import at_length, few, slowly

MET = 1e-10
"""Of the size, over the square of the sine of the worst transmission in a position: near a limit
places are worse conditioned than anywhere else."""


def passed(one: Examined) -> tuple[float, float]:
    """How far the scene is from the positions when its driver goes through them [of the size], and
    the least sine there; inf where it can not, or meets them in another order."""
    law = one.scene.driver.law
    angles = np.array([position.driver_rad for position in one.positions])
    at_s = passing_times(law, angles.tolist())
    if np.any(np.diff(at_s) <= 0.0) or np.ptp(at_s) > law.period_s * (1.0 + 1e-9):
        return math.inf, 1.0
    aside = np.max(np.abs(angles - law.centre_rad)) if isinstance(law, Oscillating) else 0.0
    if aside and aside > abs(law.amplitude_rad) * (1.0 + 1e-9):
        return math.inf, 1.0
    try:
        on_the_way = np.linspace(0.0, at_s.max(), 200)
        motion = solve(one.scene, np.concatenate([at_s, on_the_way]), bound=False)
    except ReachError:
        return math.inf, 1.0
    size = one.scene.longest_m
    off = (each.off(motion, size)[k] for k, each in enumerate(one.positions))
    sine = min(float(np.min(s[: len(at_s)])) for s in motion.conditioning.values())
    return float(max(off)), min(1.0, sine)


def hold(kind: str, number: int) -> tuple[int, int]:
    """The solutions of a task: how many have no defect, of how many."""
    try:
        found = random_solutions(kind, number).examined
    except CrankcheckError:
        if kind != "four_positions":  # of others a mechanism is known
            raise
        return 0, 0
    for one in found:
        off, sine = passed(one)
        if one.defects:
            assert off > 1e-6, (kind, number, one.defects, one.text)
        else:
            assert off < MET / sine**2, (kind, number, off, one.off, one.text)
    return sum(not one.defects for one in found), len(found)


RARE = {"three_positions", "given_pivots", "four_positions"}
"""Of whose tasks few have a solution without a defect."""


@pytest.mark.parametrize(
    ("kind", "numbers"),
    [
        *((kind, range(4 if kind in RARE else 1)) for kind in TASKS),
        *(slowly(kind, range(44), reason="of forty, some are near a limit") for kind in TASKS),
        *(at_length(kind, range(4, 1004), reason="one circuit in a hundred") for kind in TASKS),
    ],
    ids=lambda one: one if isinstance(one, str) else str(len(one)),
)
def test_solutions_do_what_is_said_of_them(kind: str, numbers: range) -> None:
    sound = [hold(kind, number) for number in numbers]
    assert sum(some for some, _ in sound) > 0.05 * sum(every for _, every in sound)


RATIOS = ("stroke_and_ratio", "slotted_lever", "whitworth", "crank_rocker")


@pytest.mark.parametrize("number", few(range(2), [0], "another random task"))
@pytest.mark.parametrize("kind", RATIOS)
def test_the_reference_measures_the_time_ratio_that_was_asked_for(kind: str, number: int) -> None:
    found = random_solutions(kind, number)
    assert found.sound
    for one in found.sound[:3]:
        measured = travel(one.scene, one.proposal.turns_back).time_ratio
        assert measured == pytest.approx(found.task.time_ratio, rel=1e-8)
        assert f"time ratio {measured:.6g}" in one.notes[-1]


def test_a_turn_that_is_claimed_wrongly_is_a_fault() -> None:
    """Two places of a slider that it passes, and does not turn back in."""
    (proposal,) = stroke_proposals(StrokeTask(**HEAD, stroke_m=0.2, rod_m=0.5))
    first, last = proposal.positions
    passed = 0.1 * math.cos(0.3) + math.sqrt(0.25 - (0.1 * math.sin(0.3)) ** 2) - 0.4
    short = replace(last, driver_rad=0.3, asked=(AskedSlide("B", passed),))
    one = followed(examine(replace(proposal, positions=(first, short))))
    assert max(one.off) < 1e-14
    assert one.defects == ["goes 0.2 m, time ratio 1: take a longer rod"]


def offset(**given: float) -> Solutions:
    return solutions_of(StrokeTask(**HEAD, stroke_m=0.1, form="offset", **given))


LIMITS = [1.000001, 2.9, 2.99, 2.995]


@pytest.mark.parametrize("ratio", few(LIMITS, [2.995], "the other limit is no harder"))
def test_ratios_near_their_limits_keep_their_digits(ratio: float) -> None:
    found = offset(time_ratio=ratio)
    assert len(found.sound) == 12
    for one in found.sound:
        assert max(one.off) < 1e-15 / one.least_sine**2
        folded, stretched = (position.driver_rad for position in one.positions)
        low, high = sorted(((stretched - folded) % math.tau, (folded - stretched) % math.tau))
        assert high / low == pytest.approx(ratio, rel=1e-13)


def test_a_ratio_that_hardly_transmits_is_refused_and_offsets_of_a_nanometre_keep_digits() -> None:
    with pytest.raises(CrankcheckError, match="has one below 3, and transmits"):
        offset(time_ratio=2.9999)
    (one,) = offset(time_ratio=1.0001, offset_m=1e-9).sound
    assert -one.scene.sliders["B"].through_m[1] == pytest.approx(1e-9, rel=1e-12)
    assert max(one.off) < 1e-14


@functools.cache
def best(kind: str, name: str) -> Examined:
    return solutions_of(load_task(kind, name)).examined[0]


@functools.cache
def central() -> Examined:
    task = StrokeTask(name="x", source="a test", stroke_m=0.1, rod_m=0.3)
    return solutions_of(task).examined[0]


def test_slopes_and_the_largest_clearance_of_a_central_slider_crank_are_known() -> None:
    """At the ends of its stroke s = l +- r: a length goes in whole, the pivot's height not at
    all."""
    found = sensitivity(central())
    slope = {one.words: abs(found.slopes[:, k]) for k, one in enumerate(found.dimensions)}
    for words in ("crank A x", "rod B x", "ground O2 x"):
        assert slope[words] == pytest.approx([1.0, 1.0], abs=1e-8)
    assert slope["ground O2 y"] == pytest.approx([0.0, 0.0], abs=1e-6)
    # The crank's pin moved across it: the rod is in line with the crank, the slider stays.
    assert slope["crank A y"] == pytest.approx([0.0, 0.0], abs=1e-6)
    assert found.worst(1e-4) == pytest.approx([3e-4, 3e-4], rel=1e-6)
    assert found.usual(1e-4) == pytest.approx([math.sqrt(3.0) * 1e-4] * 2, rel=1e-6)
    clearance, row = found.largest_clearance([3e-4, 6e-4])
    assert clearance == pytest.approx(1e-4, rel=1e-6)  # three pins in line
    assert row == 0
    measured = [one.words for one in found.dimensions if is_measured(central(), one)]
    assert measured == ["ground O2 x", "ground O2 y", "crank A x", "rod B x"]  # one of each bar


TOLD = [("coupler", "three-positions"), ("quick-return", "whitworth"), ("coupler", "driving-dyad")]
MORE = "of more dimensions and mechanisms"


@pytest.mark.parametrize(
    ("kind", "name", "count"),
    [*((*task, 40) for task in TOLD[:2]), *(slowly(*task, 200, reason=MORE) for task in TOLD)],
)
def test_a_monte_carlo_stays_within_the_worst_case_and_comes_near(
    kind: str, name: str, count: int
) -> None:
    one = best(kind, name)
    found, small = sensitivity(one), 1e-6
    worst = found.worst(small)
    spread = monte_carlo(one, small, (0.3 * worst).tolist(), count)
    moves = worst > 1e-9
    assert np.all(spread.largest <= worst * 1.001 + 1e-12)
    assert np.all(spread.largest[moves] > 0.25 * worst[moves])
    assert 0.0 < spread.share_within < 1.0
    assert spread.lost == 0


@pytest.mark.parametrize("count", [10, slowly(50, reason="more of them, drawn at random")])
def test_the_same_seed_gives_the_same(count: int) -> None:
    one = central()
    first, second = (monte_carlo(one, 1e-4, [1e-4, 1e-4], count) for _ in range(2))
    assert first.largest.tolist() == second.largest.tolist()
    other = monte_carlo(one, 1e-4, [1e-4, 1e-4], count, seed=1)
    assert other.largest.tolist() != first.largest.tolist()


@pytest.mark.parametrize("count", [40, slowly(100, reason="more of them, drawn at random")])
def test_mechanisms_that_can_not_be_assembled_are_counted(count: int) -> None:
    one = best("coupler", "three-positions")
    assert monte_carlo(one, 0.1, [1.0] * 9, count).lost > 5
