"""The solutions of a task: what every proposal is worth."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from analytic.lectures.synthesis.coupler import coupler_proposals
from analytic.lectures.synthesis.design import Proposal
from analytic.lectures.synthesis.examine import Examined, examine, ranked
from analytic.lectures.synthesis.function.designs import function_designs
from analytic.lectures.synthesis.function.structural_error import FunctionProposal, structural_error
from analytic.lectures.synthesis.path.rounds import Progress
from analytic.lectures.synthesis.path.search import generate
from analytic.lectures.synthesis.posed import function_task, path_task, straight_line_of
from analytic.lectures.synthesis.quick_return import quick_return_proposals
from analytic.lectures.synthesis.rocker import rocker_proposals
from analytic.lectures.synthesis.strokes import stroke_proposals
from analytic.lectures.synthesis.turning_back import held_to_its_limits
from models.errors import CrankcheckError, ReachError
from models.lectures.tasks.coupler import CouplerTask
from models.lectures.tasks.function import FunctionTable
from models.lectures.tasks.path import PathTable
from models.lectures.tasks.quick_return import QuickReturnTask
from models.lectures.tasks.rocker import RockerTask
from models.lectures.tasks.straight_line import StraightLineTable
from models.lectures.tasks.stroke import StrokeTask
from models.lectures.tasks.task import TaskTable

LONGEST_NAME = 34
"""Letters of a task's name that go on to its scenes, which have 40 with their numbers."""
MOST_PATHS = 10
"""Mechanisms that a path is searched for."""


@dataclass(frozen=True)
class Solutions:
    """Every proposal examined, the best first; ``looked`` is how many were looked at to choose
    them, and ``refused`` says of those that are no mechanism why."""

    task: TaskTable
    examined: tuple[Examined, ...]
    looked: int
    refused: tuple[str, ...]

    @property
    def sound(self) -> list[Examined]:
        """Those without a defect."""
        return [one for one in self.examined if not one.defects]


def solutions_of(task: TaskTable, progress: Progress | None = None) -> Solutions:
    """Propose and examine; a search tells ``progress`` the share that is done, and how near it is.

    Raises
    ------
    CrankcheckError
        A task without any mechanism.
    """
    proposals, looked = _proposals(task, progress)
    examined, refused = [], []
    for number, proposal in enumerate(proposals, 1):
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
            progress(number / len(proposals), math.inf)
    if not examined:
        why = f": {refused[0]}" if refused else ""
        raise CrankcheckError(f"{task.name}: no mechanism does it{why}")
    named = [_named(one, number) for number, one in enumerate(ranked(examined), 1)]
    return Solutions(task, tuple(named), looked, tuple(refused))


def unfulfilled(one: Examined, task: TaskTable) -> list[str]:
    """What a task wishes and a mechanism does not have, in words."""
    least, region = task.least_transmission_deg, task.pivots_in
    told = []
    if least is not None and math.degrees(one.least_transmission_rad) < least:
        told.append(f"transmission below {least:g} deg")
    if region is not None:
        ground = one.proposal.draft.ground.items()
        told += [f"{name} outside the region" for name, place in ground if not region.holds(place)]
    return told


def _named(one: Examined, number: int) -> Examined:
    """A solution whose scene has a name of its own among those of its task."""
    name = f"{one.scene.name[:LONGEST_NAME]}-{number}"
    return replace(one, draft=replace(one.draft, name=name), scene=replace(one.scene, name=name))


def _proposals(task: TaskTable, progress: Progress | None) -> tuple[list[Proposal], int]:
    """What is proposed for a task, and how many were looked at to choose them."""
    if isinstance(task, CouplerTask):
        return coupler_proposals(task)
    if isinstance(task, RockerTask):
        return rocker_proposals(task)
    if isinstance(task, QuickReturnTask):
        return quick_return_proposals(task)
    if isinstance(task, FunctionTable):
        functions: list[Proposal] = [*function_designs(function_task(task))]
        return functions, len(functions)
    if isinstance(task, PathTable):
        return _paths(task, progress)
    if isinstance(task, StraightLineTable):
        return [straight_line_of(task)], 1
    assert isinstance(task, StrokeTask)
    return stroke_proposals(task)


def _paths(task: PathTable, progress: Progress | None) -> tuple[list[Proposal], int]:
    """What least squares found, from so many starts."""
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


def followed(one: Examined) -> Examined:
    """An examined generator with its structural error, worked out by the reference over the whole
    range; what can not be assembled there has a fault. What only comes near misses as much."""
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
