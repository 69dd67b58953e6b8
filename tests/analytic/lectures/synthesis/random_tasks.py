"""Random tasks of synthesis, a generator for each kind, with what their solutions have to hold: the
reference meets the positions, and the engines lead through them."""

import functools
import itertools
import math
from collections.abc import Callable, Iterator, Mapping

import numpy as np
import pytest

from analytic.kinematics import solve, solve_driven
from analytic.lectures.synthesis import coupler
from analytic.lectures.synthesis.examine import IN_LINE, Examined, passing_times
from analytic.lectures.synthesis.function.generator import FunctionProposal
from analytic.lectures.synthesis.solutions import Solutions, solutions_of
from models.errors import CrankcheckError, ReachError
from models.lectures.shipped_tables import TaskTable
from models.lectures.tasks.curves import FunctionTable, PathTable, StraightLineTable
from models.lectures.tasks.positions import CouplerTask, QuickReturnTask, RockerTask, StrokeTask
from models.scene.laws import Oscillating
from reports.lectures.design.proof import proven
from tests.analytic.lectures.synthesis.test_function_solutions import known
from tests.analytic.lectures.synthesis.test_path_shapes import random_path

Draw = np.random.Generator
HEAD = {"name": "random", "source": "a test"}


def _two(draw: Draw) -> tuple[tuple[float, float], tuple[float, float]]:
    return tuple(map(tuple, draw.uniform(-1.0, 1.0, (2, 2)).tolist()))


def _poses(draw: Draw, count: int) -> list[dict[str, object]]:
    """A body that goes on, and turns one way by up to 50 degrees at a time."""
    way = np.cumsum(draw.uniform(0.1, 0.5, (count, 2)) * [1.0, draw.uniform(-1.0, 1.0)], axis=0)
    turns = np.cumsum(draw.uniform(5.0, 50.0, count)) * draw.choice([-1.0, 1.0])
    pairs = zip(way.tolist(), turns.tolist(), strict=True)
    return [{"point_m": place, "angle_deg": turn} for place, turn in pairs]


def two_positions(draw: Draw) -> TaskTable:
    far = tuple((draw.uniform(0.3, 2.0, 2) * draw.choice([-1.0, 1.0], 2)).tolist())
    positions = _poses(draw, 2)
    return CouplerTask(**HEAD, positions=positions, moving_m=_two(draw), distances_m=far)


def three_positions(draw: Draw) -> TaskTable:
    return CouplerTask(**HEAD, moving_m=_two(draw), positions=_poses(draw, 3))


def given_pivots(draw: Draw) -> TaskTable:
    return CouplerTask(**HEAD, fixed_m=_two(draw), positions=_poses(draw, 3))


def four_positions(draw: Draw) -> TaskTable:
    return CouplerTask(**HEAD, positions=_poses(draw, 4))


def five_positions(draw: Draw) -> TaskTable:
    """Positions of the coupler of a four-bar, so that there are two cranks for them at least."""
    a, b, c, d = draw.uniform(0.3, 1.5, 4)
    while not abs(b - c) < abs(a - d) or not a + d < b + c:
        a, b, c, d = draw.uniform(0.3, 1.5, 4)
    start, steps = draw.uniform(0.0, math.tau), np.cumsum(draw.uniform(0.2, 0.9, 5))
    own = complex(*draw.uniform(-0.5, 0.5, 2))
    poses = []
    for theta in start + steps:
        pin = a * np.exp(1j * theta)
        arm = d - pin
        cosine = (abs(arm) ** 2 + b**2 - c**2) / (2.0 * abs(arm) * b)
        along = arm / abs(arm) * np.exp(1j * math.acos(cosine))
        place, angle = pin + along * own, math.degrees(float(np.angle(along)))
        poses.append({"point_m": [float(place.real), float(place.imag)], "angle_deg": angle})
    return CouplerTask(**HEAD, positions=poses)


