"""Run the missing cells of a grid in a store: errors in parallel, then costs one by one; and print
the result."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING

from rich.console import Console

from models.errors import CrankcheckError, harmless
from reports.judge.cell import Cell, unfinished
from reports.judge.rows import cell_row
from reports.output.console import say, tell
from reports.output.numbers import count
from reports.output.write import provenance
from reports.plan.grid import Grid, Task, grid
from reports.plan.study import Study
from reports.results.lines import lines
from reports.results.overview import Report
from reports.results.recommend import noise_line, recommendation_table, recommendations
from reports.store.manifest import Manifest
from reports.store.reader import read_store, stored_costs, stored_endings, stored_keys
from reports.store.writer import Writer
from reports.sweep import measured as measuring
from reports.sweep.measured import MeasuredCell
from reports.workers.isolated import Isolated, Limits, Lost, as_they_end
from reports.workers.progress import progress_bar
from reports.workers.signals import Stopped

if TYPE_CHECKING:
    from distributed import Client


ROUNDS = 6
"""Rounds of timing over the same cells, A and B in turn: a disturbance is shorter than most."""
BLOCK = 150
"""Cells of a round, which takes some ten seconds; their timings are lost when a sweep is ended."""


@dataclass(frozen=True)
class Done:
    """Number of cells that were run and timed now, and the failed ones: status to reasons."""

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

    def errors(
        self, keep_run: bool, jobs: int, client: Client | None = None, again: bool = False
    ) -> Done:
        """Run every cell that the store has not, and cells ended by a limit that is wider now; with
        ``again`` all that timed out or crashed.

        So many ``jobs`` at a time here (0: one per processor), or all on the cluster of ``client``.
        """

        def in_child(child: Isolated[MeasuredCell], cell: Cell) -> MeasuredCell | Lost:
            return child.call(measuring.measured, cell, keep_run)

        ended = stored_endings(self.writer.folder)
        asked = {task.key for task in self.tasks}  # others would not come back
        over = {key for key in asked & set(ended) if again or self._wider_than(ended[key])}
        self.writer.forget(over)
        there = stored_keys(self.writer.folder, "cells")
        missing = [task for task in self.tasks if task.key not in there]
        failed: dict[str, Counter[str]] = {}
        cells = [task.cell for task in missing]
        if client is None:
            ends = as_they_end(in_child, cells, jobs, self.limits)
        else:
            ends = measuring.on_cluster(client, cells, self.limits, keep_run)
        with progress_bar(self.progress, "errors", len(missing)) as advance, closing(ends):
            for index, how in ends:
                task = missing[index]
                outcome = how if isinstance(how, MeasuredCell) else _lost(task, how)
                self._keep(task, outcome, "cluster" if client else "local")
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
        where = {"processor": self.facts["processor"], "made": self.facts["made"]}
        count = 0
        with (
            progress_bar(self.progress, "timings", ROUNDS * len(missing)) as advance,
            closing(Isolated[measuring.Repeats](self.limits)) as isolated,
        ):
            for at in range(0, len(missing), BLOCK):
                block = missing[at : at + BLOCK]
                cells = [(task.cell, guesses[task.key]) for task in block]
                timings = measuring.timed_in_turns(isolated, cells, ROUNDS, advance)
                for task, timing in zip(block, timings, strict=True):
                    if timing is not None:
                        row = measuring.timing_row(task.cell, *timing)
                        self.writer.timing({"key": task.key, **row, **where})
                        count += 1
                self.writer.flush()
        return replace(done, timed=count)

    def _keep(self, task: Task, outcome: MeasuredCell, run_on: str) -> None:
        """Add a cell to the store, with the names that it has in the study."""
        self._refuse_other_versions(task, outcome)
        names = {
            "key": task.key,
            "line": task.line,
            "variant": task.variant,
            "scene_digest": task.scene_digest,
            "asked": task.settings,
            "crankcheck": self.facts["crankcheck"],
            "run_on": run_on,
            "limit_s": self.limits.time_s,
            "memory_gb": self.limits.memory_gb,
        }
        if outcome.run is not None:
            self.writer.trajectory(task.key, outcome.run)
        row = {**names, **outcome.row, "version": task.version}
        self.writer.cell(row, outcome.errors, outcome.trace)

    def _wider_than(self, ended: Limits) -> bool:
        """True if a cell that was ended would have more time or memory now."""
        return ended.time_s < self.limits.time_s or ended.memory_gb < self.limits.memory_gb

    def _refuse_other_versions(self, task: Task, outcome: MeasuredCell) -> None:
        """Refuse a worker elsewhere with other packages than the key of the cell says. Raises
        CrankcheckError for an engine, or crankcheck itself, of another version there, or not
        installed."""
        engine, row = task.cell.engine, outcome.row
        for name, found, here in (
            (engine, str(row["version"] or ""), task.version),
            ("crankcheck", outcome.crankcheck, self.facts["crankcheck"]),
        ):
            if found and found != here:
                raise CrankcheckError(
                    f"a worker has {name} {found}, here it is {here}; install the same there"
                )
        if row["status"] == "unsupported" and f"engine {engine}: not installed" in str(
            row["reason"]
        ):
            raise CrankcheckError(
                f"a worker has no {engine}; install {engine}=={task.version} there"
            )


def _lost(task: Task, lost: Lost) -> MeasuredCell:
    """Return a cell that came to no end of its own, as a row with its reason."""
    row = cell_row(unfinished(task.cell, lost.status, lost.reason))
    return MeasuredCell({**row, **measuring.UNMEASURED})


@dataclass(frozen=True)
class Manner:
    """Options of a sweep: the limits of a cell, how many at a time (0: one per processor), the
    cluster, if any; whether it is timed, runs are kept whole, and failed cells run again."""

    limits: Limits
    jobs: int = 0
    dask: str | None = None
    timing: bool = True
    keep_runs: bool = False
    again: bool = False


def swept(
    study: Study, folder: Path, manner: Manner, command: Sequence[str], progress: Console
) -> tuple[Grid, Done]:
    """Run the rest of the study; damage in the store is repaired, and reported.

    ``command`` is kept with the run, to be repeated. Raises CrankcheckError for faults of the
    study, or of the folder, that are known before running.
    """
    laid = grid(study)
    client = None if manner.dask is None else measuring.connected(manner.dask)
    facts = provenance({task.cell.engine: task.version for task in laid.tasks})
    run = {
        "command": list(command),
        "started": datetime.now(UTC).isoformat(timespec="seconds"),
        "study": study.model_dump(exclude_defaults=True),
        "provenance": facts,
        # Names of the cells in this run, which may differ from earlier ones.
        "lines": {t.line: [t.variant, t.cell.profile, t.cell.gated] for t in laid.tasks},
    }
    run |= {"own_steps": own} if (own := _own_steps(study, laid.tasks)) else {}
    with Writer(folder, Manifest(laid.texts, (run,))) as writer:
        tell(writer.mended)
        running = Running(writer, laid.tasks, manner.limits, facts, progress)
        try:
            done = running.errors(manner.keep_runs, manner.jobs, client, manner.again)
            if manner.timing:
                done = running.timings(done)
        except Stopped:
            progress.print("finished cells are kept; the same command continues from there")
            raise
    return laid, done


def _own_steps(study: Study, tasks: Sequence[Task]) -> dict[str, list[float]]:
    """Return the steps in a turn of lines that differ from the study, as elastic links may."""
    steps: dict[str, list[float]] = {}
    for task in tasks:
        if task.cell.scene.elastic and study.times_held:
            steps.setdefault(task.line, []).append(task.cell.steps_per_turn)
    return steps


def show_sweep(console: Console, folder: Path, number: int, done: Done) -> None:
    """Print the number of cells that were run now, the failed ones, and the next command."""
    console.print(
        f"{count(number, 'cell')}: {done.ran} run now, {number - done.ran} were there; "
        f"{done.timed} timed now"
    )
    for status, reasons in sorted(done.failed.items()):
        console.print(f"  {sum(reasons.values())} {status}, such as", highlight=False)
        for reason, _ in reasons.most_common(2):
            say(console, f"    {reason}")
    place = f"stored in {folder}; next: crankcheck report {folder} -o report.html"
    console.print(harmless(place), markup=False)
    stored = read_store(folder)
    over_facets = Report(stored).over_facets
    for line in over_facets.lines if over_facets else ():
        say(console, f"{line.scene}, over facets: {line.engine} {line.name}: {line.words}")
    if stored.timings.empty:
        return
    console.print()
    older = len(stored.cells) - sum(len(line.cells) for line in lines(stored))
    if older:
        console.print(f"left out: {older} cells of earlier runs, whose names mean others now")
    console.print(recommendation_table(recommendations(stored), console.width))
    console.print(noise_line(stored), highlight=False)
