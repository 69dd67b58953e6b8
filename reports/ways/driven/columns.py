"""The columns of driven cells: those of all, and no others."""

from __future__ import annotations

from reports.judge.cell import Checked


def columns(checked: Checked) -> dict[str, object]:
    """No more columns."""
    return {}


COLUMNS = columns
