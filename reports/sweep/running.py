"""Run what a store lacks of a grid: errors several at a time, then costs one by one."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, field, replace

from rich.console import Console

from models.errors import CrankcheckError
from reports.cell import unfinished
from reports.rows import cell_row
from reports.store.reader import stored_costs, stored_keys
from reports.store.writer import Writer
from reports.sweep.grid import Task
from reports.sweep.isolation import Isolated, Limits, Lost
from reports.sweep.outcome import UNMEASURED, Outcome, timed
from reports.sweep.parallel import Backend, run_all
from reports.sweep.progress import progress_bar


@dataclass(frozen=True)
class Done:
    """How many cells were run and timed now, and how those that failed did: status to reasons."""

    ran: int = 0
    timed: int = 0
    failed: Mapping[str, Counter[str]] = field(default_factory=dict)


@dataclass(frozen=True)
class Running:
    """The tasks of a grid on their way into a store."""

    writer: Writer
    tasks: Sequence[Task]
    limits: Limits
    facts: Mapping[str, str]
    progress: Console

    def errors(self, keep_motion: bool, where: Backend) -> Done:
        """Run every cell that the store has not."""
        there = stored_keys(self.writer.folder, "cells")
        missing = [task for task in self.tasks if task.key not in there]
        failed: dict[str, Counter[str]] = {}
        found = run_all(missing, self.limits, keep_motion, where)
        with progress_bar(self.progress, "errors", len(missing)) as advance, closing(found):
            for index, how in found:
                task = missing[index]
                outcome = how if isinstance(how, Outcome) else _lost(task, how)
                self._keep(task, outcome, "cluster" if where["backend"] == "dask" else "local")
                status, reason = str(outcome.row["status"]), str(outcome.row["reason"])
                if status != "ok":
                    failed.setdefault(status, Counter())[f"{task.label}: {reason}"] += 1
                advance()
        self.writer.flush()
        return Done(ran=len(missing), failed=failed)

    def timings(self, done: Done) -> Done:
        """Time every cell that ran well and has no timing, alone on this machine."""
        there = stored_keys(self.writer.folder, "timings")
        guesses = stored_costs(self.writer.folder)
        missing = [t for t in self.tasks if t.key in guesses and t.key not in there]
        isolated: Isolated[dict[str, object]] = Isolated(self.limits)
        try:
            with progress_bar(self.progress, "timings", len(missing)) as advance:
                for task in missing:
                    found = isolated.call(timed, task.cell, guesses[task.key])
                    if not isinstance(found, Lost):
                        where = {"processor": self.facts["processor"], "made": self.facts["made"]}
                        self.writer.timing({"key": task.key, **found, **where})
                    advance()
        finally:
            isolated.close()
        self.writer.flush()
        return replace(done, timed=len(missing))

    def _keep(self, task: Task, outcome: Outcome, run_on: str) -> None:
        """Add a cell to the store, with the names that it has in the study."""
        names = {
            "key": task.key,
            "line": task.line,
            "variant": task.variant,
            "scene_digest": task.scene_digest,
            "asked": task.settings,
            "crankcheck": self.facts["crankcheck"],
            "run_on": run_on,
        }
        if outcome.motion is not None:
            self.writer.trajectory(task.key, outcome.motion, outcome.gaps)
        found = outcome.row["version"]
        if found and found != task.version:
            raise CrankcheckError(
                f"a worker has {task.cell.engine} {found}, here it is {task.version}; install the "
                "same version there"
            )
        row = {**names, **outcome.row, "version": task.version}
        self.writer.cell(row, outcome.errors, outcome.trace)


def _lost(task: Task, lost: Lost) -> Outcome:
    """A cell that came to no end of its own, as a row with its reason."""
    row = cell_row(unfinished(task.cell, lost.status, lost.reason))
    return Outcome({**row, **UNMEASURED})
