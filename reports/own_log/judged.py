"""Judge a user's own log: its content, against the closed form, within the requested limits."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path
from typing import Literal

import numpy as np

from models.errors import CrankcheckError, cut, few, harmless
from models.scene import Scene
from reports.causes.cause import Cause
from reports.compare.compare import Truth, compare
from reports.compare.errors import Error, Errors, largest
from reports.judge.cell import left_words
from reports.judge.known import Judged, Names
from reports.judge.rows import flat_error
from reports.judge.rules import RULES, judge
from reports.judge.rules.limits import LIMITS
from reports.judge.rules.reference import LEAST
from reports.judge.rules.rule import Evidence, Finding
from reports.judge.tolerance import Limit, refuse_forces_unasked
from reports.logs.channel import OwnLog, Reading
from reports.logs.kinds import UNITS
from reports.logs.log_beside import LogBeside, aside, beside_truth, lacking, readings_of
from reports.output.numbers import error_text
from reports.own_log import log_limits
from reports.own_log.drives import DriveFit, LogDrive, why_aside
from sim.engine import Placing

ITSELF = (
    "every reading is that of the reference to the last bit: it may have been compared with itself"
)
STEPPED = ("CC116", "CC118")
"""Rules that need a step; the others of `RULES` need none."""
NOT_OF_LOGS = ("CC110", "CC111", "CC115", "CC117")
"""Rules for runs: a log was not requested, is not run again, and may well be a closed form."""


@dataclass(frozen=True, kw_only=True)
class JudgedLog(Judged):
    """A log with its results. ``beside`` is the comparison, ``fit`` the fitted drive of its
    reference, if any. ``causes`` explain errors out of tolerance, and delays within it;
    ``not_judged`` are parts of the scene that the log lacks; ``notes`` are further facts."""

    log: OwnLog
    beside: LogBeside
    drive: LogDrive
    step_s: float
    fit: DriveFit | None = None
    causes: tuple[Cause, ...] = ()
    not_judged: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()

    @property
    def scene(self) -> Scene:
        return self.log.scene

    @property
    def truth_name(self) -> str:
        """The reference in words."""
        return log_limits.log_kind(self.scene).truth_name

    @property
    def names(self) -> Names:
        return self.scene.name, Path(self.log.source).name, "", self.drive

    @property
    def verdict(self) -> Literal["within", "out", "known"]:
        return "known" if self.is_known else "out" if self.failures else "within"


def judge_log(log: OwnLog, request: log_limits.LogRequest) -> JudgedLog:
    """Compare a log with the closed form, and judge it.

    Raises CrankcheckError for neither target nor step for the content of the log; a target of
    forces that are not judged; an invalid step; a name in ``require`` that the scene lacks; a drive
    that the log does not allow; a range in which the mechanism cannot move.
    """
    _refuse_step(log, request.step_s)
    required = [log_limits.required_name(log.scene, name) for name in request.require]
    if log.forces is None:
        refuse_forces_unasked("--require", (quantity for _, quantity, _ in required))
        refuse_forces_unasked("--target", request.target)
    log, truth, fit = log_limits.log_kind(log.scene).truth(log, request)
    beside = beside_truth(log, truth, step_s=request.step_s)
    errors = compare(beside)
    assert errors is not None
    errors = without_times(_of_what_is_held(errors, log), log)
    if not errors.rows:
        held = [each.channel.name for each in log.readings]
        held += [f"gap of {gap.of} (a gap is of a pin or a slider)" for gap in log.gaps]
        raise CrankcheckError(
            f"{log.source}: nothing in it is judged with --drive {request.drive}: it holds "
            f"{few(held, 6)}"
        )
    not_judged = lacking(log, beside)
    why = why_aside(request.drive, log.scene.driver.name)
    _refuse_aside(aside(log, not_judged), required, why, errors)
    absent = log_limits.absent_names(log.scene, required, not_judged, errors)
    chosen = log_limits.by_quantity(beside.scene, errors, request.target, request.step_s)
    log_limits.refuse_unjudged(log, beside, errors, chosen)
    departure = errors.departure
    evidence = Evidence(
        status="branch-changed" if departure else "ok",
        reason=left_words(departure) if departure else "",
        stopped_at_s=float(log.time_s[-1]),
        errors=errors,
        limits=chosen,
        placing=_placing(errors),
        absent=absent if required else None,
    )
    found, notes = _causes_and_notes(log, truth, fit, evidence, errors)
    return JudgedLog(
        **vars(evidence),
        log=log,
        beside=beside,
        drive=request.drive,
        step_s=request.step_s,
        fit=fit,
        findings=(*_findings(evidence, request), *log_limits.findings_of_ground(log, chosen)),
        causes=found,
        not_judged=not_judged,
        notes=(*errors.notes, *notes),
    )


def _causes_and_notes(
    log: OwnLog, truth: Truth, fit: DriveFit | None, evidence: Evidence, errors: Errors
) -> tuple[tuple[Cause, ...], tuple[str, ...]]:
    rows = [row for row in errors.rows if row.kind == "total"]
    itself = (ITSELF,) if rows and all(row.maximum == 0.0 for row in rows) else ()
    out = any(finding.level == "fail" for finding in judge(evidence, LIMITS))
    held = log_limits.HeldLog(log, truth, fit, evidence, errors, out)
    found, notes = log_limits.log_kind(log.scene).explained(held)
    return tuple(found), itself or tuple(notes)


def _placing(errors: Errors) -> Placing:
    """Return the origin of the positions of a log, for limits at its start: positions nearer than a
    step of an integrator leaves were solved for. Where links bend, positions have the pieces'
    error, and only pins show it: without these the start has the wider limit."""
    worst = largest(row for row in errors.rows if row.quantity in errors.of_links.shut)
    near = LEAST * errors.of_scene.step_rad**2
    return "integrated" if worst is not None and not worst.pure <= near else "solved"


def _findings(evidence: Evidence, request: log_limits.LogRequest) -> tuple[Finding, ...]:
    """Return the findings of the applicable rules; their cures are for engines, and left out."""
    left_out = NOT_OF_LOGS if request.step_s else (*NOT_OF_LOGS, *STEPPED)
    rules = [rule for id_, rule in RULES.items() if id_ not in left_out]
    return tuple(replace(finding, cure="") for finding in judge(evidence, rules))


def _refuse_aside(
    there: Sequence[str], required: Sequence[tuple[str, str, str]], why: str, judged: Errors
) -> None:
    """Refuse required quantities that are in the log, and that its drive leaves out."""
    bodies = {row.body for row in judged.rows}
    for (name, quantity, body), told in product(required, there):
        one, _, of = told.partition(" of ")
        if (quantity == one and body in ("", of)) or (not quantity and body == of not in bodies):
            has = told.replace("drive of", "angle of")
            raise CrankcheckError(f"--require {name}: the log has the {has}; {why}: leave it out")


def _refuse_step(log: OwnLog, step_s: float) -> None:
    if not (math.isfinite(step_s) and step_s >= 0.0):
        raise CrankcheckError(f"--step {step_s:g}: give a time above 0, in seconds")
    if step_s and not log.timed:
        raise CrankcheckError(
            f"--step {step_s:g}: {log.source} has no times, which a step needs; give --target"
        )
    shortest = float(np.min(np.diff(log.time_s)))
    if step_s > shortest * (1.0 + 1e-3) and step_s > 0.0:
        raise CrankcheckError(
            f"--step {step_s:g}: {log.source} has samples {shortest:.4g} s apart, and a step is no "
            "longer than that; give the step of the solver, in seconds"
        )


def _of_what_is_held(errors: Errors, log: OwnLog) -> Errors:
    """Return errors without the reference's uncertainty of quantities that the log lacks."""
    held = {(row.quantity, row.body) for row in errors.rows}
    held |= set(log.forces.columns) if log.forces else set()
    sure = {key: number for key, number in errors.uncertain.items() if key in held}
    return replace(errors, uncertain=sure)