def driving_dyad(draw: Draw) -> TaskTable:
    return CouplerTask(**{**two_positions(draw).model_dump(), "driving_dyad": True})


def rocker_by_angle(draw: Draw) -> TaskTable:
    swing, rocker = float(draw.uniform(10.0, 150.0)), float(draw.uniform(0.05, 1.0))
    factor = float(draw.uniform(1.2, 5.0))
    distance = rocker * math.sin(math.radians(0.5 * swing)) * factor
    return RockerTask(**HEAD, swing_deg=swing, rocker_m=rocker, distance_m=distance)


def rocker_by_positions(draw: Draw) -> TaskTable:
    return RockerTask(**HEAD, positions=_poses(draw, 2))


def central(draw: Draw) -> TaskTable:
    stroke = float(draw.uniform(0.01, 1.0))
    return StrokeTask(**HEAD, stroke_m=stroke, rod_m=stroke * float(draw.uniform(0.6, 4.0)))


def offset(draw: Draw) -> TaskTable:
    stroke = float(draw.uniform(0.01, 1.0))
    beside = stroke * float(draw.uniform(0.05, 1.0))
    rod = (stroke + beside) * float(draw.uniform(1.1, 4.0))
    return StrokeTask(**HEAD, stroke_m=stroke, form="offset", rod_m=rod, offset_m=beside)


def stroke_and_ratio(draw: Draw) -> TaskTable:
    stroke, ratio = float(draw.uniform(0.01, 1.0)), float(draw.uniform(1.05, 2.5))
    return StrokeTask(**HEAD, stroke_m=stroke, form="offset", time_ratio=ratio)


def slotted_lever(draw: Draw) -> TaskTable:
    """Levers that swing by up to 90 degrees: with more of it pymunk's ram breaks away."""
    ratio, stroke = float(draw.uniform(1.1, 3.0)), float(draw.uniform(0.05, 1.0))
    return QuickReturnTask(**HEAD, mechanism="slotted-lever", time_ratio=ratio, stroke_m=stroke)


def whitworth(draw: Draw) -> TaskTable:
    ratio, crank = float(draw.uniform(1.1, 5.0)), float(draw.uniform(0.05, 1.0))
    return QuickReturnTask(**HEAD, mechanism="whitworth", time_ratio=ratio, crank_m=crank)


def crank_rocker(draw: Draw) -> TaskTable:
    ratio, rocker, swing = draw.uniform([1.05, 0.05, 20.0], [1.5, 1.0, 90.0]).tolist()
    own = {"time_ratio": ratio, "rocker_m": rocker, "swing_deg": swing}
    return QuickReturnTask(**HEAD, mechanism="crank-rocker", **own)


def function(draw: Draw) -> TaskTable:
    """The function of a known four-bar or slider-crank, at three, four or five points."""
    kind, count = ("fourbar", "slider-crank")[draw.integers(2)], int(draw.integers(3, 6))
    given = {3: ("input", "output"), 4: ("input",), 5: ()}[count]
    task = known(draw, kind, count, given).task
    points = [0.5 - 0.5 * math.cos(math.pi * (k + 0.5) / count) for k in range(count)]
    x = [0.0, *points, 1.0]
    unit, factor = ("deg", math.degrees(1.0)) if kind == "fourbar" else ("m", 1.0)
    table = {f"output_range_{unit}": task.output_range * factor, "mechanism": kind}
    if "output" in given:
        table[f"output_start_{unit}"] = task.output_start * factor
    if "input" in given:
        table["input_start_deg"] = math.degrees(task.input_start_rad)
    return FunctionTable(
        **HEAD, **table, x=x, y=task.function.at(np.array(x)).tolist(), range_of_x=(0.0, 1.0),
        points=points, input_range_deg=math.degrees(task.input_range_rad), ground_m=1.0,
    )  # fmt: skip


