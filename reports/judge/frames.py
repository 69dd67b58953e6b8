"""Results as tidy pandas frames: every error in long form, and one row per cell."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from reports.judge.cell import Checked
from reports.judge.rows import cell_row, error_rows

if TYPE_CHECKING:
    import pandas as pd  # a third of a second: not for what is only shown


def error_frame(checked: Iterable[Checked]) -> pd.DataFrame:
    """One row per scene, engine, profile, step, quantity, body, source and kind."""
    import pandas as pd

    return pd.DataFrame([row for one in checked for row in error_rows(one)])


def cell_frame(checked: Sequence[Checked]) -> pd.DataFrame:
    """One row per cell, failures included with their status and reason."""
    import pandas as pd

    return pd.DataFrame([cell_row(one) for one in checked])
