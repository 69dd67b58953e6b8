"""What the errors of a user's own log are held to."""

from __future__ import annotations

import math
from collections.abc import Mapping

from models.errors import CrankcheckError
from models.scene import Scene
from reports.compare.errors import Error, Errors
from reports.judge.rules.rule import Evidence
from reports.judge.rules.start import start_limit
from reports.judge.tolerance import Limit, in_passage, limits
from reports.logs.beside_truth import readings_of
from reports.logs.channel import OwnLog

EVERY = "all"
"""What a target for all quantities is kept under."""


def log_limits(
    scene: Scene, errors: Errors, target: Mapping[str, float], step_s: float
) -> dict[str, Limit]:
    """The limit of everything that is judged, by target or by a step [s], 0 for none; what is not
    judged has no end. Raises CrankcheckError for neither."""
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
            f"no limit for {', '.join(lacking_)}: no step of a log is known, so no budget follows "
            "from one; give --target 1e-3 (or one each, such as --target angle=1e-3), or --step "
            "with the step of the solver in seconds"
        )
    return {name: told.get(name, Limit(math.inf, "none")) for name in numbers}


def limit_of(error: Error, evidence: Evidence, errors: Errors) -> Limit:
    """What an error of a log is held to: at the start, and near change points, to limits of their
    own."""
    limit = evidence.limits[error.tolerance]
    if error.kind == "passage":
        return in_passage(error.tolerance, limit, errors)
    if error.kind == "start":
        return Limit(start_limit(error.tolerance, evidence, errors), f"{limit.origin} at the start")
    return limit


def limits_by_column(log: OwnLog, evidence: Evidence, errors: Errors) -> dict[str, float]:
    """What the error of each column may be [SI]: the least limit that it is over, or the largest
    where it is over none."""
    over: dict[str, list[float]] = {}
    under: dict[str, list[float]] = {}
    for row in errors.rows:
        if row.source != "reported" or row.kind == "geometric":
            continue
        limit = limit_of(row, evidence, errors).number
        for reading in readings_of(log, row.quantity, row.body):
            if reading.channel.kind.judged_of == row.body_kind or row.body_kind == "driver":
                side = under if row.pure <= limit else over
                # Two coordinates may be off by too much together, though neither is alone.
                both = (
                    math.sqrt(2.0)
                    if side is over and reading.channel.kind.axis is not None
                    else 1.0
                )
                side.setdefault(reading.channel.column, []).append(limit * row.scale / both)
    return {column: max(each) for column, each in under.items()} | {
        column: min(each) for column, each in over.items()
    }
