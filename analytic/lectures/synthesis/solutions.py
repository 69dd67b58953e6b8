"""Solutions of a task: all proposals, examined.

A ram on too short a rod goes beyond the ends of its lever, and turns back at other times: two met
positions do not show it. The reference follows it over a turn.
"""

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from analytic.lectures.synthesis.coupler import coupler_proposals
from analytic.lectures.synthesis.design import AskedAngle, AskedSlide, PrecisionPosition, Proposal
from analytic.lectures.synthesis.examine import Examined, examine, ranked
from analytic.lectures.synthesis.function.designs import function_designs
from analytic.lectures.synthesis.function.generator import (
    STARTS,
    FunctionProposal,
    structural_error,
)
from analytic.lectures.synthesis.function.task import FunctionTask, GivenFunction
from analytic.lectures.synthesis.nearest_task import nearest
from analytic.lectures.synthesis.path.fit import Progress
from analytic.lectures.synthesis.path.search import generate
from analytic.lectures.synthesis.path.task import PathTask
from analytic.lectures.synthesis.quick_return import quick_return_proposals, rocker_proposals
from analytic.lectures.synthesis.slider_crank_strokes import readable_ratio, stroke_proposals
from analytic.lectures.synthesis.straight_line import hoeken, straight_line
from analytic.lectures.synthesis.straight_part import peaucellier
from analytic.mechanism.cycle import Travel, travel
from models.errors import CrankcheckError, ReachError
from models.lectures.shipped_tables import TaskTable
from models.lectures.tasks.curves import FunctionTable, PathTable, StraightLineTable
from models.lectures.tasks.positions import CouplerTask, QuickReturnTask, RockerTask, StrokeTask


def function_task(table: FunctionTable) -> FunctionTask:
    """Return the task of a function. Raises CrankcheckError for an invalid function or ranges."""
    if table.formula is not None:
        function = GivenFunction.of_formula(table.formula)
    else:
        function = GivenFunction.of_table(table.x or [], table.y or [])
    if table.mechanism == "fourbar":
        output_range = math.radians(table.output_range_deg or 0.0)
        output_start = _radians(table.output_start_deg)
    else:
        output_range, output_start = table.output_range_m or 0.0, table.output_start_m
    return FunctionTask(
        function,
        *table.range_of_x,
        math.radians(table.input_range_deg),
        output_range,
        mechanism=table.mechanism,
        points=table.points if isinstance(table.points, int) else tuple(table.points),
        input_start_rad=_radians(table.input_start_deg),
        output_start=output_start,
        ground_m=table.ground_m,
        equal_ripple=table.equal_ripple,
    )


def path_task(table: PathTable) -> PathTask:
    """Return the task of a path. Raises CrankcheckError for invalid points."""
    angles = None if table.crank_deg is None else tuple(map(math.radians, table.crank_deg))
    return PathTask(tuple(complex(*place) for place in table.points_m), angles, table.closed)


def _radians(degrees: float | None) -> float | None:
    return None if degrees is None else math.radians(degrees)


def straight_line_of(table: StraightLineTable) -> Proposal:
    """Return the linkage of a straight line. Raises CrankcheckError for an impossible task."""
    length, start = table.length_m, complex(*table.start_m)
    direction = math.radians(table.direction_deg)
    if table.linkage == "peaucellier":
        return peaucellier(length, start=start, direction_rad=direction)
    if table.linkage == "hoeken":
        share = None if table.turn_deg is None else table.turn_deg / 360.0
        kept, even = table.deviation, table.even or "line"
        found = hoeken(
            length, share=share, deviation=kept, even=even, start=start, direction_rad=direction
        )
    else:
        found = straight_line(
            table.linkage, length, deviation=table.deviation, start=start, direction_rad=direction
        )
    return found.proposal


STROKE = 1e-9
"""Excess of a stroke or swing by rounding, over it."""
RATIO = 1e-6
"""Tolerance of a time ratio: flat limit positions are roots, and lose half of the digits."""
FLAT = 1e-6
"""Least sine of transmission below which there is a change point on the way."""


