"""Random tasks of every kind, by their number: each has a mechanism."""

import functools
import math
from collections.abc import Callable, Mapping

import numpy as np
import pytest

from analytic.lectures.synthesis import coupler
from analytic.lectures.synthesis.solutions import Solutions, solutions_of
from models.lectures.shipped_tables import TaskTable
from models.lectures.tasks.positions import CouplerTask, QuickReturnTask, RockerTask, StrokeTask

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


TASKS: Mapping[str, Callable[[Draw], TaskTable]] = {each.__name__: each for each in (
    two_positions, three_positions, given_pivots, four_positions, five_positions, driving_dyad,
    rocker_by_angle, rocker_by_positions, central, offset, stroke_and_ratio, slotted_lever,
    whitworth, crank_rocker,
)}  # fmt: skip


def random_task(kind: str, number: int) -> TaskTable:
    return TASKS[kind](np.random.default_rng([19, list(TASKS).index(kind), number]))


@functools.cache
def random_solutions(kind: str, number: int, chosen: int = 4) -> Solutions:
    """The solutions of that task, of many that hold a body no more than ``chosen``. Raises
    CrankcheckError for one of four positions that none does."""
    with pytest.MonkeyPatch.context() as changed:
        changed.setattr(coupler, "CHOSEN", chosen)
        return solutions_of(random_task(kind, number))
