"""Tasks near to one without a solution: a number moved no further than needed, or a requirement
given up."""

import itertools
from collections.abc import Callable, Iterator

import numpy as np
from pydantic import ValidationError

from analytic.kinematics import solve_driven
from analytic.lectures.synthesis.design import AskedAngle, AskedPlace
from analytic.lectures.synthesis.examine import Examined, way_of
from models.errors import CrankcheckError, ReachError
from models.lectures.shipped_tables import TaskTable
from models.lectures.tasks.positions import PositionsTask

MOVED = ("rod_m", "offset_m", "time_ratio", "distance_m", "rocker_m", "swing_deg", "deviation")
"""Numbers of tasks that are moved, one at a time."""
BY = (0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 3.0, 9.0)
"""Factors of a moved number, less 1; or of its reciprocal."""
HALVINGS = 5
"""Halvings between the last factor without a solution and the first with one."""
OPENED = ("input_start_deg", "output_start_deg", "output_start_m", "crank_deg", "fixed_m")
"""Requirements that are left open, one at a time; a wish for the transmission comes after them."""
LOOKS = 721
ROUNDING = 1e-9
"""Distance from a position that is met, over the size."""

Solve = Callable[[TaskTable], list[Examined]]
"""Mechanisms without a defect of a task. Raises CrankcheckError for an impossible one."""


def nearest(task: TaskTable, solve: Solve) -> tuple[str, list[Examined]]:
    """Return what the nearest task with a solution gives up, in words, and its mechanisms; none if
    no task of those tried has one."""
    found = [each for key in MOVED if (each := _moved(task, key, solve)) is not None]
    for number, (words, changes) in enumerate([] if found else _reduced(task)):
        if sound := _sound(task, changes, solve):
            off, by = _passes(task, sound[0], number)
            found.append((off, words + by, sound))
            if not isinstance(task, PositionsTask):
                break
    _, gives_up, sound = min(found, key=lambda each: each[0], default=(0.0, "", []))
    return gives_up, sound


def _sound(task: TaskTable, changes: dict[str, object], solve: Solve) -> list[Examined]:
    """Return the mechanisms of a changed task; none where it is no task, or has none."""
    try:
        return solve(type(task).model_validate(task.model_dump() | changes))
    except (ValidationError, CrankcheckError):
        return []


def _moved(task: TaskTable, key: str, solve: Solve) -> tuple[float, str, list[Examined]] | None:
    """Return the change of a number [share], its text and mechanisms; None without any."""
    value = getattr(task, key, None)
    if not isinstance(value, float) or not value:
        return None

    def at(by: float, sign: float) -> list[Examined]:
        return _sound(task, {key: value * (1.0 + by) ** sign}, solve)

    for last, by in itertools.pairwise((0.0, *BY)):
        for sign in (1.0, -1.0):
            if not (found := at(by, sign)):
                continue
            near, far = last, by
            for _ in range(HALVINGS):
                middle = 0.5 * (near + far)
                nearer = at(middle, sign)
                near, far = (near, middle) if nearer else (middle, far)
                found = nearer or found
            return far, f"{key} = {value:.10g}, and has {value * (1.0 + far) ** sign:.10g}", found
    return None


def _reduced(task: TaskTable) -> Iterator[tuple[str, dict[str, object]]]:
    """Yield changes of a task to a requirement less, and its text: of positions each in turn."""
    if isinstance(task, PositionsTask):
        for k in range(len(task.positions)) if len(task.positions) > 2 else ():
            rest = [each.model_dump() for n, each in enumerate(task.positions) if n != k]
            changes: dict[str, object] = {"positions": rest}
            if len(rest) < 4:
                changes["moving_m"] = _pins(task, 1 if k == 0 else 0)
            yield f"position {k + 1}", changes
        return
    for key in OPENED:
        if getattr(task, key, None) is not None:
            yield key, {key: None}
    points: object = getattr(task, "points", None)
    if isinstance(points, int):
        yield "one of the precision points", {"points": points - 1}
    every = points if isinstance(points, list) else []
    for x in every:
        yield f"the point x = {x:g}", {"points": [each for each in every if each != x]}
    if task.least_transmission_deg is not None:
        yield "least_transmission_deg", {"least_transmission_deg": None}


def _pins(task: PositionsTask, number: int) -> list[list[float]]:
    """Return moving pivots in a position: the given ones, two named points, or the point and one
    beside it."""
    (first, angle), (place, turned) = task.poses[0], task.poses[number]
    own = [first + np.exp(1j * angle) * each for each in task.own_points.values()]
    own = [*own, first + 0.5j * (task.poses[-1][0] - first)][:2]
    given = getattr(task, "moving_m", None)
    turn = np.exp(1j * (turned - angle))
    moved = [place + turn * (complex(*each) - first) for each in given] if given else []
    moved = moved or [place + turn * (each - first) for each in own]
    return [[float(each.real), float(each.imag)] for each in moved]


def _passes(task: TaskTable, one: Examined, number: int) -> tuple[float, str]:
    """Return how near a mechanism comes to the position that it gives up [sizes], and the text."""
    if not isinstance(task, PositionsTask):
        return 0.0, ""
    place, angle = task.poses[number]
    kept = one.positions[0].asked
    (link,) = (each.link for each in kept if isinstance(each, AskedAngle))
    points = [each.point for each in kept if isinstance(each, AskedPlace)]
    own = task.own_points[points[0]] if points else 0j
    way = way_of(one.scene.driver.law, LOOKS)
    try:
        motion = solve_driven(one.scene, way, np.ones(1), np.zeros(1), bound=False)
    except ReachError:
        return np.inf, ""
    target = place + own * np.exp(1j * angle)
    there = motion.points[points[0]].position @ (1.0, 1j) if points else np.full(LOOKS, target)
    turned = motion.links[link].theta - angle
    turned = np.abs(turned - 2.0 * np.pi * np.round(turned / (2.0 * np.pi)))
    size = max(abs(each - place) for each, _ in task.poses) or one.scene.longest_m
    off = np.abs(there - target) / size + turned
    k = int(np.argmin(off))
    if off[k] < ROUNDING:
        return float(off[k]), ", passed in another order"
    text = f", passed by {abs(there[k] - target):.3g} m and {np.degrees(turned[k]):.3g} deg"
    return float(off[k]), text
