"""One cell of a verification: scene x engine x profile x step; run it, compare it, judge it."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from analytic.kinematics import solve
from models.errors import CrankcheckError, EngineError
from models.motion import State
from models.scene import Scene
from reports.compare import compare, places
from reports.convergence import AT_ROUNDING, Convergence, convergence
from reports.errors import Departure, Error, Errors, Quantity, largest
from reports.rules import judge
from reports.rules.base import Evidence, Finding
from reports.stamps import incomplete
from reports.tolerance import Limit, limits
from sim.engine import Drive, Run, SettingValue
from sim.run import run

PLACES: tuple[Quantity, ...] = ("angle", "displacement", "position")
CLOSED: tuple[Quantity, ...] = (*PLACES, "gap")
HALVINGS = 2
EXACT_DRIVE = 1e-9
"""A drive error [rad] up to which the crank is where it should be, but for rounding."""
BEHIND_DRIVE = 5.0
"""How far behind the rounding of the crank that of the other links may be."""


@dataclass(frozen=True)
class Cell:
    """What to run: ``steps`` of ``dt_s`` from the scene's start; a cell that is not ``gated`` is
    shown and judged, and does not count for the exit code."""

    scene: Scene
    engine: str
    profile: str
    dt_s: float
    steps: int
    gated: bool = True
    drive: Drive = "prescribed"
    tolerance: Mapping[str, float] = field(default_factory=dict)
    converge: bool = True

    @property
    def turns(self) -> float:
        return self.steps * self.dt_s / self.scene.driver.law.period_s

    @property
    def steps_per_turn(self) -> float:
        return self.scene.driver.law.period_s / self.dt_s

    @property
    def label(self) -> str:
        return f"{self.scene.name}, {self.engine}, {self.profile}"


@dataclass(frozen=True)
class Checked:
    """A cell with what came of it, and the time that it took [s]; the trajectories are gone."""

    cell: Cell
    version: str
    status: str
    reason: str
    stopped_at_s: float
    settings: Mapping[str, SettingValue]
    errors: Errors | None
    limits: Mapping[str, Limit]
    convergence: Convergence | None
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
    began = time.perf_counter()
    found = _checked(cell)
    return replace(found, wall_s=time.perf_counter() - began)


def _checked(cell: Cell) -> Checked:
    """As `check`, but for the time."""
    try:
        state = solve(cell.scene, np.zeros(1)).state()
        done = _run(cell, state, 1)
    except EngineError as error:
        return unfinished(cell, "unsupported", str(error))
    except CrankcheckError as error:
        return unfinished(cell, "crashed", f"no reference at the start: {error}")
    try:
        errors = compare(cell.scene, done)
    except CrankcheckError as error:
        return unfinished(cell, "crashed", f"the run has no reference to compare with: {error}")
    status, reason = done.status, done.reason
    if status == "ok" and errors and errors.departure:
        status, reason = "branch-changed", _left(errors.departure)
    in_force = limits(cell.scene, errors, cell.tolerance) if errors else {}
    seen = _convergence(cell, state, errors) if cell.converge and errors else None
    evidence = Evidence(
        status=status,
        reason=reason,
        stopped_at_s=done.stopped_at_s,
        errors=errors,
        limits=in_force,
        convergence=seen,
        gated=cell.gated,
        profile=cell.profile,
        mass_ratio=_mass_ratio(cell.scene),
    )
    return Checked(
        cell=cell,
        version=done.version,
        status=status,
        reason=reason,
        stopped_at_s=done.stopped_at_s,
        settings=dict(done.settings),
        errors=errors,
        limits=in_force,
        convergence=seen,
        findings=judge(evidence),
        warnings=done.warnings,
    )


def _mass_ratio(scene: Scene) -> float:
    """The mass of the heaviest body over that of the lightest that has one."""
    masses = [link.mass_kg for link in scene.links.values()]
    masses += [slider.mass_kg for slider in scene.sliders.values()]
    given = [mass for mass in masses if mass > 0.0]
    return max(given, default=1.0) / min(given, default=1.0)


def _left(departure: Departure) -> str:
    """A departure in words."""
    return (
        f"{departure.link} left its branch at driver {math.degrees(departure.driver_rad):.1f} deg, "
        f"t = {departure.time_s:.4g} s, and moves on in the other assembly of the closed loop"
    )


def unfinished(cell: Cell, status: str, reason: str) -> Checked:
    """A cell that has no run: a row with a reason."""
    findings = judge(Evidence(status, reason, 0.0, None, {}))
    return Checked(cell, "", status, reason, 0.0, {}, None, {}, None, findings)


def _run(cell: Cell, state: State, finer: int) -> Run:
    """The cell with its step cut into ``finer`` parts, logged at the same instants."""
    return run(
        cell.scene,
        state,
        cell.engine,
        cell.profile,
        dt_s=cell.dt_s / finer,
        steps=cell.steps * finer,
        every=finer,
        drive=cell.drive,
    )


def _convergence(cell: Cell, state: State, errors: Errors) -> Convergence | None:
    """The largest error of place at the step, its half and its quarter.

    The quantity that is worst at the full step is followed, at the same instants throughout.
    """
    worst = _worst_place(errors)
    if worst is None:
        return None
    parts = [2**halving for halving in range(HALVINGS + 1)]
    finer = [_finer(cell, state, p) for p in parts[1:]]
    same = [largest(row for row in rows if row.quantity == worst.quantity) for rows, _ in finer]
    every_row = [*errors.rows, *(row for rows, _ in finer for row in rows)]
    rounding = _rounding(largest(row for row in every_row if row.quantity == "drive"))
    return convergence(
        [cell.dt_s / p for p in parts],
        [worst.pure, *(row.pure if row else math.nan for row in same)],
        "rad" if worst.unit == "rad" else "of the longest link",
        rounding,
        faults=[fault for _, fault in finer if fault],
        over=[
            text
            for p, (rows, _) in zip(parts[1:], finer, strict=True)
            if (text := _over(cell, errors, p, rows, rounding))
        ],
    )


def _finer(cell: Cell, state: State, parts: int) -> tuple[list[Error], str]:
    """Errors of place and gaps of a finer run, and how it did not end well: "" where it did."""
    at = f"at dt {cell.dt_s / parts:.3g} s"
    try:
        done = _run(cell, state, parts)
        rows = places(cell.scene, done)
    except CrankcheckError as error:
        return [], f"{at} there is nothing to compare: {error}"
    if done.status != "ok":
        return rows, f"{at} {done.status} at t = {done.stopped_at_s:.4g} s: {done.reason}"
    short = incomplete(done)
    return rows, f"{at} {short}" if short else ""


def _over(cell: Cell, errors: Errors, parts: int, rows: list[Error], rounding: float) -> str:
    """Which errors of a finer run are over the limits of its step, the worst of each quantity.

    What is over its limit at the full step fails its own rule, and is not told again.
    """
    before = limits(cell.scene, errors, cell.tolerance)
    in_force = limits(cell.scene, replace(errors, step_rad=errors.step_rad / parts), cell.tolerance)
    texts = []
    for name in CLOSED:
        full, fine = errors.worst(name), largest(row for row in rows if row.quantity == name)
        if full is None or fine is None or not full.pure <= before[name].number:
            continue
        limit = in_force[name].number
        if not fine.pure <= max(limit, rounding):
            texts.append(f"{name} of {fine.body} {fine.pure:.2g}, limit {limit:.2g}")
    return f"at dt {cell.dt_s / parts:.3g} s {'; '.join(texts)}" if texts else ""


def _rounding(drive: Error | None) -> float:
    """The error of place that rounding explains: a prescribed crank is off by nothing else."""
    seen = drive.pure if drive is not None and drive.pure <= EXACT_DRIVE else 0.0
    return max(AT_ROUNDING, BEHIND_DRIVE * seen)


def _worst_place(errors: Errors) -> Error | None:
    """The largest total error of angle, displacement or position, as pure numbers."""
    return largest(row for row in errors.rows if row.quantity in PLACES and row.kind == "total")
