"""`crankcheck synth`: from the task of a mechanism to its scenes."""

from __future__ import annotations

import math
import re
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from rich.console import Console
from rich.progress import Progress

from analytic.lectures.synthesis.examine import Examined
from analytic.lectures.synthesis.sensitivity import monte_carlo, sensitivity
from analytic.lectures.synthesis.solutions import Solutions, solutions_of
from models.errors import CrankcheckError, shown
from models.files.faults import table_of
from models.lectures.shipped_tables import TaskTable
from models.lectures.tasks import KINDS, load_task, refuse_unknown, shipped_tasks
from models.scene import Scene
from reports.lectures.design import design_tables
from reports.lectures.design.proof import Met, by_reference, limit_of, proven
from reports.lectures.drawing.sheets.paper import Paper
from reports.output.console import grid, say
from reports.output.formats import csv
from reports.output.numbers import count
from reports.output.write import check_folder, provenance, write
from reports.plan.requirements import chosen_engines, chosen_profiles
from reports.requests.arguments import told_at_the_call
from reports.requests.options import Engines, PaperSize, argument, option
from reports.requests.shown import Shown
from sim.registry import engine

if TYPE_CHECKING:
    import pandas as pd


Proofs = Mapping[int, Sequence[Met]]
FRAME, PROOF, PAGE = "solutions.csv", "proof.csv", "index.html"
OURS = re.compile(r"(solution|construction)-\d+\.(toml|svg|html)|proof\.csv")
"""Pattern of the file names that belong to this command."""
USUAL = ("tuned",)
"""Default profiles of the proof."""
SAMPLES = 1000
"""Number of mechanisms of the Monte Carlo: two seconds."""


@dataclass(frozen=True)
class SynthRequest:
    """Arguments of `synth`, as given."""

    kind: Annotated[str | None, argument("KIND", "Kind of task; default: a list of kinds.")] = None
    task: Annotated[str | None, argument("TASK", "A shipped task, or a task file (.toml).")] = None
    output: Annotated[
        Path | None, option("Folder of scenes, tables, figures.", "-o --output DIR")
    ] = None
    best: Annotated[
        int, option("Number of solutions that are listed and written.", min=1, max=1000)
    ] = 5
    prove: Annotated[bool, "Run each in every engine, through the requested positions."] = False
    engines: Engines = ()
    profiles: Annotated[
        Sequence[str], option("Profile of the engines; default: tuned.", "--profile")
    ] = ()
    steps_per_turn: Annotated[float, option("Steps in a turn of the proof.", min=24, max=1e5)] = (
        720.0
    )
    vary_m: Annotated[
        float | None,
        option(
            "Effect of errors of dimensions up to so much, and of clearances.",
            "--vary METRES",
            min=1e-9,
            max=1e6,
        ),
    ] = None
    paper: PaperSize = "A4"

    def run(self, console: Console, progress: Console) -> int:
        """List, write and prove the solutions. Raises CrankcheckError for a faulty request."""
        if self.kind is None or self.task is None:
            return _list(self.kind, console)
        paper = Paper.of(self.paper)
        _check(self)
        if self.output is not None:
            check_folder(self.output, "-o")
        task = load_task(self.kind, self.task)
        engines = chosen_engines(self.engines) if self.prove else []
        profiles = [name for name, _ in chosen_profiles(self.profiles or USUAL, engines)]
        solutions = _searched(task, progress)
        listed = solutions.examined[: self.best]
        say(console, f"{task.name}: {task.source}")
        say(console, design_tables.counted(solutions, len(listed)))
        console.print("", design_tables.solution_table(listed), sep="\n")
        if self.vary_m is not None:
            _show_sensitivity(console, solutions, task, self.vary_m)
        proofs = {
            number: [
                *by_reference(one, task),
                *(
                    met
                    for name in engines
                    for profile in profiles
                    for met in proven(one, task, name, profile, self.steps_per_turn)
                ),
            ]
            for number, one in enumerate(listed, 1)
            if self.prove and not one.defects
        }
        facts = provenance({name: engine(name).version() for name in engines})
        if self.prove:
            _show_proof(console, proofs, facts, self)
        if self.output is not None:
            told = design_tables.counted(solutions, len(listed))
            _write(self.output, listed, task, told, proofs, facts, paper, console)
        met = all(one.within for every in proofs.values() for one in every)
        return 0 if solutions.sound and met else 1


def _check(request: SynthRequest) -> None:
    numbers = {"--steps-per-turn": request.steps_per_turn, "--vary": request.vary_m}
    for name, number in numbers.items():
        if number is not None and not math.isfinite(number):
            raise CrankcheckError(f"{name}: found {number}; give a number")
    given = {"--engine": request.engines, "--profile": request.profiles}
    for name, chosen in given.items():
        if chosen and not request.prove:
            raise CrankcheckError(f"{name} {chosen[0]}: engines are run by --prove; add it")


TOLD_S = 3.0
"""Time between two lines of progress where there is no terminal [s]."""


def _searched(task: TaskTable, progress: Console) -> Solutions:
    terminal, last = progress.is_terminal, time.monotonic()
    with Progress(console=progress, transient=True, disable=not terminal) as bar:
        line = bar.add_task("searching", total=1.0)

        def tell(share: float, best: float) -> None:
            nonlocal last
            near = f"searching, {best:.3g} m RMS" if math.isfinite(best) else "searching"
            bar.update(line, completed=share, description=near)
            if not terminal and time.monotonic() - last >= TOLD_S:
                last = time.monotonic()
                say(progress, f"{near}: {100.0 * share:.0f} %")

        return solutions_of(task, tell)


