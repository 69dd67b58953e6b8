"""`crankcheck sweep`: run the grid of a study, keep every cell, then time them one by one."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from models.errors import CrankcheckError, shown
from reports.face.sweep_text import show_sweep
from reports.plan.chosen import left_out_note
from reports.plan.chosen_study import StudyChoice, chosen_study, refuse_other_engine, study_engines
from reports.plan.elastic import chosen_segments, chosen_springs, shortened_note
from reports.plan.forces import silent_note
from reports.plan.study import Study, StudyValue, load_study
from reports.requests.options import Duration, Engines, Forces, Jobs, SpringKind
from reports.sweep.whole import Manner, swept
from reports.workers.isolated import checked_limits


@dataclass(frozen=True)
class SweepRequest:
    """What `sweep` was asked for, as given."""

    folder: Annotated[Path, typer.Option("-o", "--output", help="Folder of the results.")]
    scenes: Annotated[
        Sequence[str],
        typer.Argument(metavar="SCENE", help="Shipped names or scene files; those of the study."),
    ] = ()
    study: Annotated[
        Path | None, typer.Option(help="Study file (.toml, .yaml); the shipped one if none.")
    ] = None
    engines: Engines = ()
    profiles: Annotated[
        Sequence[str], typer.Option("--profile", help="Profile, in place of the study's variants.")
    ] = ()
    steps_per_turn: Annotated[
        str | None, typer.Option(metavar="N,N,...", help="Steps in a turn, with commas.")
    ] = None
    turns: Annotated[float | None, typer.Option(help="Turns of the driver.")] = None
    settings: Annotated[
        Sequence[str],
        typer.Option("--set", metavar="ENGINE.SETTING=A,B", help="One variant per value."),
    ] = ()
    limit_s: Annotated[float, typer.Option(help="Longest time for a cell, in seconds.")] = 60.0
    memory_gb: Annotated[float, typer.Option(help="Most memory for a cell, in GB.")] = 2.0
    jobs: Jobs = 0
    dask: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="Run on the cluster of this scheduler.")
    ] = None
    timing: Annotated[bool, typer.Option(help="Time the cells after the error runs.")] = True
    keep_trajectories: Annotated[
        bool, typer.Option("--keep-trajectories", help="Keep the whole motion of every cell.")
    ] = False
    again: Annotated[
        bool, typer.Option("--again", help="Run cells again that timed out or crashed.")
    ] = False
    forces: Forces = False
    free: Annotated[
        bool, typer.Option("--free", help="Let scenes go; those of free motion if none is named.")
    ] = False
    dt_s: Annotated[
        str | None, typer.Option("--dt", metavar="S,S,...", help="Steps of free motion, seconds.")
    ] = None
    duration_s: Duration = None
    segments: Annotated[
        str | None,
        typer.Option(metavar="N,N,...", help="Of each elastic link, with commas (default 16)."),
    ] = None
    springs: SpringKind = None

    def run(self, console: Console, progress: Console) -> int:
        """Do what of the study is not done yet; returns the exit code, 0.

        A cell that failed is a row with its status and reason, and no failure of the sweep. What is
        damaged in the store is mended, and told. Raises CrankcheckError for what can be told of the
        request before running.
        """
        limits = checked_limits(self.limit_s, self.memory_gb)
        manner = Manner(
            limits,
            self.jobs,
            self.dask,
            timing=self.timing,
            keep_runs=self.keep_trajectories,
            again=self.again,
        )
        command = ["crankcheck", *sys.argv[1:]]
        study = asked(self)
        silent = silent_note([one.engine for one in study.variants]) if study.forces else ""
        for note in filter(None, (silent, left_out_note(study.scenes))):
            progress.print(note, markup=False, highlight=False, soft_wrap=True)
        laid, done = swept(study, self.folder, manner, command, progress)
        lengths = {
            (t.cell.scene.name, t.cell.dt_s * t.cell.steps): t.cell.scene for t in laid.tasks
        }
        notes = (shortened_note(scene, lasts_s) for (_, lasts_s), scene in lengths.items())
        for note in filter(None, dict.fromkeys(notes)):
            progress.print(note, markup=False, highlight=False, soft_wrap=True)
        show_sweep(console, self.folder, len(laid.tasks), done)
        return 0


def asked(request: SweepRequest) -> Study:
    """The study of the file, or the shipped one, with what the command line says in its place."""
    study = load_study(request.study)
    engines = study_engines(study, request.engines)
    choice = StudyChoice(
        request.scenes,
        request.engines,
        request.profiles,
        _steps("--steps-per-turn", request.steps_per_turn, "90,180,360"),
        request.turns,
        _overrides(request.settings, engines),
        request.forces,
        request.free,
        _steps("--dt", request.dt_s, "2e-3,1e-3"),
        request.duration_s,
        _segments(request.segments),
        [
            chosen_springs(text.strip())
            for text in (request.springs or "").split(",")
            if text.strip()
        ],
    )
    return chosen_study(study, choice, is_shipped=request.study is None)


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
        refuse_other_engine(owner, engines, f"--set {shown(text)}")
        several: list[StudyValue] = [value.strip() for value in values.split(",")]
        overrides.setdefault(owner, {})[setting.strip()] = several
    return overrides


def _segments(text: str | None) -> list[int]:
    """`4,8,16` as whole numbers."""
    try:
        return [] if text is None else [chosen_segments(int(part)) for part in text.split(",")]
    except ValueError:
        raise CrankcheckError(
            f"--segments {shown(text)}: write whole numbers with commas between, such as 4,8,16"
        ) from None


def _steps(option: str, text: str | None, such_as: str) -> list[float]:
    """`90,180,360` as numbers."""
    try:
        return [] if text is None else [float(part) for part in text.split(",")]
    except ValueError:
        raise CrankcheckError(
            f"{option} {shown(text)}: write numbers with commas between, such as {such_as}"
        ) from None
