"""The limits of the errors of a user's own log, and its required content."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol, cast

import numpy as np

from models.errors import CrankcheckError, cut, few, listed, shown, suggestion
from models.scene import Scene
from reports.causes.cause import Cause
from reports.compare.compare import Truth
from reports.compare.errors import Error, Errors
from reports.judge.rules.limits import LIMITS, start_limit
from reports.judge.rules.rule import Evidence, Finding
from reports.judge.tolerance import Limit, in_passage, limits
from reports.logs.channel import OwnLog
from reports.logs.force_columns import A_FORCE
from reports.logs.kinds import si
from reports.logs.log_beside import LogBeside, readings_of
from reports.own_log.drives import DriveFit, LogDrive
from reports.protocol.length import SEGMENTS, Springs
from reports.protocol.way import way_of
from reports.quantities import QUANTITIES


@dataclass(frozen=True)
class LogRequest:
    """Request to judge a log: pure numbers by quantity (`EVERY` for all others), or the step [s]
    for a budget; the required content; and the form of its elastic links."""

    target: Mapping[str, float] = field(default_factory=dict)
    step_s: float = 0.0
    drive: LogDrive = "scene"
    require: Sequence[str] = ()
    segments: int = SEGMENTS
    springs: Springs = "plain"


@dataclass(frozen=True)
class HeldLog:
    """A log with its reference, and the fitted drive; ``out`` is True if it is out of tolerance."""

    log: OwnLog
    truth: Truth
    fit: DriveFit | None
    evidence: Evidence
    errors: Errors
    out: bool


class LogKind(Protocol):
    """Way to judge logs of a kind of scene."""

    truth_name: str
    no_cause: str
    """Sentence about columns, at {}, that are out of tolerance without a cause."""
    driver_angle: str
    """The quantity for which the angle of the driven link is judged."""

    def truth(self, log: OwnLog, request: LogRequest) -> tuple[OwnLog, Truth, DriveFit | None]:
        """Return the log as far as its reference is known, the reference, and the fitted drive.
        Raises CrankcheckError."""
        ...

    def explained(self, held: HeldLog) -> tuple[Sequence[Cause], Sequence[str]]:
        """Return the causes of errors out of tolerance or delays, and further notes."""
        ...


def log_kind(scene: Scene) -> LogKind:
    """Return the kind of the scene."""
    return cast(LogKind, way_of(scene).part("log"))


EVERY = "all"
"""Key of a target for all quantities."""


def by_quantity(
    scene: Scene, errors: Errors, target: Mapping[str, float], step_s: float
) -> dict[str, Limit]:
    """Return the limit of each judged quantity, by target or by a step [s], 0 for none; infinite
    for others. Raises CrankcheckError for neither."""
    target, numbers = dict(target), errors.limits
    every = target.pop(EVERY, None)
    if every is not None:
        target = {name: target.get(name, every) for name in numbers}
    if step_s:
        return limits(scene, errors, target, "--target")
    judged = dict.fromkeys(row.tolerance for row in errors.rows if row.tolerance in numbers)
    told = {**{n: Limit(x, "scene") for n, x in scene.tolerance.items()},
            **{n: Limit(x, "--target") for n, x in target.items()}}  # fmt: skip
    lacking_ = [name for name in judged if name not in told]
    if lacking_:
        raise CrankcheckError(
            f"no limit for {', '.join(lacking_)}: the step of the log is unknown, so no budget "
            "follows from it; give --target 1e-3 (or one each, such as --target angle=1e-3), "
            "or --step with the step of the solver in seconds"
        )
    return {name: told.get(name, Limit(math.inf, "none")) for name in numbers}


def limit_of(error: Error, evidence: Evidence, errors: Errors) -> Limit:
    """Return the limit of an error of a log: separate at the start, and near change points."""
    limit = evidence.limits[error.tolerance]
    if error.kind == "passage":
        return in_passage(error.tolerance, limit, errors)
    if error.kind == "start":
        return Limit(start_limit(error.tolerance, evidence, errors), f"{limit.origin} at the start")
    return limit


def limits_by_column(log: OwnLog, evidence: Evidence, errors: Errors) -> dict[str, float]:
    """Return the allowed error of each column [SI]: the least limit exceeded, or the largest."""
    over: dict[str, list[float]] = {}
    under: dict[str, list[float]] = {}
    for row in errors.rows:
        if row.source != "reported" or row.kind == "geometric":
            continue
        limit = limit_of(row, evidence, errors).number
        for reading in readings_of(log, row):
            side = under if row.pure <= limit else over
            # Two coordinates may be off by too much together, though neither is alone.
            axis = reading.channel.kind.axis
            both = math.sqrt(2.0) if side is over and axis is not None else 1.0
            side.setdefault(reading.channel.column, []).append(limit * row.scale / both)
    return {column: max(each) for column, each in under.items()} | {
        column: min(each) for column, each in over.items()
    }


def refuse_unjudged(
    log: OwnLog, beside: LogBeside, errors: Errors, limits: Mapping[str, Limit]
) -> None:
    """Refuse columns that name a body or a known quantity, and are not judged; forces may stand
    beside geometry alone. Raises CrankcheckError with every one of them."""
    alone = beside.geometry_alone
    right = _forces_within(log, beside.truth, _limit_or_least(limits, "reaction"))
    faults = {
        column: why
        for column, why in log.unjudged
        if column not in right and not (alone and why == A_FORCE)
    }
    read = {each.channel.column for row in errors.rows for each in readings_of(log, row)}
    lost = [each.channel for each in log.readings if each.channel.column not in read and not alone]
    faults |= {channel.column: f"{channel.name} is not compared" for channel in lost}
    shut = {row.body for row in errors.rows if row.quantity == "gap"}
    faults |= {g.column: "a gap is of a pin or a slider" for g in log.gaps if g.of not in shut}
    if faults:
        place = (
            f"{log.source}: columns that name a body or a known quantity can not be judged; give "
            "of, kind and unit in a [[channel]] of the map, which --write-map map.toml begins, or "
            "ignore = true"
        )
        raise CrankcheckError(listed(place, [f"{cut(c)!r}: {why}" for c, why in faults.items()]))


def _limit_or_least(limits: Mapping[str, Limit], quantity: str) -> float:
    """Return the limit of a quantity; the least of all where it has none."""
    told = {name: each.number for name, each in limits.items() if math.isfinite(each.number)}
    return told.get(quantity, min(told.values(), default=math.inf))


def findings_of_ground(log: OwnLog, limits: Mapping[str, Limit]) -> list[Finding]:
    """Return a finding for each column of a point of the ground that is out of tolerance."""
    found = []
    for each in log.still:
        channel, kind, scene = each.channel, each.channel.kind, log.scene
        at = 0.0 if kind.order else scene.ground[channel.of][kind.axis or 0]
        off = float(np.max(np.abs(each.values - at)))
        pure = off / (scene.longest_m * scene.pace_rad_s**kind.order)
        limit = _limit_or_least(limits, kind.quantity)
        if pure > limit:
            stands = f"{kind.name} is {at:.6g} {si(kind.dimension)}"
            text = (
                f"{cut(channel.column)!r}: {channel.of} is a point of the ground, where {stands}, "
                f"and the column is off by up to {off:.4g}"
            )
            rule = next(rule.id for rule in LIMITS if rule.quantity == kind.quantity)
            found.append(Finding(rule, "fail", text, pure, limit))
    return found


def _forces_within(log: OwnLog, truth: Truth, limit: float) -> set[str]:
    """Return the columns of lengths of forces and of friction that are as in the reference."""
    if log.forces is None or not log.besides:
        return set()
    from reports.describe.free_motion import force_columns  # which few logs need

    forces = truth.with_forces_at(log.forces.forces.time_s).forces
    right = {} if forces is None else force_columns(forces)
    sizes = [np.nanmax(np.abs(each), initial=0.0) for name, each in right.items() if "_f" in name]
    most = limit * max(sizes, default=0.0)
    return {
        name
        for name, values in log.besides.items()
        if name in right
        and np.nanmax(np.abs(values[: right[name].size] - right[name]), initial=0.0)
        <= most * (log.scene.longest_m if name.endswith("_n_m") else 1.0)
    }


def required_name(scene: Scene, name: str) -> tuple[str, str, str]:
    """Return a required name as given, with its quantity and body, "" for any. Raises
    CrankcheckError for one that is neither."""
    bodies = {*scene.links, *scene.pins, *scene.sliders}
    if name in QUANTITIES:
        return name, name, ""
    if name in bodies:
        return name, "", name
    body, dot, quantity = name.rpartition(".")
    if scene.driver.is_crank and (body, quantity) == (scene.driver.link, "angle"):
        quantity = log_kind(scene).driver_angle
    if dot and body in bodies and quantity in QUANTITIES:
        return name, quantity, body
    names = [*QUANTITIES, *sorted(bodies)]
    raise CrankcheckError(
        f"--require {shown(name)}: neither a quantity nor a body of {scene.name}, nor both as in "
        f"{next(iter(scene.links))}.angle; {suggestion(name, names, 'there are')}"
    )


def absent_names(
    scene: Scene,
    required: Iterable[tuple[str, str, str]],
    not_judged: Sequence[str],
    errors: Errors,
) -> tuple[str, ...]:
    """Return each required name that the log lacks, with the missing parts: for a quantity every
    body, for a body any quantity. Raises CrankcheckError for parts that no log is judged for."""
    held = {(row.quantity, row.body) for row in errors.rows}
    found = []
    for name, quantity, body in required:
        lacks = [
            each.replace("drive of", "angle of").replace("phase of", "angle of")
            for each in not_judged
            if (not quantity or each.startswith(f"{quantity} of "))
            and (not body or _is_of(each.partition(" of ")[2], body))
        ]
        there = any(quantity in ("", q) and (not body or _is_of(b, body)) for q, b in held)
        if not (lacks or there):
            none = f"{body or scene.name} has none"
            why = "a point of the ground does not move" if body in scene.ground else none
            raise CrankcheckError(f"--require {name}: {why}, so that is not judged; leave it out")
        if not lacks or (there and not quantity):
            continue
        if body in scene.ground:
            found.append(f"{few(lacks, 6)} (a point of the ground is not judged otherwise)")
        elif lacks == [name] or body:
            found.append(few(lacks, 6))
        else:
            found.append(f"{name} ({few(lacks, 6)})")
    return tuple(found)


def _is_of(judged: str, body: str) -> bool:
    """True if a judged part is of a body: `C on rod`, the force of a pin on a body, is of C."""
    return judged == body or judged.startswith(f"{body} on ")
