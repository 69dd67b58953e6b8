"""Function generators as proposals: met by the reference, with equal ripples, or refused."""

import functools
import math
import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from analytic.kinematics import solve_driven
from analytic.lectures.synthesis.design import Dot, Segment
from analytic.lectures.synthesis.examine import Examined, examine
from analytic.lectures.synthesis.function.designs import function_designs, starts_of
from analytic.lectures.synthesis.function.generator import FunctionProposal, structural_error
from analytic.lectures.synthesis.function.task import FunctionTask, GivenFunction, MechanismKind
from models.errors import CrankcheckError, ReachError
from tests.analytic.lectures.synthesis.test_function_solutions import known
from tests.worlds.tiers import slowly

POWER = GivenFunction.of_formula("x^1.6")
OUTPUTS = {"fourbar": math.radians(90.0), "slider-crank": 0.05}
MET = 1e-10
OPEN = (None, None)
KINDS: tuple[MechanismKind, ...] = ("fourbar", "slider-crank")


def power_task(
    kind: MechanismKind, count: int, *, equal_ripple: bool = False, start: float | None = None
) -> FunctionTask:
    """x^1.6 on 1 to 2.5 over 60 degrees of the input, 90 degrees of the output, or 50 mm."""
    output = {"fourbar": math.radians(60.0), "slider-crank": 0.025}[kind] if count == 3 else None
    start = math.radians(30.0) if count == 3 else start
    starts = {"input_start_rad": start, "output_start": output, "equal_ripple": equal_ripple}
    return FunctionTask(POWER, 1.0, 2.5, math.radians(60.0), OUTPUTS[kind], kind, count, **starts)


@functools.cache
def designs(task: FunctionTask) -> list[tuple[FunctionProposal, Examined]]:
    return [(proposal, examine(proposal)) for proposal in function_designs(task)]


def best(task: FunctionTask) -> tuple[FunctionProposal, Examined, Any]:
    """Of the mechanisms without defect that close over the range, that with the least error."""
    found = [one for one in designs(task) if is_whole(*one)]
    every = [(*one, structural_error(*one)) for one in found]
    return min(every, key=lambda one: one[2].largest)


def is_whole(proposal: FunctionProposal, examined: Examined) -> bool:
    return not examined.defects and "assembled over" not in proposal.doubt


@pytest.mark.parametrize(
    ("seed", "trials"), [(4, 6), slowly(5, 300, reason="random mechanisms, some near a limit")]
)
def test_designs_of_random_solvable_tasks_meet_their_points(seed: int, trials: int) -> None:
    """And one of them makes the function of the mechanism that was drawn."""
    rng = np.random.default_rng(seed)
    givens = {3: [("input", "output")], 4: [("input",), ("output",)], 5: [()]}
    for number in range(trials):
        kind, count = KINDS[number % 2], 3 + number // 2 % 3
        choices = givens[count]
        case = known(rng, kind, count, choices[number % len(choices)])
        found = [(one, examine(one)) for one in function_designs(case.task)]
        assert 1 <= len(found) <= count - 2
        for _, examined in found:
            if examined.least_sine > 1e-3:
                assert max(examined.off) < MET, (number, examined.off, case)
        errors = [structural_error(*one).largest for one in found if is_whole(*one)]
        assert min(errors) < 1e-6 * case.task.output_scale, (number, errors, case)


@pytest.mark.parametrize(
    ("kind", "count", "largest", "refined", "starts"),
    [
        ("fourbar", 3, 9.6868e-3, 5.5055e-3, OPEN),
        slowly(
            "fourbar",
            4,
            2.8329e-4,
            1.4714e-4,
            (math.radians(7.5),) * 2,
            reason="as of three points",
        ),
        ("slider-crank", 3, 1.66349e-4, 1.15942e-4, OPEN),
        ("slider-crank", 4, 2.6573e-6, 1.5018e-6, (math.radians(142.5), math.radians(135.0))),
        slowly("slider-crank", 5, 1.3073e-6, 1.1366e-6, OPEN, reason="as of four points"),
    ],
)
def test_a_power_has_these_structural_errors(
    kind: MechanismKind,
    count: int,
    largest: float,
    refined: float,
    starts: tuple[float | None, float | None],
) -> None:
    plain = best(power_task(kind, count, start=starts[0]))[2]
    even = best(power_task(kind, count, equal_ripple=True, start=starts[1]))[2]
    assert plain.largest == pytest.approx(largest, rel=1e-3)
    assert even.largest == pytest.approx(refined, rel=1e-3)
    assert plain.largest_y == pytest.approx(largest * (2.5**1.6 - 1.0) / OUTPUTS[kind], rel=1e-3)
    assert 0.0 < plain.rms < plain.largest