def without_times(errors: Errors, log: OwnLog) -> Errors:
    """Return errors of a log without times: they are largest at an angle of the driver alone."""
    if log.timed:
        return errors
    rows = tuple(replace(row, time_of_maximum_s=math.nan) for row in errors.rows)
    return replace(errors, rows=rows)


LONGEST = 60
"""Number of characters of a column's name that are shown."""
KINDS = ("total", "start", "passage")
"""Kinds of errors that have limits."""


@dataclass(frozen=True)
class LogRow:
    """One error of a body: its ``columns`` in the log, and its ``limit`` [pure]. ``unit`` is that
    of the columns, and ``per_unit`` its size in SI."""

    columns: tuple[str, ...]
    what: str
    error: Error
    limit: Limit
    unit: str
    per_unit: float

    @property
    def size(self) -> str:
        """The largest error in the user's own unit."""
        return f"{error_text(self.error.maximum / self.per_unit)} {self.unit}"

    @property
    def is_aside(self) -> bool:
        """True if it is not of a whole column as logged."""
        return self.error.source != "reported" or self.error.kind != "total"

    @property
    def names(self) -> str:
        """The displayed names of the columns, - for none."""
        return ", ".join(map(column_text, self.columns)) or "-"

    @property
    def taken(self) -> float:
        """Its part of the limit; infinite where it is not finite."""
        if not math.isfinite(self.error.pure):
            return math.inf
        return self.error.pure / self.limit.number

    @property
    def verdict(self) -> Literal["within", "out"]:
        return "within" if self.taken <= 1.0 else "out"


