"""`sweep`: a grid of cells, kept in a folder, each timed afterwards."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from rich.console import Console

from models.errors import CrankcheckError, shown
from models.files.inputs import names_in
from reports.output.console import say_whole
from reports.plan.chosen_study import StudyChoice, chosen_study, refuse_other_engine, study_engines
from reports.plan.requirements import chosen_segments, chosen_springs, left_out_note
from reports.plan.singular import silent_note
from reports.plan.steps import positive
from reports.plan.study import Study, StudyValue, load_study
from reports.protocol.way import way_of
from reports.requests import arguments, options, sweep_arguments
from reports.requests.options import argument, option, output_option
from reports.requests.shown import Shown
from reports.workers.isolated import checked_limits
from sim.registry import FIRST

if TYPE_CHECKING:
    import pandas as pd

    from reports.sweep.running import Done


Values = float | int | str | Sequence[float | int | str]


@dataclass(frozen=True, eq=False, repr=False)
class Sweep(Shown):
    """Cells in a folder: ``cells`` were requested, ``done`` is the work of this call."""

    folder: Path
    cells: int
    done: Done

    def frame(self) -> pd.DataFrame:
        """Table of cells, a row per cell of the folder, with its errors, verdict and cost."""
        from reports.store.reader import read_store

        return read_store(self.folder).cells

    @property
    def verdict(self) -> Literal["within", "out"]:
        """Verdict: "within" where all gated cells of the folder are within tolerance."""
        cells = self.frame()
        gated = cells[cells["gated"].astype(bool)]
        return "within" if bool((gated["verdict"] == "within").all()) else "out"

    def show(self, console: Console) -> None:
        from reports.sweep.running import show_sweep

        show_sweep(console, self.folder, self.cells, self.done)


@arguments.told_at_the_call
def sweep(
    scenes: arguments.SceneLike | Iterable[arguments.SceneLike],
    folder: str | PathLike[str],
    *,
    study: str | PathLike[str] | None = None,
    engines: str | Iterable[str] = (),
    profiles: str | Iterable[str] = (),
    steps_per_turn: float | Iterable[float] = (),
    turns: float | None = None,
    settings: Mapping[str, Values] | None = None,
    jobs: int = 0,
    limit_s: float = 60.0,
    memory_gb: float = 2.0,
    timing: bool = True,
    keep_trajectories: bool = False,
    again: bool = False,
    progress: bool = False,
    forces: bool = False,
    free: bool = False,
    dt_s: float | Iterable[float] = (),
    duration_s: float | None = None,
    segments: int | Iterable[int] = (),
    springs: str | Iterable[str] = (),
    facets: int | Iterable[int] = (),
) -> Sweep:
    """Run a grid of scenes, engines, settings and steps into a folder, as `crankcheck sweep` does.

    Cells run in separate processes; cells that the folder holds are not run again.

    Parameters
    ----------
    scenes : Scene, str, path or Iterable of them
        Shipped names, paths of scene files, or scenes; () for those of the study.
    folder : str or path
        Where the cells are kept.
    study : str, path or None
        A study file (.toml, .yaml); the shipped one for None.
    engines, profiles : str or Iterable[str]
        In place of the study's; () leaves them.
    steps_per_turn : float or Iterable[float]
        In place of the study's; () leaves them.
    turns : float or None
        Turns of the driver; those of the study for None.
    settings : Mapping or None
        One value, or several, by engine and setting: ``{"mujoco.iterations": [2, 10]}``.
    jobs : int
        Processes; 0 for one per processor.
    limit_s, memory_gb : float
        Limits of time and memory of a cell.
    timing : bool
        Time the cells afterwards.
    keep_trajectories : bool
        Keep the whole log of every cell.
    again : bool
        Run cells again that timed out or crashed.
    progress : bool
        Show the progress on standard error.
    forces : bool
        Compare reactions and torque as well, of engines that report them.
    free : bool
        Release the scenes; () takes those of free motion.
    dt_s : float or Iterable[float]
        Steps of free motion [s], which has no turns.
    duration_s : float or None
        Duration of free motion [s]; the scene's for None.
    segments, springs : int or Iterable[int], str or Iterable[str]
        Engines' model of elastic links, as in `run`; () for those of the study.
    facets : int or Iterable[int]
        Cams by contact, of so many facets; () for those of the study, or as the scenes say.

    Raises
    ------
    CrankcheckError
        Faults of the arguments, before anything runs; a folder that can not be written.
    """
    from reports.output.console import terminal
    from reports.sweep.running import swept

    where = arguments.path_of(folder, "folder")
    chosen = {"scenes": scenes, "engines": engines, "profiles": profiles}
    sweep_arguments.refuse_empty_lists(chosen | {"steps_per_turn": steps_per_turn})
    manner = sweep_arguments.manner_of(
        limit_s, memory_gb, jobs, timing=timing, keep_trajectories=keep_trajectories, again=again
    )
    named = names_in(engines, "engines")
    told = load_study(None if study is None else arguments.path_of(study, "study"))
    with ExitStack() as kept:
        choice = StudyChoice(
            sweep_arguments.scene_names(scenes, kept),
            named,
            names_in(profiles, "profiles"),
            sweep_arguments.numbers_of(steps_per_turn, "--steps-per-turn"),
            None if turns is None else positive("--turns", turns, "turns of the driver"),
            sweep_arguments.overrides_of(settings, study_engines(told, named)),
            arguments.is_true(forces, "forces"),
            arguments.is_true(free, "free"),
            sweep_arguments.numbers_of(dt_s, "--dt", "seconds, such as 1e-3"),
            None if duration_s is None else positive("--duration", duration_s, "seconds"),
            [chosen_segments(count) for count in arguments.each_of(segments)],
            [chosen_springs(text) for text in names_in(springs, "springs")],
            [arguments.whole_of(count, "--facets") for count in arguments.each_of(facets)],
        )
        asked = chosen_study(told, choice, is_shipped=study is None)
        console = terminal(stderr=True)
        console.quiet = not arguments.is_true(progress, "progress")
        laid, done = swept(asked, where, manner, choice.command(where, study), console)
    return Sweep(where, len(laid.tasks), done)


@dataclass(frozen=True)
class SweepRequest:
    folder: Annotated[Path, output_option("Folder for the results.")]
    scenes: Annotated[
        Sequence[str],
        argument("SCENE", "Shipped names or scene files; default: the study's."),
    ] = ()
    study: Annotated[Path | None, "Study file (.toml, .yaml); the shipped one if none."] = None
    engines: options.Engines = ()
    profiles: Annotated[
        Sequence[str], option("Profile, in place of the study's variants.", "--profile")
    ] = ()
    steps_per_turn: Annotated[str | None, option("Steps in a turn, with commas.", "N,N,...")] = None
    turns: Annotated[float | None, "Turns of the driver."] = None
    settings: Annotated[
        Sequence[str], option("One variant per value.", "--set ENGINE.SETTING=A,B")
    ] = ()
    limit_s: Annotated[float, "Longest time for a cell, in seconds."] = 60.0
    memory_gb: Annotated[float, "Most memory for a cell, in GB."] = 2.0
    jobs: options.Jobs = 0
    dask: Annotated[str | None, option("Run on the cluster of this scheduler.", "ADDRESS")] = None
    timing: Annotated[bool, "Time the cells after the error runs."] = True
    keep_trajectories: Annotated[bool, "Keep the whole motion of every cell."] = False
    again: Annotated[bool, "Run cells again that timed out or crashed."] = False
    forces: options.Forces = False
    free: Annotated[bool, "Free motion; default: all free scenes."] = False
    dt_s: Annotated[str | None, option("Steps of free motion, seconds.", "--dt S,S,...")] = None
    duration_s: options.Duration = None
    segments: Annotated[
        str | None, option("Segments of each elastic link, with commas (default 16).", "N,N,...")
    ] = None
    springs: options.SpringKind = None
    facets: Annotated[
        str | None, option("Cams by contact, with so many facets, with commas.", "N,N,...")
    ] = None

    def run(self, console: Console, progress: Console) -> int:
        """Run the cells of the study that are not done yet; return the exit code, 0.

        A cell that failed is a row with its status and reason, and no failure of the sweep. Damage
        to the store is repaired and reported. Raises CrankcheckError for a faulty request.
        """
        from reports.sweep.running import Manner, show_sweep, swept

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
            say_whole(progress, note)
        laid, done = swept(study, self.folder, manner, command, progress)
        lengths = {
            (t.cell.scene.name, t.cell.dt_s * t.cell.steps): t.cell.scene for t in laid.tasks
        }
        notes = (way_of(scene).shortened(scene, lasts_s) for (_, lasts_s), scene in lengths.items())
        for note in filter(None, dict.fromkeys(notes)):
            say_whole(progress, note)
        show_sweep(console, self.folder, len(laid.tasks), done)
        return 0


def asked(request: SweepRequest) -> Study:
    """The study of the file, or the shipped one, with options of the command line in its place."""
    study = load_study(request.study)
    engines = study_engines(study, request.engines)
    choice = StudyChoice(
        request.scenes,
        request.engines,
        request.profiles,
        options.numbers("--steps-per-turn", request.steps_per_turn, float, "numbers", "90,180,360"),
        request.turns,
        _overrides(request.settings, engines),
        request.forces,
        request.free,
        options.numbers("--dt", request.dt_s, float, "numbers", "2e-3,1e-3"),
        request.duration_s,
        options.numbers("--segments", request.segments, _segments, "whole numbers", "4,8,16"),
        [
            chosen_springs(each.strip())
            for each in (request.springs or "").split(",")
            if each.strip()
        ],
        options.numbers("--facets", request.facets, int, "whole numbers", "90,360,1440"),
    )
    return chosen_study(study, choice, is_shipped=request.study is None)


def _overrides(
    texts: Sequence[str], engines: Sequence[str]
) -> dict[str, dict[str, StudyValue | list[StudyValue]]]:
    """Parse `ENGINE.iterations=2,10` and the like, by engine."""
    overrides: dict[str, dict[str, StudyValue | list[StudyValue]]] = {}
    for text in texts:
        name, equals, values = text.partition("=")
        owner, dot, setting = name.strip().partition(".")
        if not (equals and dot and values.strip()):
            raise CrankcheckError(
                f"--set {shown(text)}: write it like --set {FIRST}.iterations=2,10: "
                "engine.setting=values"
            )
        refuse_other_engine(owner, engines, f"--set {shown(text)}")
        several: list[StudyValue] = [value.strip() for value in values.split(",")]
        overrides.setdefault(owner, {})[setting.strip()] = several
    return overrides


def _segments(text: str) -> int:
    return chosen_segments(int(text))
