"""The solutions of a task: what every proposal is worth."""

from __future__ import annotations

from dataclasses import dataclass, replace

from analytic.synthesis.coupler import coupler_proposals
from analytic.synthesis.design import Proposal
from analytic.synthesis.examine import Examined, examine, ranked
from analytic.synthesis.quick_return import quick_return_proposals
from analytic.synthesis.rocker import rocker_proposals
from analytic.synthesis.strokes import stroke_proposals
from models.errors import CrankcheckError
from models.tasks.coupler import CouplerTask
from models.tasks.quick_return import QuickReturnTask
from models.tasks.rocker import RockerTask
from models.tasks.stroke import StrokeTask
from models.tasks.task import TaskTable


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


def solutions_of(task: TaskTable) -> Solutions:
    """Propose and examine. Raises CrankcheckError for a task without any mechanism."""
    proposals, looked = _proposals(task)
    examined, refused = [], []
    for proposal in proposals:
        draft = replace(proposal.draft, note=task.note, loads=task.loads)
        try:
            examined.append(examine(replace(proposal, draft=draft, speed_rad_s=task.speed_rad_s)))
        except CrankcheckError as error:
            refused.append(str(error))
    if not examined:
        why = f": {refused[0]}" if refused else ""
        raise CrankcheckError(f"{task.name}: no mechanism does it{why}")
    return Solutions(task, tuple(ranked(examined)), looked, tuple(refused))


def _proposals(task: TaskTable) -> tuple[list[Proposal], int]:
    """What is proposed for a task, and how many were looked at to choose them."""
    if isinstance(task, CouplerTask):
        return coupler_proposals(task)
    if isinstance(task, RockerTask):
        return rocker_proposals(task)
    if isinstance(task, QuickReturnTask):
        return quick_return_proposals(task)
    assert isinstance(task, StrokeTask)
    return stroke_proposals(task)
