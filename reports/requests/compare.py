"""`compare` and `check`: errors of a run against the closed form, without and with a verdict."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike
from typing import TYPE_CHECKING, cast

from rich.console import Console

from models.errors import CrankcheckError
from models.scene import Scene, driver
from reports.compare import compare as comparing
from reports.compare.errors import Error, ErrorKind, Errors, largest
from reports.judge.cell import Cell, Checked, check_run
from reports.judge.known import marked, read_known
from reports.judge.tolerance import check_names
from reports.output.console import grid, say, say_each
from reports.output.numbers import short
from reports.output.write import provenance
from reports.plan.requirements import given_of, refuse_giving_way, refuse_unfollowed
from reports.plan.steps import positive
from reports.protocol.length import SEGMENTS, GivenAs, Length, Planned
from reports.protocol.way import laid_out, way_of
from reports.quantities import QUANTITIES
from reports.requests import any_log, arguments, shown, solution
from reports.requests.any_log import LogLike, MapLike
from reports.requests.arguments import SceneLike
from reports.verify.advised import advised
from sim.engine import Drive, Run, SettingValue
from sim.registry import FIRST

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, eq=False, repr=False)
class Comparison(shown.Shown):
    """Errors of a run or a log against the closed form, for each quantity, body and source.

    ``source`` names the run or log.
    """

    scene: Scene
    source: str
    errors: Errors

    def worst(self, quantity: str) -> Error | None:
        """The largest error of a quantity as a pure number; None where there is none.

        Raises CrankcheckError for an unknown quantity.
        """
        return self.errors.worst(arguments.one_of(quantity, "quantity", QUANTITIES))

    def frame(self) -> pd.DataFrame:
        """Errors, a row per quantity, body, source and kind; ``unit`` is that of ``maximum``,
        ``rms`` and ``final``, and ``maximum_pure`` a multiple of the scene's own size and speed."""
        import pandas as pd

        from reports.judge.rows import error_row

        return pd.DataFrame([error_row(error) for error in self.errors.rows])

    def show(self, console: Console) -> None:
        show_errors(console, self.scene, self.source, self.errors)

    def _drawn(self) -> str:
        return solution.drawn(self.scene)


@arguments.told_at_the_call
def compare(
    scene: SceneLike,
    what: Run | LogLike,
    *,
    step_s: float | None = None,
    drive: str = "scene",
    map: MapLike = None,
    forces: bool = False,
    segments: int | None = None,
    springs: str | None = None,
) -> Comparison:
    """Compare a run, a motion or a log with the closed form.

    Parameters
    ----------
    scene : Scene, str or path
        A shipped name, the path of a scene file, or a scene.
    what : Run, Motion, path, DataFrame or Mapping
        A result of `run`, a motion, or a log: a file, a frame, or columns by name.
    step_s : float or None
        Of a log: the step of its solver [s]; with one, its places are differenced as well.
    drive : str
        Of a log: the motion of the closed form's driver, as in `judge`.
    map : path, Mapping or None
        Of a log: the meaning of its columns, as in `judge`.
    forces : bool
        Of a log: compare its columns of forces and torque as well. Forces of a run are compared
        where it logged them.
    segments, springs : int or None, str or None
        Of a log: the solver's model of elastic links, as in `run`.

    Raises
    ------
    CrankcheckError
        A log that can not be read or is of another scene; a run that logged nothing.
    """
    scene = arguments.scene_of(scene)
    check_names(scene)
    if isinstance(what, Run):
        options = any_log.LogOptions(
            step_s, drive, map, forces=forces, segments=segments, springs=springs
        )
        any_log.refuse_run(scene, what, options)
        errors = comparing.compare(_truth_of_run(scene, what).beside(what))
        if errors is None:
            raise CrankcheckError(
                f"the run of {scene.name} in {what.engine} logged nothing: {what.status}: "
                f"{what.reason}"
            )
        return Comparison(scene, f"{what.engine} {what.version}, profile {what.profile}", errors)
    from reports.logs.log_beside import beside_truth
    from reports.own_log.judged import without_times
    from reports.own_log.log_limits import LogRequest, log_kind

    chosen = any_log.drive_of(drive, forces=forces)
    log = any_log.log_of(scene, what, map, forces=forces)
    step = 0.0 if step_s is None else positive("--step", step_s, "seconds")
    given = given_of([scene], segments, springs)
    asked = LogRequest({}, step, chosen, (), given.segments, given.springs)
    log, truth, _ = log_kind(scene).truth(log, asked)
    errors = comparing.compare(beside_truth(log, truth, step_s=step))
    assert errors is not None
    return Comparison(scene, log.source, without_times(errors, log))


def _truth_of_run(scene: Scene, run: Run) -> comparing.Truth:
    scene = any_log.scene_of_run(scene, run)
    given = GivenAs(getattr(run, "segments", SEGMENTS), getattr(run, "springs", "plain"))
    way, planned = way_of(scene, run.drive), Planned(scene, run.dt_s, run.steps, given)
    way.refuse_made(planned)
    return way.truth(planned)


PARTS: Mapping[ErrorKind, str] = {
    "geometric": "geometry",
    "start": "at the start",
    "passage": "change points",
}
"""Special kinds of rows: at the logged angle of the crank, first samples, near change points."""


