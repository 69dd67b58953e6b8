"""`crankcheck sweep`: run the grid of a study, keep every cell, then time them one by one."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

from rich.console import Console

from models.errors import CrankcheckError, harmless, shown
from reports.cli.measuring import SweepRequest
from reports.output.console import tell
from reports.output.numbers import count
from reports.output.provenance import provenance
from reports.plan.chosen import chosen_engines
from reports.plan.grid import Grid, grid
from reports.plan.study import Study, StudyValue, Variant, load_study
from reports.results.lines import lines
from reports.results.recommend import recommendations
from reports.results.table import noise_line, recommendation_table
from reports.store.manifest import Manifest
from reports.store.reader import Stored, read_store
from reports.store.writer import Writer
from reports.sweep.cluster import connected
from reports.sweep.running import Done, Running
from reports.workers.isolated import checked_limits
from reports.workers.signals import Stopped


def sweep(request: SweepRequest, console: Console, progress: Console) -> int:
    """Do what of the study is not done yet; returns the exit code, 0.

    A cell that failed is a row with its status and reason, and no failure of the sweep. What is
    damaged in the store is mended, and told. Raises CrankcheckError for what can be told of the
    request before running.
    """
    limits = checked_limits(request.limit_s, request.memory_gb)
    study = asked(request)
    laid = grid(study)
    client = None if request.dask is None else connected(request.dask)
    facts = provenance({task.cell.engine: task.version for task in laid.tasks})
    run = {
        "command": ["crankcheck", *sys.argv[1:]],
        "started": datetime.now(UTC).isoformat(timespec="seconds"),
        "study": study.model_dump(exclude_defaults=True),
        "provenance": facts,
        # What the cells are called in this run, which may not be what they were called before.
        "lines": {t.line: [t.variant, t.cell.profile, t.cell.gated] for t in laid.tasks},
    }
    with Writer(request.folder, Manifest(laid.texts, (run,))) as writer:
        tell(writer.mended)
        running = Running(writer, laid.tasks, limits, facts, progress)
        try:
            done = running.errors(request.keep_trajectories, request.jobs, client, request.again)
            if request.timing:
                done = running.timings(done)
        except Stopped:
            progress.print("what is done is kept; the same command goes on from there")
            raise
    _summary(console, request.folder, laid, done)
    stored = read_store(request.folder)
    if not stored.timings.empty:
        _recommend(console, stored)
    return 0


def asked(request: SweepRequest) -> Study:
    """The study of the file, or the shipped one, with what the command line says in its place."""
    study = load_study(request.study)
    engines = chosen_engines(request.engines)
    variants = list(study.variants)
    if request.profiles or (request.settings and request.study is None):
        profiles = list(dict.fromkeys(request.profiles or ("tuned",)))
        variants = [Variant(engine=e, profile=p) for p in profiles for e in engines]
    variants = [variant for variant in variants if variant.engine in engines]
    for name, overrides in _overrides(request.settings, engines).items():
        variants = [
            v.model_copy(update={"settings": {**v.settings, **overrides}})
            if v.engine == name
            else v
            for v in variants
        ]
    if not variants:
        raise CrankcheckError(
            f"--engine {', '.join(request.engines)}: the study has no variant of it; add --profile"
        )
    return study.model_copy(
        update={
            "variants": variants,
            "scenes": list(request.scenes) or study.scenes,
            "steps_per_turn": _steps(request.steps_per_turn) or study.steps_per_turn,
            "turns": study.turns if request.turns is None else request.turns,
        }
    )


def _overrides(
    texts: Sequence[str], engines: Sequence[str]
) -> dict[str, dict[str, StudyValue | list[StudyValue]]]:
    """`mujoco.iterations=2,10` and the like, by engine."""
    overrides: dict[str, dict[str, StudyValue | list[StudyValue]]] = {}
    for text in texts:
        name, equals, values = text.partition("=")
        owner, dot, setting = name.strip().partition(".")
        if not (equals and dot and values.strip()):
            raise CrankcheckError(
                f"--set {shown(text)}: write it like --set mujoco.iterations=2,10: "
                "engine.setting=values"
            )
        if owner not in engines:
            raise CrankcheckError(
                f"--set {shown(text)}: {shown(owner)} is no engine of this sweep; it has "
                f"{', '.join(engines)}"
            )
        several: list[StudyValue] = [value.strip() for value in values.split(",")]
        overrides.setdefault(owner, {})[setting.strip()] = several
    return overrides


def _steps(text: str | None) -> list[float]:
    """`90,180,360` as numbers."""
    try:
        return [] if text is None else [float(part) for part in text.split(",")]
    except ValueError:
        raise CrankcheckError(
            f"--steps-per-turn {shown(text)}: write numbers with commas between, such as 90,180,360"
        ) from None


def _summary(console: Console, folder: Path, laid: Grid, done: Done) -> None:
    """What was run now, what there is, and what to do with it."""
    number = len(laid.tasks)
    console.print(
        f"{count(number, 'cell')}: {done.ran} run now, {number - done.ran} were there; "
        f"{done.timed} timed now"
    )
    for status, reasons in sorted(done.failed.items()):
        console.print(f"  {sum(reasons.values())} {status}, such as", highlight=False)
        for reason, _ in reasons.most_common(2):
            console.print(f"    {reason}", markup=False, highlight=False)
    stored = f"stored in {folder}; next: crankcheck report {folder} -o report.html"
    console.print(harmless(stored), markup=False)


def _recommend(console: Console, stored: Stored) -> None:
    """What to choose, of all that the store holds."""
    console.print()
    older = len(stored.cells) - sum(len(line.cells) for line in lines(stored))
    if older:
        console.print(f"left out: {older} cells of earlier runs, whose names stand for others now")
    console.print(recommendation_table(recommendations(stored), console.width))
    console.print(noise_line(stored), highlight=False)
