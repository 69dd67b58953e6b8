"""`crankcheck sweep`: run the grid of a study, keep every cell, then time them one by one."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from rich.console import Console

from models.errors import CrankcheckError, shown
from reports.cli.measuring import SweepRequest
from reports.face.sweep_text import show_sweep
from reports.plan.chosen import left_out_note
from reports.plan.chosen_study import StudyChoice, chosen_study, refuse_other_engine, study_engines
from reports.plan.elastic import chosen_segments, chosen_springs, shortened_note
from reports.plan.forces import silent_note
from reports.plan.study import Study, StudyValue, load_study
from reports.sweep.whole import Manner, swept
from reports.workers.isolated import checked_limits


def sweep(request: SweepRequest, console: Console, progress: Console) -> int:
    """Do what of the study is not done yet; returns the exit code, 0.

    A cell that failed is a row with its status and reason, and no failure of the sweep. What is
    damaged in the store is mended, and told. Raises CrankcheckError for what can be told of the
    request before running.
    """
    limits = checked_limits(request.limit_s, request.memory_gb)
    manner = Manner(
        limits,
        request.jobs,
        request.dask,
        timing=request.timing,
        keep_runs=request.keep_trajectories,
        again=request.again,
    )
    command = ["crankcheck", *sys.argv[1:]]
    study = asked(request)
    silent = silent_note([one.engine for one in study.variants]) if study.forces else ""
    for note in filter(None, (silent, left_out_note(study.scenes))):
        progress.print(note, markup=False, highlight=False, soft_wrap=True)
    laid, done = swept(study, request.folder, manner, command, progress)
    lengths = {(t.cell.scene.name, t.cell.dt_s * t.cell.steps): t.cell.scene for t in laid.tasks}
    notes = (shortened_note(scene, lasts_s) for (_, lasts_s), scene in lengths.items())
    for note in filter(None, dict.fromkeys(notes)):
        progress.print(note, markup=False, highlight=False, soft_wrap=True)
    show_sweep(console, request.folder, len(laid.tasks), done)
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
