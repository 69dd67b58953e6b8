"""The columns of free cells of elastic links: those of free and of elastic cells."""

from reports.judge.cell import Checked
from reports.ways.elastic.columns import COLUMNS as BENT
from reports.ways.free.columns import COLUMNS as FREE


def columns(checked: Checked) -> dict[str, object]:
    """The columns of a cell, None where there is no number."""
    return FREE(checked) | BENT(checked)


COLUMNS = columns
