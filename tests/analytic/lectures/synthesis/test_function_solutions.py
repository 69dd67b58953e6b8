"""Freudenstein's equation: all solutions of tasks that have one, against Burmester and a search."""

import cmath
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest
from scipy.optimize import fsolve  # type: ignore[import-untyped]

from analytic.lectures.synthesis.burmester import five_positions
from analytic.lectures.synthesis.function.generator import Generator
from analytic.lectures.synthesis.function.linkages import (
    FourBarGenerator,
    SliderCrankGenerator,
    fourbars,
    slider_cranks,
)
from analytic.lectures.synthesis.function.task import FunctionTask, GivenFunction, MechanismKind
from analytic.lectures.synthesis.pose import PlanePose
from models.array import Array
from tests.worlds.tiers import slowly

CLEAR = 0.15
"""Of the discriminant: how far a made mechanism keeps from its limit positions."""


@dataclass(frozen=True)
class Known:
    """A mechanism, its assembly, and a task that it solves exactly."""

    generator: Generator
    sign: float
    task: FunctionTask


def random_generator(rng: np.random.Generator, kind: MechanismKind) -> Generator:
    """Lengths of one order, starts anywhere."""
    start = float(rng.uniform(-math.pi, math.pi))
    if kind == "fourbar":
        a, b, c = rng.uniform(0.3, 2.0, 3).tolist()
        k = (1.0 / a, 1.0 / c, (a * a - b * b + c * c + 1.0) / (2.0 * a * c))
        return FourBarGenerator(k, start, 0.0)
    a, b = rng.uniform(0.3, 2.0, 2).tolist()
    e = float(rng.uniform(-0.8, 0.8))
    return SliderCrankGenerator((2.0 * a, 2.0 * a * e, b * b - a * a - e * e), start, 0.0)


def known(
    rng: np.random.Generator, kind: MechanismKind, count: int, given: tuple[str, ...]
) -> Known:
    """A task whose function a random mechanism generates over the whole range: ``given`` are the
    starts that the task tells. x is the share of the input's range."""
    while True:
        own = random_generator(rng, kind)
        turn = float(rng.choice([-1.0, 1.0]) * rng.uniform(0.7, 1.6))
        sign = float(rng.choice([-1.0, 1.0]))
        phi = own.input_start + turn * np.linspace(0.0, 1.0, 501)
        if np.min(own.discriminant(phi)) < CLEAR:
            continue
        course = _whole(own, phi, sign)
        span = float(course[-1] - course[0])
        if abs(span) < 0.3 or np.ptp(np.sign(np.diff(course))) > 0.0:
            continue  # an output that turns back is asked for in tests of its own
        first = float(course[0])
        function = GivenFunction("a known one", _function(own, turn, sign, first, span))
        starts = {"input_start_rad": own.input_start} if "input" in given else {}
        starts |= {"output_start": first} if "output" in given else {}
        task = FunctionTask(function, 0.0, 1.0, turn, span, kind, count, **starts, ground_m=1.0)
        return Known(own, sign, task)


def _function(
    own: Generator, turn: float, sign: float, first: float, span: float
) -> Callable[[Array], Array]:
    """The share of the output's way, over that of the input's."""

    def at(x: Array) -> Array:
        off = _whole(own, own.input_start + turn * np.append(0.0, x), sign)[1:] - first
        if isinstance(own, FourBarGenerator):  # looks may lie far apart: the turn is the way's own
            middle = 0.5 * span
            off = middle + np.remainder(off - middle + math.pi, math.tau) - math.pi
        return np.asarray(off / span)

    return at


def _whole(own: Generator, phi: Array, sign: float) -> Array:
    """The output, of a four-bar without jumps by whole turns."""
    output = own.output(phi, sign)
    return np.unwrap(output) if isinstance(own, FourBarGenerator) else output


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
    ends = _direction(one.output_start) if isinstance(one, FourBarGenerator) else [one.output_start]
    return np.array([*one.lengths, *_direction(one.input_start), *ends])


