"""The columns of free cells: how far they were followed, and how long each class of precision
holds."""

from __future__ import annotations

from reports.compare.free.free_facts import FreeFacts
from reports.judge.cell import Checked
from reports.ways.free.precision import IFTOMM, precision


def columns(checked: Checked) -> dict[str, object]:
    """The columns of a cell, None where there is no number."""
    known = FreeFacts.of(checked.errors)
    limit = checked.limits.get("phase")
    return {
        "precision": precision(checked),
        "sensitivity": known.sensitivity if known else None,
        "judged_until_s": known.until_s if known else None,
        "left_out": known.left_out if known else None,
        "limit_positions": known.passages if known else None,
        **{
            f"horizon_{name}_s": known.horizon_s(size) if known else None
            for name, size in IFTOMM.items()
        },
        "horizon_limit_s": known.judged_horizon_s(limit.number) if known and limit else None,
    }


COLUMNS = columns