def _list(kind: str | None, console: Console) -> int:
    if kind is not None:
        refuse_unknown(kind)
    every = shipped_tasks().items()
    rows = ((name, ", ".join(tasks)) for name, tasks in every if kind in (None, name))
    console.print(grid(("kind", "shipped tasks"), rows))
    return 0


def _show_sensitivity(
    console: Console, solutions: Solutions, task: TaskTable, tolerance_m: float
) -> None:
    if not solutions.sound:
        say(console, "\nno sensitivity: no solution is without a defect")
        return
    best = solutions.sound[0]
    limits = [limit_of(one, best.scene, task) for p in best.positions for one in p.asked]
    try:
        slopes = sensitivity(best)
        spread = monte_carlo(best, tolerance_m, limits, SAMPLES)
    except CrankcheckError as error:
        say(console, f"\nno sensitivity: {error}")
        return
    table = design_tables.sensitivity_table(slopes, limits, tolerance_m, spread)
    console.print("", table, sep="\n")
    say(console, design_tables.clearance_in_words(slopes, limits, spread))


def _show_proof(
    console: Console, proofs: Proofs, facts: Mapping[str, str], request: SynthRequest
) -> None:
    if not proofs:
        say(console, "\nnothing to prove: no solution listed is without a defect")
        return
    console.print("", design_tables.proof_table(proofs), sep="\n")
    within = all(one.within for every in proofs.values() for one in every)
    verdict = "PROVEN: every position is met" if within else "NOT PROVEN: a position is missed"
    say(console, f"\n{verdict}")
    say(console, f"{request.steps_per_turn:g} steps a turn; " + ", ".join(
        f"{name} {value}" for name, value in facts.items()))  # fmt: skip


def _write(
    folder: Path,
    listed: Sequence[Examined],
    task: TaskTable,
    counted: str,
    proofs: Proofs,
    facts: Mapping[str, str],
    paper: Paper,
    console: Console,
) -> None:
    from reports.lectures.design.construction_sheet import construction_sheet
    from reports.lectures.design.pages import (
        construction_name,
        construction_page,
        scene_name,
        solutions_page,
        solutions_sheet,
    )

    texts: dict[str, str | bytes] = {
        scene_name(number): one.text for number, one in enumerate(listed, 1)
    }
    texts[FRAME] = csv(design_tables.solution_frame(listed))
    if proofs:
        texts[PROOF] = csv(design_tables.proof_frame(proofs))
    for number, one in enumerate(listed, 1):
        title = f"{one.scene.name}: construction"
        sheet = construction_sheet(one, paper)
        texts[construction_name(number, "svg")] = sheet.saved("svg", title)
        texts[construction_name(number, "html")] = construction_page(one)
    every = solutions_sheet(listed, task, paper)
    drawn = None if every is None else every.saved("svg", f"solutions of {task.name}")
    texts[PAGE] = solutions_page(listed, task, counted, drawn, proofs, facts)
    check_folder(folder, "-o", list(texts))
    left = sorted(
        path.name
        for path in folder.glob("*")
        if OURS.fullmatch(path.name) and path.name not in texts
    )
    for name, text in texts.items():
        write(folder / name, text)
    say(console, f"\n{folder / PAGE}: {count(len(listed), 'solution')}, with scenes, tables and "
         "constructions beside it")  # fmt: skip
    if left:
        say(console, f"left there by an earlier run: {', '.join(left)}")


LISTED = 5
"""Number of printed solutions."""
TaskLike = str | PathLike[str] | Mapping[str, object]


@dataclass(frozen=True, eq=False, repr=False)
class Synthesis(Shown):
    """The solutions of a task (`synth`), the best first.

    ``details`` has all facts of them: ``examined`` has for each its ``scene``, ``positions``,
    ``defects``, ``least_transmission_rad``, ``extent_m`` and the like.
    """

    details: Solutions

    @property
    def scenes(self) -> list[Scene]:
        """The scenes of the solutions without a defect, as arguments of every other function."""
        return [one.scene for one in self.details.sound]

    def frame(self) -> pd.DataFrame:
        """Table of solutions, a row each, including those with a defect."""
        return design_tables.solution_frame(self.details.examined)

    def proof(self, engine: str, profile: str = "tuned", *, best: int = 1) -> pd.DataFrame:
        """Prove the best sound solutions in an engine: a row for each requirement at each position.

        Raises
        ------
        EngineError
            An unknown engine or profile, or a missing package.
        """
        found = enumerate(self.details.examined, 1)
        sound = [(number, one) for number, one in found if not one.defects][:best]
        return design_tables.proof_frame(
            {number: proven(one, self.details.task, engine, profile) for number, one in sound}
        )

    def show(self, console: Console) -> None:
        listed = self.details.examined[:LISTED]
        say(console, design_tables.counted(self.details, len(listed)))
        console.print("", design_tables.solution_table(listed), sep="\n")


@told_at_the_call
def synth(kind: str, task: TaskLike) -> Synthesis:
    """Find the mechanisms that do a task.

    Parameters
    ----------
    kind : str
        coupler, rocker, stroke, quick-return, function, path or straight-line.
    task : str, path or mapping
        A shipped task by its name, a task file, or its tables.

    Raises
    ------
    CrankcheckError
        Another kind, no such task, or a task that no mechanism does; the message suggests a remedy.
    SceneError
        A task with faults, all in one message.
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