def held_to_its_limits(one: Examined) -> Examined:
    """Return a mechanism with a note on its output over a turn of the crank; with a fault if it
    differs from the two positions. A note says where the way has no limits, too near to a singular
    position."""
    name = one.proposal.turns_back
    if not name or one.defects or not one.turns_fully or one.least_sine < FLAT:
        return one
    try:
        found = travel(one.scene, name)
    except CrankcheckError as singular:
        return replace(one, notes=(*one.notes, f"not followed over a turn: {singular}"))
    stroke, ratio = _asked(one.positions, name)
    off = abs(found.stroke - stroke) > STROKE * stroke
    if off or abs(found.time_ratio - ratio) > RATIO * ratio:
        advice = ": take a longer rod" if name in one.scene.sliders else ""
        return replace(one, fault=f"{_told(one, found)}{advice}")
    return replace(one, notes=(*one.notes, _told(one, found)))


def _asked(positions: tuple[PrecisionPosition, ...], name: str) -> tuple[float, float]:
    """Return the stroke [m] or swing [rad] between the two positions, and the ratio of the crank's
    turns between them."""
    every = [each for position in positions for each in position.asked]
    slides = [a.displacement for a in every if isinstance(a, AskedSlide) and a.slider == name]
    angles = [a.angle for a in every if isinstance(a, AskedAngle) and a.link == name]
    if len(slides) + len(angles) != len(positions):
        raise CrankcheckError(f"no position is requested of {name} at its limits")
    way = slides[1] - slides[0] if slides else math.remainder(angles[1] - angles[0], math.tau)
    forth = (positions[1].driver_rad - positions[0].driver_rad) % math.tau
    back = math.tau - forth
    return abs(way), max(forth, back) / min(forth, back)


def _told(one: Examined, found: Travel) -> str:
    if one.proposal.turns_back in one.scene.sliders:
        goes = f"goes {found.stroke:.6g} m"
    else:
        goes = f"swings {math.degrees(found.stroke):.6g} deg"
    return f"{goes}, time ratio {readable_ratio(found.time_ratio)}"


PROPOSED = 0.5
"""Finished share of a search when all mechanisms are proposed."""
LONGEST_NAME = 34
"""Letters of a task's name that go on to its scenes, which have 40 with their numbers."""
MOST_PATHS = 10
"""Number of mechanisms that a path is searched for."""


@dataclass(frozen=True)
class Solutions:
    """All proposals examined, the best first; ``looked`` is the number considered for the choice,
    and ``refused`` has the reasons of those that are no mechanism. ``without`` is the reason of a
    task without a solution: then the first one does the nearest task that has one, and has what
    that gives up for a defect."""

    task: TaskTable
    examined: tuple[Examined, ...]
    looked: int
    refused: tuple[str, ...]
    without: str = ""

    @property
    def no_proof(self) -> str:
        """Reason why there may be other solutions, in words; empty where all are proposed."""
        if isinstance(self.task, PathTable):
            return f"a search from {self.task.starts} starts, no proof that there are no others"
        if any(f"{name} start" in one.proposal.chosen for one in self.examined for name in STARTS):
            return "open starts are tried on a grid, no proof that there are no others"
        return ""

    @property
    def sound(self) -> list[Examined]:
        """Proposals without a defect."""
        return [one for one in self.examined if not one.defects]


def solutions_of(task: TaskTable, progress: Progress | None = None) -> Solutions:
    """Propose and examine; a search calls ``progress`` with the finished share and its distance. A
    task without a solution is given the best of the nearest one that has some. Raises
    CrankcheckError for a task without any, near to it as well."""
    try:
        found = _solved(task, progress)
        if found.sound:
            return found
        reason = "every mechanism has a defect"
    except CrankcheckError as error:
        if (task.loads and "loads." in str(error)) or "coincide" in str(error):
            raise  # faults of the task's file
        found, reason = Solutions(task, (), 0, ()), str(error)

    def solve(near: TaskTable) -> list[Examined]:
        if progress is not None:
            progress(0.99, math.inf)
        return _solved(near, None, few=True).sound

    gives_up, sound = nearest(task, solve)
    offered = [replace(one, fault=f"gives up {gives_up}") for one in sound[:1]]
    if not offered and not found.examined:
        raise CrankcheckError(reason)
    named = [_named(one, task, number) for number, one in enumerate([*offered, *found.examined], 1)]
    return replace(found, examined=tuple(named), without=reason if offered else "")