def path(draw: Draw) -> TaskTable:
    closed, timed, seed = draw.integers((2, 2, 2**31)).tolist()
    task = random_path(seed, 12, timed=bool(timed), closed=bool(closed))
    points = [[place.real, place.imag] for place in task.points]
    turns = None if task.crank_rad is None else np.degrees(task.crank_rad).tolist()
    return PathTable(**HEAD, points_m=points, crank_deg=turns, closed=bool(closed), starts=16)


def straight_line(draw: Draw) -> TaskTable:
    every = ("hoeken", "chebyshev", "watt", "roberts", "evans", "peaucellier")
    linkage, place = every[draw.integers(len(every))], tuple(draw.uniform(-1.0, 1.0, 2).tolist())
    own = {"deviation": 10.0 ** draw.uniform(-5.0, -2.5)} if linkage != "peaucellier" else {}
    length, direction = draw.uniform([0.01, -180.0], [1.0, 180.0]).tolist()
    where = {"start_m": place, "direction_deg": direction}
    return StraightLineTable(**HEAD, **own, **where, linkage=linkage, length_m=length)


TASKS: Mapping[str, Callable[[Draw], TaskTable]] = {each.__name__: each for each in (
    two_positions, three_positions, given_pivots, four_positions, five_positions, driving_dyad,
    rocker_by_angle, rocker_by_positions, central, offset, stroke_and_ratio, slotted_lever,
    whitworth, crank_rocker, function, path, straight_line,
)}  # fmt: skip


def random_task(kind: str, number: int) -> TaskTable:
    return TASKS[kind](np.random.default_rng([19, list(TASKS).index(kind), number]))


@functools.lru_cache(100)
def random_solutions(kind: str, number: int) -> Solutions:
    """The solutions of that task, of many that hold a body no more than four. Raises
    CrankcheckError for one of four positions that none does."""
    with pytest.MonkeyPatch.context() as changed:
        changed.setattr(coupler, "CHOSEN", 4)
        return solutions_of(random_task(kind, number))


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
        if isinstance(own := one.proposal, FunctionProposal):  # its range goes on beyond them
            x = np.linspace(own.task.x_low, own.task.x_high, 200)
            turned = own.generator.input_start + own.task.input_turn(x)
            solve_driven(one.scene, turned, np.ones(1), np.zeros(1), bound=False)
    except ReachError:
        return math.inf, 1.0
    size = one.scene.longest_m
    off = (each.off(motion, size)[k] for k, each in enumerate(one.positions))
    sines = (float(np.min(s[: len(at_s)])) for s in motion.conditioning.values())
    sine = min(sines, default=1.0)
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
        if one.fault.startswith("gives up"):
            assert off < 1e-9, (kind, number, one.text)  # of the positions that are left
        elif "change point" in one.fault:
            assert sine < IN_LINE, (kind, number, one.text)
        elif one.defects:
            assert off > 1e-6, (kind, number, one.defects, one.text)
        else:
            allowed = one.proposal.allowed
            assert off < max(MET / sine**2, allowed), (kind, number, off, one.off, one.text)
    return sum(not one.defects for one in found), len(found)


ENGINES = ("mujoco", "pymunk", "exudyn")


def proofs(kind: str, start: int = 0) -> Iterator[tuple[int, dict[str, float]]]:
    """The tasks of a kind that have a solution without a defect, without end: number, and the
    largest error over its limit of the first solution in each engine."""
    for number in itertools.count(start):
        try:
            sound = random_solutions(kind, number).sound
        except CrankcheckError:
            continue
        if sound:
            yield number, {engine: _proof(sound[0], kind, number, engine) for engine in ENGINES}


def _proof(one: Examined, kind: str, number: int, engine: str) -> float:
    own = one.proposal.allowed * one.scene.longest_m  # of a fit, which no engine mends
    every = proven(one, random_task(kind, number), engine)
    return max(math.inf if math.isnan(met.off) else met.off / (met.limit + own) for met in every)