def _direction(angle: float) -> list[float]:
    return [math.cos(angle), math.sin(angle)]


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
        ends = _direction(start) if kind == "fourbar" else [start]
        target = np.array([*np.array(own.lengths) / scale, *_direction(own.input_start), *ends])
        off = min(float(np.max(np.abs(numbers(one) - target))) for one in found)
        assert off < 1e-5, (off, own)


def by_burmester(turns: Array, ways: Array) -> list[Array]:
    """The four-bars of five points, as cranks of the output seen from the input.

    Held by the input, the output's pivot is at exp(-i turn), the output turned by way - turn, and
    its pin B on a circle about A. That the pivots O4 and O2 are such a pair is the trivial one.
    """
    pairs = zip(turns.tolist(), ways.tolist(), strict=True)
    poses = [PlanePose(cmath.exp(-1j * turn), way - turn) for turn, way in pairs]
    found = []
    for dyad in five_positions(poses):
        if abs(dyad.fixed) + abs(dyad.moving) > 1e-9:
            ends = [_direction(cmath.phase(pin)) for pin in (dyad.fixed, dyad.moving)]
            lengths = [abs(dyad.fixed), dyad.radius(poses), abs(dyad.moving)]
            found.append(np.array([*lengths, *ends[0], *ends[1]]))
    return found


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
def test_a_search_from_many_starts_finds_no_other_slider_crank(tasks: int) -> None:
    rng, hits = np.random.default_rng(21), 0
    for _ in range(tasks):
        task = known(rng, "slider-crank", 5, ()).task
        turns, ways = task.input_turn(task.x_points), task.output_scales(task.x_points)
        found = [numbers(one) for one in solved(task)]
        for guess in rng.uniform(-1.5, 1.5, (150, 5)):
            pins = _searched(turns, ways, guess)
            if pins is not None and max(abs(pins)) < 100.0 and np.hypot(*pins[:2]) > 1e-3:
                assert min(_pins_off(pins, one) for one in found) < 1e-5, (pins, found)
                hits += 1
    assert hits > 10 * tasks


def _searched(turns: Array, ways: Array, guess: Array) -> Array | None:
    """Pin A, s0 and e of the slider, and the rod squared, by the closure of the loop alone."""

    def open_by(p: Array) -> Array:
        a = complex(p[0], p[1]) * np.exp(1j * turns)
        b = p[2] + ways + 1j * p[3]
        return np.asarray(np.abs(a - b) ** 2 - p[4])

    pins, _, reached, _ = fsolve(open_by, guess, full_output=True, xtol=1e-14)
    if reached != 1 or np.max(np.abs(open_by(pins))) > 1e-12:
        return None
    return np.asarray(pins)


def _pins_off(pins: Array, one: Array) -> float:
    a, b, cosine, sine, s0 = one
    own = np.array([a * cosine, a * sine, s0, b * b])
    return float(np.max(np.abs(pins[[0, 1, 2, 4]] - own) / (1.0 + np.abs(own))))


@pytest.mark.parametrize("kind", ["fourbar", "slider-crank"])
def test_polishing_by_a_gradient_takes_away_what_rounding_left(kind: MechanismKind) -> None:
    case, free = known(np.random.default_rng(3), kind, 5, ()), ("input", "output")
    own, sign, turns = case.generator, case.sign, case.task.input_turn(case.task.x_points)
    exact = own.gradient(turns, sign, free)
    for k, step in enumerate(1e-6 * np.eye(5)):
        ends = [own.moved(s * step, free).error(turns, turns, sign) for s in (1.0, -1.0)]
        np.testing.assert_allclose((ends[0] - ends[1]) / 2e-6, exact[:, k], rtol=1e-6, atol=1e-8)
    ways = own.output(own.input_start + turns, sign)
    rough = own.moved(1e-7 * np.array([1.0, -1.0, 1.0, 1.0, -1.0]), free)
    assert np.max(np.abs(rough.error(turns, ways, sign))) > 1e-9
    fine = rough.polished(turns, ways, free)
    assert np.max(np.abs(fine.error(turns, ways, sign))) < 1e-14