def _solved(task: TaskTable, progress: Progress | None, *, few: bool = False) -> Solutions:
    """Return the solutions of a task itself. Raises CrankcheckError for a task without any."""
    proposals, looked = _proposals(task, progress, few=few)
    examined, refused = list[Examined](), list[str]()
    for number, proposal in enumerate(itertools.chain(proposals, _at_last(task, examined)), 1):
        draft = replace(
            proposal.draft, name=task.name, source=task.source, note=task.note, loads=task.loads
        )
        try:
            own = replace(proposal, draft=draft, speed_rad_s=task.speed_rad_s)
            one = followed(examine(own))
            examined.append(replace(one, unfulfilled=tuple(unfulfilled(one, task))))
        except CrankcheckError as error:
            if task.loads and "loads." in str(error):
                raise  # of the task's file, and of no mechanism
            refused.append(str(error))
        if progress is not None and not isinstance(task, PathTable):
            progress(PROPOSED + (1.0 - PROPOSED) * number / (1 + len(proposals)), math.inf)
    if not examined:
        why = f": {refused[0]}" if refused else ""
        raise CrankcheckError(f"{task.name}: no mechanism solves the task{why}")
    named = [_named(one, task, number) for number, one in enumerate(ranked(examined), 1)]
    return Solutions(task, tuple(named), looked, tuple(refused))


def _at_last(task: TaskTable, examined: Sequence[Examined]) -> Iterator[Proposal]:
    """Yield the crank or slider of two positions if all examined ones have a defect."""
    if not isinstance(task, CouplerTask) or task.distances_m or task.driving_dyad:
        return
    if len(task.positions) == 2 and all(one.defects for one in examined):
        yield from coupler_proposals(task, unled=True)[0]


def unfulfilled(one: Examined, task: TaskTable) -> list[str]:
    """Return the unfulfilled wishes of a task, in words."""
    least, region = task.least_transmission_deg, task.pivots_in
    told = []
    if least is not None and math.degrees(one.least_transmission_rad) < least:
        told.append(f"transmission below {least:g} deg")
    if region is not None:
        ground = one.proposal.draft.ground.items()
        told += [f"{name} outside the region" for name, place in ground if not region.holds(place)]
    return told


def _named(one: Examined, task: TaskTable, number: int) -> Examined:
    """Return a solution whose scene has a name of its own among those of its task."""
    name = f"{task.name[:LONGEST_NAME]}-{number}"
    return replace(one, draft=replace(one.draft, name=name), scene=replace(one.scene, name=name))


def _proposals(
    task: TaskTable, progress: Progress | None, *, few: bool
) -> tuple[list[Proposal], int]:
    """Return the proposals of a task, and the number considered."""
    if isinstance(task, CouplerTask):
        return coupler_proposals(task, few=few)
    if isinstance(task, PathTable):
        search = generate(
            path_task(task),
            name=task.name,
            count=MOST_PATHS,
            starts=task.starts,
            seed=task.seed,
            time_s=task.time_s,
            progress=progress,
            least_transmission_rad=math.radians(task.least_transmission_deg or 0.0),
        )
        return [fit.proposal for fit in search.fits], task.starts
    found: Sequence[Proposal]
    if isinstance(task, RockerTask):
        found = rocker_proposals(task)
    elif isinstance(task, QuickReturnTask):
        found = quick_return_proposals(task)
    elif isinstance(task, FunctionTable):
        tell = None if progress is None else lambda share: progress(PROPOSED * share, math.inf)
        found = function_designs(function_task(task), tell)
    elif isinstance(task, StraightLineTable):
        found = [straight_line_of(task)]
    else:
        assert isinstance(task, StrokeTask)
        found = stroke_proposals(task)
    return [*found], len(found)


def followed(one: Examined) -> Examined:
    """Return an examined generator with its structural error by the reference over the whole range;
    a fault if it can not be assembled there. Approximate mechanisms miss the allowed error."""
    if not isinstance(one.proposal, FunctionProposal) or one.defects:
        return held_to_its_limits(replace(one, misses=one.proposal.allowed))
    try:
        error = structural_error(one.proposal, one)
    except ReachError:
        return replace(one, fault="can not be assembled over the whole range")
    if one.proposal.task.mechanism == "fourbar":
        told = f"{math.degrees(error.largest):.4g} deg, RMS {math.degrees(error.rms):.4g} deg"
    else:
        told = f"{error.largest:.4g} m, RMS {error.rms:.4g} m"
    note = f"structural error up to {told} ({error.largest_y:.4g} of y)"
    return replace(one, notes=(*one.notes, note), misses=error.largest)
