"""Results as flat rows: one per cell, and one per error of a cell."""

from __future__ import annotations

import json
import math

from reports.compare.errors import BodyKind, Kind, Quantity, Source, largest
from reports.judge.cell import Checked
from reports.judge.tolerance import DEFAULTS

Column = tuple[str, Quantity, BodyKind, Source, Kind]


def _columns() -> list[Column]:
    """The error columns of the frame of cells: name, and the rows that it is the maximum of."""
    found: list[Column] = [("drive_error_rad", "drive", "driver", "reported", "total")]
    places: tuple[tuple[str, Quantity, BodyKind, str], ...] = (
        ("angle", "angle", "link", "rad"),
        ("displacement", "displacement", "slider", "m"),
        ("position", "position", "point", "m"),
    )
    for name, quantity, body, unit in places:
        found.append((f"{name}_error_{unit}", quantity, body, "reported", "total"))
        found.append((f"{name}_geometric_error_{unit}", quantity, body, "reported", "geometric"))
    found.append(("pin_gap_m", "gap", "point", "reported", "total"))
    found.append(("slider_gap_m", "gap", "slider", "reported", "total"))
    rates: tuple[tuple[str, Quantity, BodyKind, str], ...] = (
        ("angular_velocity", "velocity", "link", "rad_s"),
        ("slider_speed", "velocity", "slider", "m_s"),
        ("velocity", "velocity", "point", "m_s"),
        ("angular_acceleration", "acceleration", "link", "rad_s2"),
        ("slider_acceleration", "acceleration", "slider", "m_s2"),
        ("acceleration", "acceleration", "point", "m_s2"),
    )
    for name, quantity, body, unit in rates:
        found.append((f"{name}_error_{unit}", quantity, body, "reported", "total"))
        found.append((f"{name}_differenced_error_{unit}", quantity, body, "differenced", "total"))
    return found


ERROR_COLUMNS = _columns()


def error_rows(one: Checked) -> list[dict[str, object]]:
    """One row per quantity, body, source and kind of a cell."""
    if one.errors is None:
        return []
    return [
        identity(one)
        | {
            "quantity": error.quantity,
            "body_kind": error.body_kind,
            "body": error.body,
            "source": error.source,
            "kind": error.kind,
            "unit": error.unit,
            "maximum": error.maximum,
            "rms": error.rms,
            "final": error.final,
            "maximum_pure": error.pure,
            "limit_pure": one.limits[error.tolerance].number if error.kind == "total" else None,
            "time_of_maximum_s": error.time_of_maximum_s,
            "driver_at_maximum_rad": error.driver_at_maximum_rad,
            "reference_bound": error.bound,
            "samples": error.samples,
        }
        for error in one.errors.rows
    ]


def cell_row(one: Checked) -> dict[str, object]:
    """One cell as a flat row; what there is no number for is None."""
    row = identity(one) | {
        "gated": one.cell.gated,
        "verdict": one.verdict,
        "status": one.status,
        "reason": one.reason,
        "stopped_at_s": one.stopped_at_s,
        "failed_rules": " ".join(finding.rule for finding in one.failures),
    }
    errors = one.errors.rows if one.errors else ()
    for name, *key in ERROR_COLUMNS:
        worst = largest(e for e in errors if [e.quantity, e.body_kind, e.source, e.kind] == key)
        row[name] = worst.maximum if worst else None
    for name in DEFAULTS:
        worst = largest(e for e in errors if e.kind == "total" and e.tolerance == name)
        column = name.replace("-", "_")
        row[f"{column}_pure"] = worst.pure if worst else None
        row[f"{column}_limit_pure"] = one.limits[name].number if name in one.limits else None
    row["place_pure"] = _worst(row["angle_pure"], row["displacement_pure"], row["position_pure"])
    seen = one.convergence
    row |= {
        "trend": seen.trend if seen else None,
        "order": seen.order if seen else None,
        "floor": seen.floor if seen else None,
        "convergence_of": seen.unit if seen else None,
        "settings": json.dumps(dict(one.settings)),
        "warnings": " | ".join(one.warnings),
    }
    return row


def _worst(*pure: object) -> float | None:
    """The largest of some pure errors; one that is not finite is larger than any."""
    known = [each for each in pure if isinstance(each, float)]
    return max(known, key=lambda each: each if math.isfinite(each) else math.inf, default=None)


def identity(one: Checked) -> dict[str, object]:
    """What names a cell."""
    cell = one.cell
    return {
        "scene": cell.scene.name,
        "engine": cell.engine,
        "version": one.version,
        "profile": cell.profile,
        "drive": cell.drive,
        "dt_s": cell.dt_s,
        "steps_per_turn": cell.steps_per_turn,
        "turns": cell.turns,
    }
