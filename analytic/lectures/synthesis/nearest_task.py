"""Tasks near to one without a solution: a number moved as needed, or a requirement given up."""

import itertools
from collections.abc import Callable, Iterator

import numpy as np
from pydantic import ValidationError

from analytic.kinematics import solve_driven
from analytic.lectures.synthesis.design import PIVOTS, AskedAngle, AskedPlace
from analytic.lectures.synthesis.examine import UNMET, Examined, way_of
from models.array import Array
from models.errors import CrankcheckError, ReachError
from models.lectures.shipped_tables import TaskTable
from models.lectures.tasks.positions import PositionsTask

MOVED = ("rod_m", "offset_m", "time_ratio", "distance_m", "swing_deg", "rocker_m", "deviation")
"""Numbers of tasks that are moved, one at a time."""
FIRST, MOST = 0.02, 9.0
"""First and largest factor of a number, or of a time ratio less 1, or its reciprocal; less 1."""
CLOSE, WIDE = 1.03, 2.5
"""Steps to the next factor: after a refusal, which takes no time, and after a defect."""
KNOWN, DIGITS = 1e-3, 1e-9
"""Width in which the least change lies at the end: over it, or of the digits that are shown."""
OPENED = (
    "input_start_deg", "output_start_deg", "output_start_m", "crank_deg", "distances_m",
    "driving_dyad",
)  # fmt: skip
"""Requirements that are left open, one at a time; a wish for the transmission comes after them."""
LOOKS = 721
CLOSER = 5
"""Times that each least distance from a position is looked at between its neighbours: to 1e-15."""

Solve = Callable[[TaskTable], list[Examined]]
"""Mechanisms without a defect of a task. Raises CrankcheckError for an impossible one."""


Near = tuple[float, str, list[Examined] | None]
"""Size of the change, its text, and the mechanisms; None for a task that is refused."""


def nearest(task: TaskTable, solve: Solve) -> tuple[str, list[Examined]]:
    """Return what the nearest task with a solution gives up, in words, and its mechanisms; none if
    no task of those tried has one."""
    found: list[Near] = []
    for key, sign in itertools.product(MOVED, (1.0, -1.0)):
        most = found[-1][0] * (1.0 - 2.0 * KNOWN) if found else MOST
        found += _moved(task, key, sign, most, solve)
    for words, changes, number in [] if found else _reduced(task):
        if sound := _sound(task, changes, solve):
            off, by = _passes(task, sound[0], number)
            found.append((off, words + by, sound))
            if not off:
                break
    _, gives_up, sound = min(found, key=lambda each: each[0], default=(0.0, "", None))
    return gives_up, sound or []


def _sound(task: TaskTable, changes: dict[str, object], solve: Solve) -> list[Examined] | None:
    """Return the mechanisms of a changed task; None where it is no task, or is refused."""
    try:
        return solve(type(task).model_validate(task.model_dump() | changes))
    except (ValidationError, CrankcheckError):
        return None


def _moved(task: TaskTable, key: str, sign: float, most: float, solve: Solve) -> list[Near]:
    """Return the least change of a number one way, up to ``most`` of it; none without any."""
    value = getattr(task, key, None)
    if not isinstance(value, float) or not value:
        return []
    least = 1.0 if key == "time_ratio" else 0.0  # of which there is no quick return

    def at(by: float) -> Near:
        told = f"{least + (value - least) * (1.0 + by) ** sign:.10g}"
        sound = _sound(task, {key: float(told)}, solve)
        return by, f"{key} = {value:.10g}, and has {told}", sound

    near, best = 0.0, at(min(FIRST, most))
    while not best[2] and best[0] < most:
        near, step = best[0], CLOSE if best[2] is None else WIDE
        best = at(min(near * step, most))
    while best[2] and best[0] - near > max(KNOWN * best[0], DIGITS):
        closer = at(0.5 * (near + best[0]))
        near, best = (near, closer) if closer[2] else (closer[0], best)
    return [best] if best[2] else []


def _reduced(task: TaskTable) -> Iterator[tuple[str, dict[str, object], int]]:
    """Yield a requirement, the task's change to one without it, and its position's number or -1."""
    for key in OPENED:
        field = type(task).model_fields.get(key)
        if field is not None and getattr(task, key) != field.default:
            yield key, {key: field.default}, -1
    if isinstance(task, PositionsTask):
        also = "fixed_m and " if getattr(task, "fixed_m", None) is not None else ""
        if also:
            yield "fixed_m", {"fixed_m": None, "moving_m": _pins(task, 0)}, -1
        for k in range(len(task.positions)) if len(task.positions) > 2 else ():
            rest = [each.model_dump() for n, each in enumerate(task.positions) if n != k]
            pins = {"moving_m": _pins(task, 1 if k == 0 else 0)} if len(rest) < 4 else {}
            yield f"{also}position {k + 1}", {"positions": rest, "fixed_m": None, **pins}, k
        return
    points: object = getattr(task, "points", None)
    if isinstance(points, int):
        yield "one of the precision points", {"points": points - 1}, -1
    every = points if isinstance(points, list) else []
    for x in every:
        yield f"the point x = {x:g}", {"points": [each for each in every if each != x]}, -1
    if task.least_transmission_deg is not None:
        yield "least_transmission_deg", {"least_transmission_deg": None}, -1


def _pins(task: PositionsTask, number: int) -> list[list[float]]:
    """Return moving pivots in a position: given, two named points, or the point and one beside
    it."""
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
    if not isinstance(task, PositionsTask) or number < 0:
        return 0.0, ""
    place, angle = task.poses[number]
    kept = one.positions[0].asked
    (link,) = (each.link for each in kept if isinstance(each, AskedAngle))
    # A body that is a crank has its point in the pivot, where no point has a place of its own.
    point = next((each.point for each in kept if isinstance(each, AskedPlace)), PIVOTS[0])
    target = place + task.own_points.get(point, 0j) * np.exp(1j * angle)
    size = max(abs(each - place) for each, _ in task.poses) or one.scene.longest_m

    def apart(way: Array) -> tuple[Array, Array, Array]:
        motion = solve_driven(one.scene, way, np.ones(1), np.zeros(1), bound=False)
        far = np.abs(motion.points[point].position @ (1.0, 1j) - target)
        turned = np.abs(AskedAngle(link, angle).off(motion))
        return far / size + turned, far.round(9), np.degrees(turned).round(9)

    every, found = way_of(one.scene.driver.law, LOOKS), []
    try:
        off = apart(every)[0]
        lowest = (np.diff(off, prepend=np.inf) <= 0.0) & (np.diff(off, append=np.inf) >= 0.0)
        for least in np.flatnonzero(lowest).tolist():
            way, k = every, least
            for _ in range(CLOSER):
                way = np.linspace(way[max(k - 1, 0)], way[min(k + 1, LOOKS - 1)], LOOKS)
                off, far, turned = apart(way)
                k = int(np.argmin(off))
            found.append((float(off[k]), f", passed by {far[k]:.3g} m and {turned[k]:.3g} deg"))
    except ReachError:
        return np.inf, ""
    met = max(UNMET, one.proposal.allowed)
    return min([each if each[0] > met else (0.0, ", passed in another order") for each in found])
