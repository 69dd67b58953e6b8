"""A whole sweep: lay out a study, run what a store lacks of it, and time that."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from rich.console import Console

from reports.output.console import tell
from reports.output.provenance import provenance
from reports.plan.grid import Grid, grid
from reports.plan.study import Study
from reports.store.manifest import Manifest
from reports.store.writer import Writer
from reports.sweep.cluster import connected
from reports.sweep.running import Done, Running
from reports.workers.isolated import Limits
from reports.workers.signals import Stopped


@dataclass(frozen=True)
class Manner:
    """How a sweep is run: what a cell may take, how many at a time (0: one per processor), on which
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
    """Do what of the study is not done yet; what is damaged in the store is mended, and told.

    ``command`` is kept with the run, to be repeated. Raises CrankcheckError for what can be told
    of the study, or of the folder, before running.
    """
    laid = grid(study)
    client = None if manner.dask is None else connected(manner.dask)
    facts = provenance({task.cell.engine: task.version for task in laid.tasks})
    run = {
        "command": list(command),
        "started": datetime.now(UTC).isoformat(timespec="seconds"),
        "study": study.model_dump(exclude_defaults=True),
        "provenance": facts,
        # What the cells are called in this run, which may not be what they were called before.
        "lines": {t.line: [t.variant, t.cell.profile, t.cell.gated] for t in laid.tasks},
        **_steps(laid),
    }
    with Writer(folder, Manifest(laid.texts, (run,))) as writer:
        tell(writer.mended)
        running = Running(writer, laid.tasks, manner.limits, facts, progress)
        try:
            done = running.errors(manner.keep_runs, manner.jobs, client, manner.again)
            if manner.timing:
                done = running.timings(done)
        except Stopped:
            progress.print("what is done is kept; the same command goes on from there")
            raise
    return laid, done


def _steps(laid: Grid) -> dict[str, dict[str, list[float]]]:
    """The steps in a turn of each line of elastic links, whose segments say what these are."""
    steps: dict[str, list[float]] = {}
    for task in laid.tasks:
        if task.cell.scene.elastic:
            steps.setdefault(task.line, []).append(round(task.cell.steps_per_turn, 6))
    return {"steps": steps} if steps else {}