@pytest.mark.parametrize(
    ("kind", "count", "start"),
    [
        *((kind, count, None) for kind in KINDS for count in (3, 5)),
        ("fourbar", 4, math.radians(7.5)),
        ("slider-crank", 4, math.radians(135.0)),
    ],
)
def test_equal_ripples_are_equal_and_no_larger_than_before(
    kind: MechanismKind, count: int, start: float | None
) -> None:
    task = power_task(kind, count, start=start)
    plain, even = designs(task), designs(replace(task, equal_ripple=True))
    refined = 0
    for (before, first), (after, second) in zip(plain, even, strict=True):
        if after.chosen["spacing"] != "for equal ripples":
            assert "equal ripples" in after.doubt
            assert after.x_points == before.x_points
            continue
        refined += 1
        if first.defects or second.defects:
            continue
        error = structural_error(after, second, 4001)
        assert error.largest <= structural_error(before, first, 4001).largest * (1.0 + 1e-9)
        parts = np.split(error.error, np.flatnonzero(np.diff(np.sign(error.error))) + 1)
        tips = np.array([np.max(np.abs(part)) for part in parts])
        equal = tips > error.largest * (1.0 - 1e-3)
        assert equal.sum() >= count + 1, tips
        np.testing.assert_allclose(max(second.off), 0.0, atol=MET)
    assert refined > 0 or (kind, count) == ("fourbar", 5)


def test_a_function_that_a_mechanism_generates_exactly_has_no_ripples() -> None:
    rng = np.random.default_rng(6)
    for kind in KINDS:
        case = known(rng, kind, 3, ("input", "output"))
        (proposal,) = function_designs(replace(case.task, equal_ripple=True))
        assert proposal.doubt == ""
        assert proposal.x_points == tuple(case.task.x_points)
        assert structural_error(proposal, examine(proposal)).largest < 1e-12


def test_the_error_is_nothing_in_the_precision_points_and_has_the_sign_of_the_lecture() -> None:
    proposal, examined, error = best(power_task("fourbar", 3))
    at = np.interp(proposal.x_points, error.x, error.error)
    assert np.max(np.abs(at)) < 1e-5
    assert error.rms == pytest.approx(math.sqrt(float(np.mean(error.error**2))), rel=2e-3)
    assert error.largest >= np.max(np.abs(error.error))
    # E = f - F: of the same mechanism, a function that goes less far has a smaller E.
    task, way = proposal.task, proposal.task.output_way(error.x)
    shorter = replace(proposal, task=replace(task, output_range=0.995 * task.output_range))
    less = structural_error(shorter, examined).error - error.error
    np.testing.assert_allclose(less, -0.005 * way, atol=1e-12)


def test_open_starts_are_tried_on_the_grid_that_is_told() -> None:
    task = power_task("fourbar", 3)
    opened = replace(task, input_start_rad=None)
    assert len(list(starts_of(opened))) == 24
    assert len(list(starts_of(replace(opened, output_start=None)))) == 144
    assert len(list(starts_of(power_task("fourbar", 4)))) == 24
    slide = replace(power_task("slider-crank", 3), output_start=None)
    assert [s.output for s in starts_of(slide)] == [k / 2 - 3.5 for k in range(13)]
    found = function_designs(opened)
    assert len({proposal.chosen["input start"] for proposal in found}) == 24


def test_a_start_that_came_out_turned_is_told() -> None:
    (proposal,) = function_designs(power_task("fourbar", 3))
    assert "the input starts 180 degrees from the start that was given" in proposal.doubt
    assert "the output starts 180 degrees" in proposal.doubt
    first = proposal.positions[0].driver_rad
    turn = float(proposal.task.input_turn(np.array(proposal.x_points[:1]))[0])
    assert math.degrees(first - turn) == pytest.approx(210.0)


def test_explicit_points_a_falling_function_and_clockwise_ranges() -> None:
    starts = {"input_start_rad": math.radians(30.0), "output_start": math.radians(240.0)}
    ranges = (1.0, 2.0, math.radians(90.0), math.radians(-90.0))
    inverse = GivenFunction.of_formula("1/x")
    task = FunctionTask(inverse, *ranges, points=(1.9, 1.05, 1.5), **starts)
    assert task.y_ends == pytest.approx((1.0, 0.5))
    np.testing.assert_allclose(task.output_way(np.array([1.0, 2.0])), [0.0, -math.pi / 2])
    (proposal,) = function_designs(task)
    assert proposal.x_points == (1.05, 1.5, 1.9)
    examined = examine(proposal)
    assert max(examined.off) < MET
    assert not examined.defects


