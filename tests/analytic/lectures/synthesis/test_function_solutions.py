"""All solutions: of Freudenstein's equation beside Burmester's points, and of these beside a second
method and mechanisms that have them."""

import cmath
import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
import pytest

from analytic.lectures.synthesis.burmester import five_positions, four_positions
from analytic.lectures.synthesis.function.generator import Generator
from analytic.lectures.synthesis.function.linkages import (
    FourBarGenerator,
    SliderCrankGenerator,
    fourbars,
)
from analytic.lectures.synthesis.function.task import FunctionTask, GivenFunction, MechanismKind
from analytic.lectures.synthesis.pose import PlanePose, PoseDyad, pole
from models.array import Array
from models.errors import CrankcheckError
from tests.analytic.assur.homotopy import Equation, finite_solutions
from tests.worlds.tiers import few

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


def numbers(one: FourBarGenerator) -> Array:
    """What tells four-bars from each other, angles as directions."""
    return np.array([*one.lengths, *_direction(one.input_start), *_direction(one.output_start)])


def _direction(angle: float) -> list[float]:
    return [math.cos(angle), math.sin(angle)]


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


W, W_BAR, M, M_BAR = (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1)
ONE, W_M_BAR, W_BAR_M = (0, 0, 0, 0), (1, 0, 0, 1), (0, 1, 1, 0)
FINITE = 4


def random_poses(number: int, count: int) -> list[PlanePose]:
    draw = np.random.default_rng([7, number]).uniform(-1.0, 1.0, (count, 3))
    return [PlanePose(complex(x, y), float(3.0 * turn)) for x, y, turn in draw]


def equation(first: PlanePose, pose: PlanePose) -> Equation:
    """The circle of a displacement in w, w', m and m', about the plane's own origin."""
    e = cmath.exp(1j * (pose.angle - first.angle))
    d = pose.point - e * first.point
    e_bar, d_bar = e.conjugate(), d.conjugate()
    single = {W: d_bar * e, W_BAR: d * e_bar, M_BAR: -d, M: -d_bar}
    return {ONE: abs(d) ** 2, W_M_BAR: 1.0 - e, W_BAR_M: 1.0 - e_bar, **single}


def by_homotopy(poses: list[PlanePose]) -> list[PoseDyad]:
    """All real solutions, by following paths to all four."""
    every = finite_solutions([equation(poses[0], pose) for pose in poses[1:]], FINITE)
    assert len(every) == FINITE
    off = np.abs(every[:, 1] - every[:, 0].conj()) + np.abs(every[:, 3] - every[:, 2].conj())
    own = every[off < 1e-8 * (1.0 + np.abs(every).max(axis=1))]
    return [PoseDyad(complex(m), poses[0].back(complex(w))) for w, _, m, _ in own]


def away(one: PoseDyad, others: Iterable[PoseDyad]) -> float:
    return min(abs(one.fixed - o.fixed) + abs(one.moving - o.moving) for o in others)


def spread(poses: list[PlanePose], dyad: PoseDyad) -> float:
    """How far the moving pivot is from one circle, over the size."""
    radii = [abs(pose.at(dyad.moving) - dyad.fixed) for pose in poses]
    return (max(radii) - min(radii)) / (1.0 + max(radii))


@pytest.mark.parametrize("part", few(range(40), range(1), "random positions"))
def test_five_positions_have_all_their_cranks_and_no_others(part: int) -> None:
    counts = set()
    for number in range(25 * part, 25 * part + 25):
        poses = random_poses(number, 5)
        found, others = five_positions(poses), by_homotopy(poses)
        assert len(found) == len(others), number
        for dyad in found:
            assert spread(poses, dyad) < 1e-13
            assert away(dyad, others) < 1e-6 * (1.0 + abs(dyad.fixed) + abs(dyad.moving))
        counts.add(len(found))
    assert counts <= {0, 2, 4}
    assert len(counts) > 1


def coupler_poses(angles: list[float]) -> tuple[list[PlanePose], list[PoseDyad]]:
    """A coupler with its two cranks: four-bar 0.4, 1.0, 0.8, 1.1."""
    a, b, c, d = 0.4, 1.0, 0.8, 1.1
    poses = []
    for angle in angles:
        pin = cmath.rect(a, angle)
        arm = d - pin
        turn = math.acos((abs(arm) ** 2 + b**2 - c**2) / (2.0 * abs(arm) * b))
        poses.append(PlanePose(pin, cmath.phase(arm) + turn))
    return poses, [PoseDyad(0j, 0j), PoseDyad(d + 0j, b + 0j)]


def test_curves_of_four_positions_hold_the_body_and_pass_its_cranks_and_theirs_come_near() -> None:
    poses, cranks = coupler_poses([0.3, 1.0, 2.2, 3.5])
    dyads = [dyad for piece in four_positions(poses, 2880) for dyad in piece]
    assert max(spread(poses, dyad) for dyad in dyads) < 1e-11
    assert all(away(crank, dyads) < 0.02 for crank in cranks)


def test_a_body_that_turns_about_a_pivot_has_too_many_cranks_to_list() -> None:
    poses = [PlanePose(0j, angle) for angle in (0.0, 0.3, 0.7, 1.0, 1.6)]
    with pytest.raises(CrankcheckError, match="so special"):
        five_positions(poses)


def test_the_pole_is_one_point_of_the_body_in_both_positions() -> None:
    first, second = random_poses(5, 2)
    own = pole(first, second)
    assert own is not None
    assert abs(first.back(own) - second.back(own)) < 1e-12
