"""Results as flat rows: one per cell, and one per error of a cell."""

from __future__ import annotations

import json
import math
from collections.abc import Collection, Iterator, Mapping

from reports.compare.errors import Error, ErrorKind, largest
from reports.judge.cell import Checked
from reports.judge.precision import IFTOMM, precision
from reports.judge.tolerance import FORCES, Limit, known_limits
from reports.quantities import QUANTITIES, named
from reports.quantities.quantity import BodyKind, Source

Column = tuple[str, str, BodyKind, Source, ErrorKind]


def _columns() -> Iterator[Column]:
    """The error columns of the frame of cells: name, and the rows that it is the maximum of."""
    for name, entry in QUANTITIES.items():
        more: list[tuple[Source, ErrorKind]] = [("reported", "geometric")] * (entry.role == "place")
        more += [("differenced", "total") for each in entry.criteria if each.tolerance.differenced]
        for measure in entry.measures:
            yield measure.column, name, measure.body_kind, "reported", "total"
            for source, kind in more:
                other = kind if source == "reported" else source
                column = measure.column.replace("_error_", f"_{other}_error_")
                yield column, name, measure.body_kind, source, kind


ERROR_COLUMNS = tuple(_columns())
FORCE_COLUMNS = frozenset(
    name for name, quantity, *_ in ERROR_COLUMNS if quantity in named("force")
)
"""Those of cells of which forces were asked for."""
DRIVE_COLUMNS = frozenset(
    name for name, quantity, *_ in ERROR_COLUMNS if quantity in named("drive")
)
FREE_COLUMNS = frozenset(name for name, quantity, *_ in ERROR_COLUMNS if quantity in named("free"))
"""Those of cells that were driven, and those of cells that were let go."""
ELASTIC_COLUMNS = frozenset(
    name for name, quantity, *_ in ERROR_COLUMNS if quantity in named("elastic")
)
"""Those of cells whose links bend."""
AS_THEY_ARE = ["quantity", "body_kind", "body", "source", "kind", "unit", "maximum", "rms", "final"]
"""The first columns of the frame of errors: what an error has of that name."""


def error_rows(checked: Checked) -> list[dict[str, object]]:
    """One row per quantity, body, source and kind of a cell."""
    if checked.errors is None:
        return []
    own = identity(checked)
    return [own | error_row(error, checked.limits) for error in checked.errors.rows]


def error_row(error: Error, limits: Mapping[str, Limit] | None = None) -> dict[str, object]:
    """One error as a flat row; with limits, that which it is held to."""
    limit = None
    if limits is not None:
        in_force = limits.get(error.tolerance) if error.kind == "total" else None
        limit = {"limit_pure": None if in_force is None else in_force.number}
    return {
        **{name: getattr(error, name) for name in AS_THEY_ARE},
        "maximum_pure": error.pure,
        **(limit or {}),
        "time_of_maximum_s": error.time_of_maximum_s,
        "driver_at_maximum_rad": error.driver_at_maximum_rad,
        "reference_bound": error.bound,
        "samples": error.samples,
    }


def cell_row(checked: Checked) -> dict[str, object]:
    """One cell as a flat row; what there is no number for is None."""
    row = identity(checked) | {
        "gated": checked.cell.gated,
        "verdict": checked.verdict,
        "status": checked.status,
        "reason": checked.reason,
        "stopped_at_s": checked.stopped_at_s,
        "failed_rules": " ".join(finding.rule for finding in checked.failures),
    }
    errors = checked.errors.rows if checked.errors else ()
    free = checked.cell.drive == "free"
    bends = bool(checked.cell.scene.elastic)
    wanted: Collection[str] = known_limits(free=free, bends=bends)
    if not checked.cell.with_forces:
        wanted = [name for name in wanted if name not in FORCES]
    others = DRIVE_COLUMNS if free else FREE_COLUMNS
    for name, *key in ERROR_COLUMNS:
        if (
            name in others
            or (name in ELASTIC_COLUMNS and not bends)
            or (name in FORCE_COLUMNS and not checked.cell.with_forces)
        ):
            continue
        worst = largest(e for e in errors if [e.quantity, e.body_kind, e.source, e.kind] == key)
        row[name] = worst.maximum if worst else None
    for name in wanted:
        worst = largest(e for e in errors if e.kind == "total" and e.tolerance == name)
        column = name.replace("-", "_")
        row[f"{column}_pure"] = worst.pure if worst else None
        row[f"{column}_limit_pure"] = (
            checked.limits[name].number if name in checked.limits else None
        )
    placed = ("phase", *named("place")) if free else named("place")
    placed = ("deflection",) if bends else placed  # what elastic links are about
    row["place_pure"] = _worst(*(row[f"{name}_pure"] for name in placed))
    convergence = checked.convergence
    row |= free_row(checked) if free else {}
    row |= elastic_row(checked) if bends else {}
    row |= {
        "trend": convergence.trend if convergence else None,
        "order": convergence.order if convergence else None,
        "floor": convergence.floor if convergence else None,
        "convergence_of": convergence.unit if convergence else None,
        "settings": json.dumps(dict(checked.settings)),
        "warnings": " | ".join(checked.warnings),
    }
    return row | _force_convergence(checked) if checked.cell.with_forces else row


def free_row(checked: Checked) -> dict[str, object]:
    """What a free cell has besides: how far it was followed, and how far each class of precision
    holds."""
    facts = checked.errors.free if checked.errors else None
    limit = checked.limits.get("phase")
    return {
        "precision": precision(checked),
        "sensitivity": facts.sensitivity if facts else None,
        "judged_until_s": facts.until_s if facts else None,
        "left_out": facts.left_out if facts else None,
        "limit_positions": facts.passages if facts else None,
        **{
            f"horizon_{name}_s": facts.horizon_s(size) if facts else None
            for name, size in IFTOMM.items()
        },
        "horizon_limit_s": facts.judged_horizon_s(limit.number) if facts and limit else None,
    }


def elastic_row(checked: Checked) -> dict[str, object]:
    """What a cell has besides whose links bend: as what they were given, and the parts of what the
    deflection is off by, as shares of the largest."""
    facts = checked.errors.elastic if checked.errors else None
    return {
        "segments": float(checked.cell.segments),
        "springs": checked.cell.springs,
        "frequency_ratio": facts.ratio if facts else None,
        "chain_pure": facts.chain if facts else None,
        "doubt_pure": facts.doubt if facts else None,
        "linear_pure": facts.linear if facts else None,
    }


def _force_convergence(checked: Checked) -> dict[str, object]:
    """The worst force, and what it does when the step is halved."""
    seen = checked.force_convergence
    forces = largest(
        each
        for each in (checked.errors.rows if checked.errors else ())
        if each.quantity in named("force") and each.kind == "total"
    )
    return {
        "force_pure": forces.pure if forces else None,
        "force_trend": seen.trend if seen else None,
        "force_order": seen.order if seen else None,
        "force_floor": seen.floor if seen else None,
    }


def _worst(*pure: object) -> float | None:
    """The largest of some pure errors; one that is not finite is larger than any."""
    numbers = [each for each in pure if isinstance(each, float)]
    return max(numbers, key=lambda each: each if math.isfinite(each) else math.inf, default=None)


def identity(checked: Checked) -> dict[str, object]:
    """What names a cell."""
    cell = checked.cell
    return {
        "scene": cell.scene.name,
        "engine": cell.engine,
        "version": checked.version,
        "profile": cell.profile,
        "drive": cell.drive,
        "dt_s": cell.dt_s,
        "steps_per_turn": cell.steps_per_turn,
        "turns": cell.turns,
    }
