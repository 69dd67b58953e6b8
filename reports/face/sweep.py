"""`sweep`: a grid of cells, kept in a folder."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from models.one_or_more import names_in
from reports.face.arguments import SceneLike, each_of, is_true, path_of
from reports.face.shown import Shown
from reports.face.told import told_at_the_call
from reports.plan.steps import positive

if TYPE_CHECKING:
    import pandas as pd
    from rich.console import Console

    from reports.sweep.running import Done

Values = float | int | str | Sequence[float | int | str]


@dataclass(frozen=True, eq=False, repr=False)
class Sweep(Shown):
    """Cells in a folder: so many were asked for, and ``done`` is what was run now."""

    folder: Path
    cells: int
    done: Done

    def frame(self) -> pd.DataFrame:
        """One row per cell of the folder, with its errors, verdict and cost."""
        from reports.store.reader import read_store

        return read_store(self.folder).cells

    @property
    def verdict(self) -> Literal["within", "out"]:
        """Whether all gated cells of the folder are within tolerance."""
        cells = self.frame()
        gated = cells[cells["gated"].astype(bool)]
        return "within" if bool((gated["verdict"] == "within").all()) else "out"

    def show(self, console: Console) -> None:
        from reports.face.sweep_text import show_sweep

        show_sweep(console, self.folder, self.cells, self.done)


@told_at_the_call
def sweep(
    scenes: SceneLike | Iterable[SceneLike],
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
) -> Sweep:
    """Run a grid of scenes, engines, settings and steps into a folder, as `crankcheck sweep`.

    Cells run in processes apart; what the folder has already is not run again.

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
        What a cell may take.
    timing : bool
        Time the cells afterwards.
    keep_trajectories : bool
        Keep the whole log of every cell.
    again : bool
        Run cells again that timed out or crashed.
    progress : bool
        Tell on standard error how far it is.
    forces : bool
        Compare reactions and torque as well, of engines that report them.
    free : bool
        Let the scenes go; those of free motion for ().
    dt_s : float or Iterable[float]
        Steps of free motion [s], which has no turns.
    duration_s : float or None
        Of free motion [s]; that of the scene for None.
    segments, springs : int or Iterable[int], str or Iterable[str]
        What elastic links are given to engines as, as of `run`; () for those of the study.

    Raises
    ------
    CrankcheckError
        What can be told of the arguments before running; a folder that is not to be written.
    """
    from reports.face.sweep_arguments import (
        command_of,
        manner_of,
        numbers_of,
        overrides_of,
        refuse_empty_lists,
        scene_names,
    )
    from reports.output.console import terminal
    from reports.plan.chosen_study import StudyChoice, chosen_study, study_engines
    from reports.plan.elastic import chosen_segments, chosen_springs
    from reports.plan.study import load_study
    from reports.sweep.whole import swept

    where = path_of(folder, "folder")
    chosen = {"scenes": scenes, "engines": engines, "profiles": profiles}
    refuse_empty_lists(chosen | {"steps_per_turn": steps_per_turn})
    manner = manner_of(
        limit_s, memory_gb, jobs, timing=timing, keep_trajectories=keep_trajectories, again=again
    )
    named = names_in(engines, "engines")
    told = load_study(None if study is None else path_of(study, "study"))
    with ExitStack() as kept:
        choice = StudyChoice(
            scene_names(scenes, kept),
            named,
            names_in(profiles, "profiles"),
            numbers_of(steps_per_turn, "--steps-per-turn"),
            None if turns is None else positive("--turns", turns, "turns of the driver"),
            overrides_of(settings, study_engines(told, named)),
            is_true(forces, "forces"),
            is_true(free, "free"),
            numbers_of(dt_s, "--dt", "seconds, such as 1e-3"),
            None if duration_s is None else positive("--duration", duration_s, "seconds"),
            [chosen_segments(count) for count in each_of(segments)],
            [chosen_springs(text) for text in names_in(springs, "springs")],
        )
        asked = chosen_study(told, choice, is_shipped=study is None)
        console = terminal(stderr=True)
        console.quiet = not is_true(progress, "progress")
        laid, done = swept(asked, where, manner, command_of(choice, where, study), console)
    return Sweep(where, len(laid.tasks), done)
