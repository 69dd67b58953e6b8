"""`synth`: the mechanisms that do a task."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike, fspath
from typing import TYPE_CHECKING

from analytic.lectures.synthesis.solutions import Solutions, solutions_of
from models.errors import CrankcheckError, shown
from models.lectures.shipped_tables import table_of
from models.lectures.tasks import KINDS, load_task, refuse_unknown
from models.lectures.tasks.task import TaskTable
from models.scene import Scene
from reports.requests.arguments import told_at_the_call
from reports.requests.shown import Shown

if TYPE_CHECKING:
    import pandas as pd
    from rich.console import Console

LISTED = 5
"""Solutions that are printed."""
TaskLike = str | PathLike[str] | Mapping[str, object]


@dataclass(frozen=True, eq=False, repr=False)
class Synthesis(Shown):
    """The solutions of a task (`synth`), the best first.

    ``details`` holds all that is known of them: ``examined`` has for each its ``scene``,
    ``positions``, ``defects``, ``least_transmission_rad``, ``extent_m`` and the like.
    """

    details: Solutions

    @property
    def scenes(self) -> list[Scene]:
        """The scenes of the solutions without a defect: what every other function takes."""
        return [one.scene for one in self.details.sound]

    def frame(self) -> pd.DataFrame:
        """A row for each solution, those with a defect too."""
        from reports.lectures.design.design_tables import solution_frame

        return solution_frame(self.details.examined)

    def proof(self, engine: str, profile: str = "tuned", *, best: int = 1) -> pd.DataFrame:
        """What an engine makes of the best solutions without a defect: a row for each thing that
        is asked at each position.

        Raises
        ------
        EngineError
            An unknown engine or profile, or a missing package.
        """
        from reports.lectures.design.design_tables import proof_frame
        from reports.lectures.design.proof import proven

        found = enumerate(self.details.examined, 1)
        sound = [(number, one) for number, one in found if not one.defects][:best]
        return proof_frame(
            {number: proven(one, self.details.task, engine, profile) for number, one in sound}
        )

    def show(self, console: Console) -> None:
        from reports.lectures.design.design_tables import counted, solution_table

        listed = self.details.examined[:LISTED]
        console.print(counted(self.details, len(listed)), highlight=False, markup=False)
        console.print("", solution_table(listed), sep="\n")


@told_at_the_call
def synth(kind: str, task: TaskLike) -> Synthesis:
    """The mechanisms that do a task.

    Parameters
    ----------
    kind : str
        coupler, rocker, stroke, quick-return, function, path or straight-line.
    task : str, path or mapping
        A shipped task by its name, a task file, or its tables.

    Raises
    ------
    CrankcheckError
        Another kind, no such task, or a task that no mechanism does; the message says what would
        work.
    SceneError
        A task with faults, all that were found in one message.
    """
    return Synthesis(solutions_of(_task(kind, task)))


def _task(kind: str, task: TaskLike) -> TaskTable:
    if isinstance(task, Mapping):
        refuse_unknown(kind)
        return table_of(dict(task), KINDS[kind], "task")
    try:
        return load_task(kind, fspath(task))
    except TypeError:
        raise CrankcheckError(
            f"task: found {shown(task)}; give a shipped name, the path of a task file or its tables"
        ) from None
