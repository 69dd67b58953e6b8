"""The columns of cells whose links bend: engines' models of them, and the parts of the deflection's
error, as shares of the largest."""

from reports.compare.errors import ElasticFacts
from reports.judge.cell import Checked


def columns(checked: Checked) -> dict[str, object]:
    """The columns of a cell, None where there is no number."""
    known = ElasticFacts.of(checked.errors)
    return {
        "segments": float(checked.cell.segments),
        "springs": checked.cell.springs,
        "frequency_ratio": known.ratio if known else None,
        "chain_pure": known.chain if known else None,
        "doubt_pure": known.doubt if known else None,
        "linear_pure": known.linear if known else None,
    }


COLUMNS = columns
