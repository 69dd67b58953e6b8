"""Freudenstein's equation: all its solutions, against Burmester's points and a search."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest
from scipy.optimize import fsolve  # type: ignore[import-untyped]

from analytic.synthesis.burmester import five_positions
from analytic.synthesis.function.fourbar import FourBarGenerator, fourbars
from analytic.synthesis.function.generator import Generator
from analytic.synthesis.function.slider_crank import slider_cranks
from analytic.synthesis.function.task import FunctionTask, MechanismKind
from analytic.synthesis.pose import Pose
from models.array import Array
from models.errors import CrankcheckError
from tests.analytic.synthesis.function_cases import known
from tests.worlds.tiers import slowly

CASES = [
    (kind, count, given)
    for kind in ("fourbar", "slider-crank")
    for count, given in ((3, ("input", "output")), (4, ("input",)), (4, ("output",)), (5, ()))
]
MOST = {3: 1, 4: 2, 5: 3}


def solved(task: FunctionTask) -> list[Generator]:
    solve = fourbars if task.mechanism == "fourbar" else slider_cranks
    start = None if task.output_start is None else task.output_start / task.output_scale
    x = task.x_points
    return solve(task.input_turn(x), task.output_scales(x), task.input_start_rad, start)


def numbers(one: Generator) -> Array:
    """What tells mechanisms from each other, angles as directions."""
    output = one.output_start
    ends = (
        [output] if not isinstance(one, FourBarGenerator) else [math.cos(output), math.sin(output)]
    )
    return np.array([*one.lengths, math.cos(one.input_start), math.sin(one.input_start), *ends])


@pytest.mark.parametrize("tasks", [10, slowly(200, reason="random tasks, some near a limit")])
@pytest.mark.parametrize(("kind", "count", "given"), CASES)
def test_the_mechanism_that_made_the_points_is_found(
    kind: MechanismKind, count: int, given: tuple[str, ...], tasks: int
) -> None:
    rng = np.random.default_rng(11)
    for _ in range(tasks):
        case = known(rng, kind, count, given)
        task, own = case.task, case.generator
        found = solved(task)
        assert 1 <= len(found) <= MOST[count]
        scale = 1.0 if kind == "fourbar" else abs(task.output_range)
        # The known one starts where its output is at the start of the range.
        start = float(own.output(np.array([own.input_start]), case.sign)[0]) / scale
        lengths = np.array(own.lengths) / scale
        angles = [math.cos(own.input_start), math.sin(own.input_start)]
        ends = [math.cos(start), math.sin(start)] if kind == "fourbar" else [start]
        target = np.array([*lengths, *angles, *ends])
        off = min(float(np.max(np.abs(numbers(one) - target))) for one in found)
        assert off < 1e-5, (off, own)


@pytest.mark.parametrize("count", [4, 5])
def test_the_number_of_real_solutions_has_the_parity_of_the_form(count: int) -> None:
    rng, seen = np.random.default_rng(5), set()
    for _ in range(150):
        turns, ways = np.sort(rng.uniform(0.0, 1.5, count)), np.sort(rng.uniform(0.0, 1.5, count))
        found = fourbars(turns, ways, 0.4 if count == 4 else None)
        seen.add(len(found))
    assert seen == ({0, 2} if count == 4 else {1, 3})


def by_burmester(turns: Array, ways: Array) -> list[Array]:
    """The four-bars of five points, as cranks of the output seen from the input.

    Held by the input, the output's pivot is at exp(-i turn), the output turned by way - turn, and
    its pin B on a circle about A. That the pivots O4 and O2 are such a pair is the trivial one.
    """
    poses = [
        Pose(cmath.exp(-1j * turn), way - turn)
        for turn, way in zip(turns.tolist(), ways.tolist(), strict=True)
    ]
    return [
        np.array(
            [
                abs(dyad.fixed),
                dyad.radius(poses),
                abs(dyad.moving),
                *(dyad.fixed.real, dyad.fixed.imag) / np.abs(dyad.fixed),
                *(dyad.moving.real, dyad.moving.imag) / np.abs(dyad.moving),
            ]
        )
        for dyad in five_positions(poses)
        if abs(dyad.fixed) + abs(dyad.moving) > 1e-9
    ]


def test_five_points_have_the_solutions_that_burmester_has() -> None:
    rng, counted = np.random.default_rng(8), [0, 0, 0, 0]
    for number in range(80):
        turns, ways = np.sort(rng.uniform(0.0, 1.6, 5)), np.sort(rng.uniform(-1.6, 1.6, 5))
        if number % 2:
            task = known(rng, "fourbar", 5, ()).task
            turns, ways = task.input_turn(task.x_points), task.output_scales(task.x_points)
        found, others = [numbers(one) for one in fourbars(turns, ways)], by_burmester(turns, ways)
        assert len(found) == len(others)
        counted[len(found)] += 1
        for one in found:
            off = min(float(np.max(np.abs(one - o) / (1.0 + np.abs(o)))) for o in others)
            assert off < 1e-6, (one, others)
    assert counted[1] > 10
    assert counted[3] > 10


@pytest.mark.parametrize("tasks", [1, slowly(4, reason="more tasks, each from as many starts")])
@pytest.mark.parametrize("kind", ["fourbar", "slider-crank"])
def test_a_search_from_many_starts_finds_no_other_solution(kind: MechanismKind, tasks: int) -> None:
    rng, hits = np.random.default_rng(21), 0
    for _ in range(tasks):
        task = known(rng, kind, 5, ()).task
        turns, ways = task.input_turn(task.x_points), task.output_scales(task.x_points)
        found = [numbers(one) for one in solved(task)]
        for guess in rng.uniform(-1.5, 1.5, (150, 5)):
            pins = _searched(kind, turns, ways, guess)
            if pins is not None and max(abs(pins)) < 100.0 and np.hypot(*pins[:2]) > 1e-3:
                assert min(_pins_off(kind, pins, one) for one in found) < 1e-5, (pins, found)
                hits += 1
    assert hits > 10 * tasks


def _searched(kind: str, turns: Array, ways: Array, guess: Array) -> Array | None:
    """Pins A and B (of a slider s0 and e) and the coupler, by the closure of the loop alone."""

    def open_by(p: Array) -> Array:
        a = complex(p[0], p[1]) * np.exp(1j * turns)
        if kind == "fourbar":
            b = 1.0 + complex(p[2], p[3]) * np.exp(1j * ways)
        else:
            b = p[2] + ways + 1j * p[3]
        return np.asarray(np.abs(a - b) ** 2 - p[4])

    pins, _, reached, _ = fsolve(open_by, guess, full_output=True, xtol=1e-14)
    if reached != 1 or np.max(np.abs(open_by(pins))) > 1e-12:
        return None
    if kind == "fourbar" and np.hypot(pins[2], pins[3]) < 1e-3:
        return None  # the trivial one: both pins on their pivots
    return np.asarray(pins)


def _pins_off(kind: str, pins: Array, one: Array) -> float:
    if kind == "fourbar":
        a, b, c, *ends = one
        own = np.array([a * ends[0], a * ends[1], c * ends[2], c * ends[3], b * b])
        return float(np.max(np.abs(pins - own) / (1.0 + np.abs(own))))
    a, b, cosine, sine, s0 = one
    own = np.array([a * cosine, a * sine, s0, b * b])
    return float(np.max(np.abs(pins[[0, 1, 2, 4]] - own) / (1.0 + np.abs(own))))


def test_a_negative_length_is_told_and_turned() -> None:
    own = FourBarGenerator((1.0 / 0.4, 1.0 / 0.7, 0.9), 0.3, 1.1)
    turns = np.array([0.0, 0.4, 0.9])
    ways = own.output(0.3 + turns, 1.0) - 1.1
    (plain,) = fourbars(turns, ways, 0.3, 1.1)
    (turned,) = fourbars(turns, ways, 0.3 + math.pi, 1.1)
    assert plain.turned == ()
    assert turned.turned == ("input",)
    np.testing.assert_allclose(turned.lengths, plain.lengths, rtol=1e-12)
    assert math.remainder(turned.input_start - 0.3, math.tau) == pytest.approx(0.0, abs=1e-12)


def test_an_output_in_proportion_is_a_family_of_parallelograms() -> None:
    turns = np.linspace(0.0, 1.0, 5)
    with pytest.raises(CrankcheckError, match="a whole family"):
        fourbars(turns, turns)


def test_the_gradient_is_that_of_differences() -> None:
    rng = np.random.default_rng(2)
    for kind in ("fourbar", "slider-crank"):
        case = known(rng, kind, 5, ())
        own, free = case.generator, ("input", "output")
        turns = np.array([0.1, 0.3])
        exact = own.gradient(turns, case.sign, free)
        for k in range(5):
            step = np.zeros(5)
            step[k] = 1e-6
            ends = [own.moved(s * step, free).error(turns, turns, case.sign) for s in (1.0, -1.0)]
            np.testing.assert_allclose(
                (ends[0] - ends[1]) / 2e-6, exact[:, k], rtol=1e-6, atol=1e-8
            )


def test_polishing_takes_away_what_rounding_left() -> None:
    rng = np.random.default_rng(3)
    for kind in ("fourbar", "slider-crank"):
        case = known(rng, kind, 5, ())
        turns = case.task.input_turn(case.task.x_points)
        own = case.generator.output(case.generator.input_start + turns, case.sign)
        free, step = ("input", "output"), 1e-7 * np.array([1.0, -1.0, 1.0, 1.0, -1.0])
        rough = case.generator.moved(step, free)
        assert np.max(np.abs(rough.error(turns, own, case.sign))) > 1e-9
        fine = rough.polished(turns, own, free)
        assert np.max(np.abs(fine.error(turns, own, case.sign))) < 1e-14
