"""Which times of a store may be compared: those of the processor that timed last."""

from __future__ import annotations

import numpy as np
import pandas as pd

TIMES = ("us_per_step", "us_per_step_median", "us_per_step_a", "us_per_step_b", "s_per_turn")
"""The columns that hold times; NaN where a cell was not timed."""


def machine(cells: pd.DataFrame) -> str | None:
    """The processor that timed last, None where nothing was timed."""
    timed = _timed(cells)
    return None if timed.empty else str(timed.sort_values("made")["processor"].iloc[-1])


def left_out(cells: pd.DataFrame) -> tuple[str, ...]:
    """The processors whose times are not compared."""
    names = {str(name) for name in _timed(cells)["processor"]}
    return tuple(sorted(names - {str(machine(cells))}))


def comparable(cells: pd.DataFrame) -> pd.DataFrame:
    """The cells with the times of the processor that timed last; other times are blanked.

    Processors are told apart by name: two machines of one kind can not be.
    """
    cleared = cells.reindex(columns=[*cells.columns, *(c for c in TIMES if c not in cells.columns)])
    name = machine(cells)
    if name is not None:
        cleared.loc[cleared["processor"] != name, list(TIMES)] = np.nan
    return cleared


def _timed(cells: pd.DataFrame) -> pd.DataFrame:
    """The cells with a time."""
    if "processor" not in cells.columns:  # a store without timings
        return cells.iloc[:0].assign(processor="", made="")
    return cells[cells["us_per_step"].notna()]