def column_text(column: str) -> str:
    """Return the name of a column, short, and as text that is harmless to a terminal."""
    return cut(harmless(column[:LONGEST]), LONGEST)


def log_rows(judged: JudgedLog) -> list[LogRow]:
    """Return each error that has a limit, in the order of the quantities."""
    errors = judged.errors
    if errors is None:
        return []
    rows = []
    for error in errors.rows:
        if error.kind not in KINDS or error.tolerance not in judged.limits:
            continue
        limit = log_limits.limit_of(error, judged, errors)
        read = readings_of(judged.log, error) if error.source == "reported" else ()
        columns = tuple(each.channel.column for each in read)
        unit = _unit(read, error.unit)
        for gap in judged.log.gaps:
            if (error.quantity, error.body) == ("gap", gap.of):
                columns, unit = (gap.column,), (gap.unit, UNITS["length"][gap.unit])
        if judged.log.forces and (error.quantity, error.body) in judged.log.forces.columns:
            columns = judged.log.forces.columns[error.quantity, error.body]
        rows.append(LogRow(columns, _error_words(error), error, limit, *unit))
    return rows


def _unit(read: Sequence[Reading], otherwise: str) -> tuple[str, float]:
    """Return the unit of some columns, and its size in SI; SI where they have several."""
    channels = [each.channel for each in read]
    units = {each.unit for each in channels}
    if len(units) != 1:
        return otherwise, 1.0
    first = channels[0]
    return first.unit, UNITS[first.kind.dimension][first.unit]


def _error_words(error: Error) -> str:
    quantity = "angle" if error.quantity == "drive" else error.quantity
    driver = ", the driver" if error.body_kind == "driver" else ""
    differenced = ", differenced" if error.source == "differenced" else ""
    kind = {"start": ", at the start", "passage": ", near a change point"}.get(error.kind, "")
    return f"{quantity} of {error.body}{driver}{differenced}{kind}"


def row_table(judged: JudgedLog) -> list[dict[str, object]]:
    """Return the rows with unit suffixes in their names, for frames, CSV and JSON."""
    return [
        {
            "scene": judged.scene.name,
            "columns": " ".join(row.columns),
            **flat_error(
                row.error,
                limit_pure=row.limit.number,
                limit_origin=row.limit.origin,
                verdict=row.verdict,
            ),
        }
        for row in log_rows(judged)
    ]
