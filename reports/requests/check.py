"""`check`: a scene in an engine, run, compared and judged."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

from models.scene import Scene
from reports.judge.cell import Cell, Checked, check_run
from reports.judge.tolerance import check_names
from reports.output.write import provenance
from reports.plan.chosen import refuse_unfollowed
from reports.plan.requirements import given_of, refuse_giving_way
from reports.protocol.length import SEGMENTS, Length, Planned
from reports.protocol.way import laid_out, way_of
from reports.requests import arguments
from reports.requests.shown import Shown
from reports.requests.solution import drawn
from reports.verify.advised import advised
from sim.engine import Drive, Run, SettingValue
from sim.registry import FIRST

if TYPE_CHECKING:
    import pandas as pd
    from rich.console import Console

DRIVES = ("prescribed", "servo")


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class CellVerdict(Shown, Checked):
    """Verdict on a scene in an engine.

    ``verdict`` is "within", "out" or "unsupported"; ``findings`` are the answers of all rules,
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
        return drawn(self.scene)


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
    return _with_facts(advised(cell))


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
