"""One cell of a verification: scene x engine x profile x step; run it, compare it, judge it."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal

from models.errors import CrankcheckError, EngineError
from models.motion import State
from models.scene import Same, Scene
from reports.compare.asked import not_asked_for
from reports.compare.beside import Beside, truth_of
from reports.compare.compare import compare
from reports.compare.errors import Departure
from reports.judge.halving import followed
from reports.judge.rules import judge
from reports.judge.rules.rule import Evidence, Finding
from reports.judge.tolerance import limits
from sim.engine import Drive, Run, SettingValue
from sim.registry import engine
from sim.run import run, setup

CellRunner = Callable[..., Run]
"""What runs a cell: it takes what `sim.run.run` takes."""


@dataclass(frozen=True)
class Cell:
    """What to run: ``steps`` of ``dt_s`` from the scene's start; a cell that is not ``gated`` is
    shown and judged, and does not count for the exit code. ``settings`` override the profile."""

    scene: Scene
    engine: str
    profile: str
    dt_s: float
    steps: int
    gated: bool = True
    drive: Drive = "prescribed"
    tolerance: Mapping[str, float] = field(default_factory=dict)
    converge: bool = True
    settings: Mapping[str, SettingValue] = field(default_factory=dict)

    @property
    def turns(self) -> float:
        return self.steps * self.dt_s / self.scene.driver.law.period_s

    @property
    def steps_per_turn(self) -> float:
        return self.scene.driver.law.period_s / self.dt_s

    @property
    def label(self) -> str:
        return f"{self.scene.name}, {self.engine}, {self.profile}"

    @property
    def named(self) -> tuple[str, str]:
        """Engine and profile."""
        return self.engine, self.profile

    def options(self, finer: int) -> dict[str, Any]:
        """What a run takes, with the step cut into ``finer`` parts, logged at the same instants."""
        return {
            "dt_s": self.dt_s / finer,
            "steps": self.steps * finer,
            "every": finer,
            "drive": self.drive,
            "settings": self.settings,
        }


@dataclass(frozen=True, kw_only=True)
class Checked(Evidence):
    """A cell with what came of it, and the time that it took [s]; the trajectories are gone."""

    cell: Cell
    version: str = ""
    settings: Mapping[str, SettingValue] = field(default_factory=dict)
    findings: tuple[Finding, ...]
    warnings: tuple[str, ...] = ()
    wall_s: float = 0.0

    @property
    def failures(self) -> tuple[Finding, ...]:
        return tuple(finding for finding in self.findings if finding.level == "fail")

    @property
    def advice(self) -> tuple[Finding, ...]:
        return tuple(finding for finding in self.findings if finding.level == "advice")

    @property
    def verdict(self) -> Literal["within", "out", "unsupported"]:
        if self.status == "unsupported":
            return "unsupported"
        return "out" if self.failures else "within"


def check(cell: Cell) -> Checked:
    """Run a cell at its step (and at half and a quarter of it), compare and judge it."""
    return examined(cell)[0]


def examined(cell: Cell, runner: CellRunner | None = None) -> tuple[Checked, Run | None]:
    """As `check`, and the run at the full step, None where there is none.

    ``runner`` takes the place of `sim.run.run`: with a fault in it, that is seen or is not.
    """
    began = time.perf_counter()
    found, done = _examined(cell, runner or run)
    return replace(found, wall_s=time.perf_counter() - began), done


def _examined(cell: Cell, runner: CellRunner) -> tuple[Checked, Run | None]:
    """As `examined`, but for the time."""
    truth = truth_of(Same(cell.scene))  # before the run: the truth of another scene is let go
    try:
        state = truth.start
        adapter = engine(cell.engine)
        done = runner(cell.scene, state, *cell.named, **cell.options(1))
    except EngineError as error:
        return unfinished(cell, "unsupported", str(error)), None
    except CrankcheckError as error:
        return unfinished(cell, "crashed", f"no reference at the start: {error}"), None
    try:
        errors = compare(Beside.of(truth, done))
    except CrankcheckError as error:
        why = f"the run has no reference to compare with: {error}"
        return unfinished(cell, "crashed", why), done
    status, reason = done.status, done.reason
    if status == "ok" and errors and errors.departure:
        status, reason = "branch-changed", _left(errors.departure)
    in_force = limits(cell.scene, errors, cell.tolerance) if errors else {}
    unasked = _unasked(cell, state, 1, done)
    seen = None
    if cell.converge and errors:

        def rerun(finer: int) -> Run:
            again = runner(cell.scene, state, *cell.named, **cell.options(finer))
            unasked.extend(_unasked(cell, state, finer, again))
            return again

        seen = followed(
            truth, cell.dt_s, errors, cell.tolerance, rerun, adapter.placing, adapter.order
        )
    evidence = Evidence(
        status=status,
        reason=reason,
        stopped_at_s=done.stopped_at_s,
        errors=errors,
        limits=in_force,
        convergence=seen,
        gated=cell.gated,
        profile=cell.profile,
        placing=adapter.placing,
        order=adapter.order,
        unasked=tuple(unasked),
    )
    checked = Checked(
        **vars(evidence),
        cell=cell,
        version=done.version,
        settings=dict(done.settings),
        findings=judge(evidence),
        warnings=done.warnings,
    )
    return checked, done


def _unasked(cell: Cell, state: State, finer: int, done: Run) -> list[str]:
    """What a run, with the step cut into ``finer`` parts, says of itself that was not asked for."""
    asked = setup(cell.scene, state, *cell.named, **cell.options(finer))
    held = engine(cell.engine).holds(asked.asked, asked.dt_s, asked.drive)
    at = f"finer run, dt / {finer}: " if finer > 1 else ""
    return [at + text for text in not_asked_for(done, asked, held, cell.scene, state)]


def _left(departure: Departure) -> str:
    """A departure in words."""
    return (
        f"{departure.link} left its branch at driver {math.degrees(departure.driver_rad):.1f} deg, "
        f"t = {departure.time_s:.4g} s, and moves on in the other assembly of the closed loop"
    )


def unfinished(cell: Cell, status: str, reason: str) -> Checked:
    """A cell that has no run: a row with a reason."""
    evidence = Evidence(status, reason, 0.0, None, {})
    return Checked(**vars(evidence), cell=cell, findings=judge(evidence))