def show_errors(console: Console, scene: Scene, source: str, errors: Errors) -> None:
    """Print the worst body of each quantity, source and kind."""
    names = ("quantity", "", "worst body")
    numbers = ("largest\nerror", "of its\nscale", "at t\ns", f"driver\n{driver.driver_unit(scene)}")
    rows = (
        (
            worst.tolerance,
            PARTS.get(worst.kind, ""),
            f"{worst.body_kind} {worst.body}",
            f"{short(worst.maximum)} {worst.unit}",
            f"{short(worst.pure)} {QUANTITIES[worst.quantity].of(worst.body_kind).share}",
            f"{worst.time_of_maximum_s:.4g}".replace("nan", "-"),
            _driver(worst),
        )
        for worst in worst_rows(errors)
    )
    heads = (*names, *(f"{head}:" for head in numbers))
    console.print(grid(heads, rows, f"{scene.name}: {source}", gap=1, whole=names), "")
    say(console, errors.compared_with(), "dim")
    say_each(console, errors.notes, "yellow")


def _driver(error: Error) -> str:
    place = error.driver_at_maximum_rad
    return f"{place:.4g}" if error.driver_unit == "m" else f"{math.degrees(place):.1f}"


def worst_rows(errors: Errors) -> list[Error]:
    """The largest error of each quantity, source and kind, in the order of the quantities."""
    keys = dict.fromkeys((row.quantity, row.source, row.kind) for row in errors.rows)
    found = (
        largest(row for row in errors.rows if (row.quantity, row.source, row.kind) == key)
        for key in keys
    )
    order = list(QUANTITIES)
    return sorted((row for row in found if row), key=lambda row: order.index(row.quantity))


DRIVES = ("prescribed", "servo")


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class CellVerdict(shown.Shown, Checked):
    """Verdict on a scene in an engine.

    ``verdict`` is "within", "out", "known" or "unsupported"; ``findings`` are answers of all rules,
    ``failures`` those that make the verdict, and ``advice`` those worth knowing; ``errors`` are the
    numbers, ``limits`` their tolerances; ``facts`` says where they come from.
    """

    facts: Mapping[str, str]

    @property
    def scene(self) -> Scene:
        return self.cell.scene

    def frame(self) -> pd.DataFrame:
        """Table of errors: a row per quantity, body, source and kind, with the limit in force;
        ``unit`` is that of ``maximum``, ``rms`` and ``final``."""
        from reports.judge.rows import error_frame

        return error_frame([self])

    def show(self, console: Console) -> None:
        from reports.verify.table import show

        show(console, [self], self.facts)

    def _drawn(self) -> str:
        return solution.drawn(self.scene)


@arguments.told_at_the_call
def check(
    scene: arguments.SceneLike,
    engine: str = FIRST,
    profile: str = "tuned",
    *,
    steps_per_turn: float | None = None,
    dt_s: float | None = None,
    turns: float = 2.0,
    drive: str = "prescribed",
    settings: Mapping[str, SettingValue] | None = None,
    tolerance: Mapping[str, float] | None = None,
    converge: bool = True,
    forces: bool = False,
    segments: int | None = None,
    springs: str | None = None,
    known: str | PathLike[str] | None = None,
) -> CellVerdict:
    """Run a scene in an engine and compare it with the closed form, as `crankcheck verify` does.

    Parameters
    ----------
    scene, engine, profile, steps_per_turn, dt_s, turns, drive, settings, segments, springs
        As in `run`.
    tolerance : Mapping or None
        Largest errors by quantity, as pure numbers, such as ``{"angle": 1e-4}``, in place of the
        scene's or of the budget that follows from the step.
    converge : bool
        Run it at half and quarter step too, and report how the error changes.
    forces : bool
        Compare the reactions and the driving torque with kinetostatics as well.
    known : path or None
        A file of known failures, as of `crankcheck verify --known`; none are known without it.

    Raises
    ------
    CrankcheckError
        An invalid argument; a scene that can not follow its driver, or that passes a position where
        its motion is not determined.
    """
    scene = arguments.scene_of(scene)
    refuse_giving_way(scene, "`run` runs it, and `judge` judges that run")
    name, profile = arguments.engine_of(engine, profile, settings)
    driven = cast(Drive, arguments.one_of(drive, "--drive", DRIVES))
    limits = arguments.tolerances_of(tolerance, "tolerance")
    failing = [] if known is None else read_known(arguments.path_of(known, "known"), "known")
    bent = given_of([scene], segments, springs)
    refuse_unfollowed(scene)
    length = Length(dt_s, steps_per_turn, turns)
    dt_s, steps = laid_out(scene, length, bent, with_forces=arguments.is_true(forces, "forces"))
    cell = Cell(
        scene=scene,
        engine=name,
        profile=profile,
        dt_s=dt_s,
        steps=steps,
        drive=driven,
        tolerance=limits,
        converge=arguments.is_true(converge, "converge"),
        settings=arguments.settings_of(settings),
        with_forces=forces,
        segments=bent.segments,
        springs=bent.springs,
    )
    (checked,) = marked([advised(cell)], failing)
    return _with_facts(checked)


def verdict_of_run(scene: Scene, run: Run, tolerance: Mapping[str, float]) -> CellVerdict:
    """The verdict on an existing run, without runs at other steps."""
    check_names(scene)
    way_of(scene, run.drive).refuse_made(Planned(scene, run.dt_s, run.steps))
    cell = Cell(
        scene=scene,
        engine=run.engine,
        profile=run.profile,
        dt_s=run.dt_s,
        steps=run.steps,
        drive=run.drive,
        tolerance=tolerance,
        converge=False,
        settings=dict(run.asked),
        with_forces=run.with_forces,
        segments=getattr(run, "segments", SEGMENTS),
        springs=getattr(run, "springs", "plain"),
    )
    return _with_facts(check_run(cell, run), "target")


def _with_facts(checked: Checked, tolerance: str = "tolerance") -> CellVerdict:
    """The verdict, with facts of now and of these versions; ``tolerance`` names the argument."""
    engines = {checked.cell.engine: checked.version} if checked.version else {}
    return CellVerdict(**arguments.parts_in_python(checked, tolerance), facts=provenance(engines))
