"""Results as flat rows, one per cell and one per error of a cell, and as pandas frames of them."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, cast

from reports.compare.errors import Error, ErrorKind, largest
from reports.judge.cell import Checked
from reports.judge.tolerance import Limit
from reports.quantities import QUANTITIES, named
from reports.quantities.quantity import BodyKind, Source

if TYPE_CHECKING:
    import pandas as pd


ColumnsOf = Callable[[Checked], dict[str, object]]
"""Additional columns of cells of a kind (part `columns` of a way)."""
Column = tuple[str, str, BodyKind, Source, ErrorKind]


def _columns() -> Iterator[Column]:
    """Yield the error columns of the frame of cells: name, and key of the rows for its maximum."""
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
AS_THEY_ARE = ["quantity", "body_kind", "body", "source", "kind", "unit", "maximum", "rms", "final"]
"""The first columns of the frame of errors: attributes of an error of that name."""


def error_rows(checked: Checked) -> list[dict[str, object]]:
    """Return one row per quantity, body, source and kind of a cell."""
    if checked.errors is None:
        return []
    own = identity(checked)
    return [own | error_row(error, checked.limits) for error in checked.errors.rows]


def error_row(error: Error, limits: Mapping[str, Limit] | None = None) -> dict[str, object]:
    """Return one error as a flat row; with limits, also its own."""
    if limits is None:
        return flat_error(error)
    in_force = limits.get(error.tolerance) if error.kind == "total" else None
    return flat_error(error, limit_pure=None if in_force is None else in_force.number)


def flat_error(error: Error, **limit: object) -> dict[str, object]:
    """Return one error as a flat row, with columns about its ``limit``."""
    return {
        **{name: getattr(error, name) for name in AS_THEY_ARE},
        "maximum_pure": error.pure,
        **limit,
        "time_of_maximum_s": error.time_of_maximum_s,
        "driver_at_maximum_rad": error.driver_at_maximum_rad,
        "reference_bound": error.bound,
        "samples": error.samples,
    }


def cell_row(checked: Checked) -> dict[str, object]:
    """Return one cell as a flat row; missing numbers are None."""
    row = identity(checked) | {
        "gated": checked.cell.gated,
        "verdict": checked.verdict,
        "status": checked.status,
        "reason": checked.reason,
        "stopped_at_s": checked.stopped_at_s,
        "failed_rules": " ".join(finding.rule for finding in checked.failures),
    }
    cell, errors = checked.cell, checked.errors.rows if checked.errors else ()
    roles = cell.way.roles_of(with_forces=cell.with_forces)
    for name, *key in ERROR_COLUMNS:
        if QUANTITIES[str(key[0])].role in roles:
            worst = largest(e for e in errors if [e.quantity, e.body_kind, e.source, e.kind] == key)
            row[name] = worst.maximum if worst else None
    every = ((name, QUANTITIES[name.removesuffix("-differenced")]) for name in cell.way.limits)
    for name in (name for name, entry in every if entry.role in roles):
        worst = largest(e for e in errors if e.kind == "total" and e.tolerance == name)
        column = name.replace("-", "_")
        row[f"{column}_pure"] = worst.pure if worst else None
        row[f"{column}_limit_pure"] = (
            checked.limits[name].number if name in checked.limits else None
        )
    row["place_pure"] = _worst(*(row[f"{name}_pure"] for name in cell.way.placed))
    convergence = checked.convergence
    row |= cast(ColumnsOf, cell.way.part("columns"))(checked) | {
        **{name: getattr(convergence, name, None) for name in ("trend", "order", "floor")},
        "convergence_of": convergence.unit if convergence else None,
        "settings": json.dumps(dict(checked.settings)),
        "warnings": " | ".join(checked.warnings),
    }
    row |= _of_batch(checked) if checked.cell.worlds else {}
    return row | _worst_force(checked) if checked.cell.with_forces else row


def _of_batch(checked: Checked) -> dict[str, object]:
    """Return the columns of a batch: its request, and the facts of its worlds, None for none."""
    cell, batch = checked.cell, checked.batch
    names = ("worst", "error", "error_in", "lost", "difference", "exact", "bound", "us_per_step")
    facts = {f"batch_{name}": getattr(batch, name, None) for name in (*names, "us_alone")}
    holds = batch.holds.items() if batch else ()
    swapped = " ".join(f"{world}:{of}" for world, of in holds)
    return {"worlds": cell.worlds, "threads": cell.threads, **facts, "batch_swapped": swapped}


def _worst_force(checked: Checked) -> dict[str, object]:
    seen = checked.force_convergence
    forces = largest(
        each
        for each in (checked.errors.rows if checked.errors else ())
        if each.quantity in named("force") and each.kind == "total"
    )
    return {
        "force_pure": forces.pure if forces else None,
        **{f"force_{name}": getattr(seen, name, None) for name in ("trend", "order", "floor")},
    }


def _worst(*pure: object) -> float | None:
    """Return the largest of some pure errors; one that is not finite is larger than any."""
    numbers = [each for each in pure if isinstance(each, float)]
    return max(numbers, key=lambda each: each if math.isfinite(each) else math.inf, default=None)


def identity(checked: Checked) -> dict[str, object]:
    """Return the identity of a cell."""
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


def error_frame(checked: Iterable[Checked]) -> pd.DataFrame:
    """Return one row per scene, engine, profile, step, quantity, body, source and kind."""
    import pandas as pd

    return pd.DataFrame([row for one in checked for row in error_rows(one)])


def cell_frame(checked: Sequence[Checked]) -> pd.DataFrame:
    """Return one row per cell, failures included with their status and reason."""
    import pandas as pd

    return pd.DataFrame([cell_row(one) for one in checked])