def test_a_hump_and_a_table_are_generated() -> None:
    x = np.linspace(0.0, math.pi, 60)
    table, start = GivenFunction.of_table(x.tolist(), np.sin(x).tolist(), "a hump"), math.pi / 6
    task = FunctionTask(table, 0.0, math.pi, 2.0, 0.6, "slider-crank", 3, input_start_rad=start)
    assert task.y_ends == pytest.approx((0.0, 1.0), abs=1e-3)
    _, examined, error = best(task)
    assert max(examined.off) < MET
    assert error.largest < 0.05


@pytest.mark.parametrize("kind", ["fourbar", "slider-crank"])
def test_the_steps_draw_the_links_where_the_reference_has_them(kind: MechanismKind) -> None:
    (proposal,) = function_designs(power_task(kind, 3))
    examined = examine(proposal)
    points, result = proposal.steps
    drawn = [abs(e.end - e.start) for e in result.elements if isinstance(e, Segment)]
    lengths = [float(str(link["length_m"])) for link in proposal.draft.links.values()]
    assert drawn == pytest.approx(lengths)
    angles = np.array([position.driver_rad for position in proposal.positions])
    motion = solve_driven(examined.scene, angles, np.ones(1), np.zeros(1), bound=False)
    dots = {e.letter: e.place for e in points.elements if isinstance(e, Dot)}
    for pin in "AB":
        places = [dots[f"{pin}{number}"] for number in (1, 2, 3)]
        position = motion.points[pin].position @ (1.0, 1j)
        np.testing.assert_allclose(position, places, atol=1e-12)


def test_a_mechanism_that_opens_within_the_range_is_told() -> None:
    found = [p for p in function_designs(power_task("slider-crank", 4)) if "assembled" in p.doubt]
    assert found
    for proposal in found:
        with pytest.raises(ReachError, match="does not close over the whole range"):
            structural_error(proposal, examine(proposal))


WHOLE = {"function": POWER, "x_low": 1.0, "x_high": 2.5, "input_range_rad": 1.0}


def refused(says: str, **changes: object) -> None:
    with pytest.raises(CrankcheckError, match=re.escape(says)):
        function_designs(FunctionTask(**{**WHOLE, "output_range": 1.0, **changes}))


def test_what_is_no_task_is_refused() -> None:
    refused("a precision point at x = 2.6 was requested, outside", points=(1.1, 1.5, 2.6))
    refused("precision points 2 and 3 coincide", points=(1.1, 1.5, 1.5 + 1e-9))
    refused("2 precision points were requested", points=2)
    refused("is constant from", function=GivenFunction.of_formula("2 + 0*x"))
    refused("not defined at x = -1", function=GivenFunction.of_formula("log(x)"), x_low=-1.0)
    refused("jumps at x = 1.5708", function=GivenFunction.of_formula("tan(x)"))
    refused("give two numbers, the smaller one first", x_low=2.5)
    refused("an input range of 0 deg", input_range_rad=0.0)
    refused("an output range of -400 deg", output_range=math.radians(-400.0))
    refused("a slider's range of 0 m", mechanism="slider-crank", output_range=0.0)
    refused("a ground length of -1 m", ground_m=-1.0)
    refused("functions are generated by fourbar or slider-crank", mechanism="cam")
    refused("leave one of them open", points=4, input_start_rad=0.0, output_start=0.0)
    refused("leave both open, or use 4 points", points=5, input_start_rad=0.0)
    refused("an input start of nan", input_start_rad=math.nan)
    refused("they find their own", points=(1.1, 1.5, 2.0), equal_ripple=True)
    refused("a whole turn of the input apart", points=(1.0, 1.5, 2.5), input_range_rad=math.tau)
    line = GivenFunction.of_formula("3*x - 1")
    refused("a whole family of mechanisms meets them", function=line, points=5)
    ranges = {"output_range": math.pi / 2, "input_range_rad": math.pi / 3}
    start = math.radians(30)
    refused("no fourbar meets the 4 precision points", points=4, input_start_rad=start, **ranges)


def test_a_table_is_refused_where_it_is_none_or_too_short() -> None:
    with pytest.raises(CrankcheckError, match="have to increase"):
        GivenFunction.of_table([0.0, 0.0], [1.0, 2.0])
    with pytest.raises(CrankcheckError, match="finite numbers"):
        GivenFunction.of_table([0.0, 1.0], [1.0, math.nan])
    refused("its rows go from 1 to 2;", function=GivenFunction.of_table([1.0, 2.0], [0.0, 1.0]))
