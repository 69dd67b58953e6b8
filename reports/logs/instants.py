"""The instants of the rows of a log."""

from __future__ import annotations

import numpy as np

from models.array import Array
from models.errors import CrankcheckError, cut
from models.laws import MOST_TURNS
from models.scene import Scene
from reports.logs.columns import Columns
from reports.logs.units import UNITS

EVEN = 0.02
"""Intervals that differ by less of themselves are the same."""
MOSTLY = 0.9
"""The share of the intervals of an even log that are the same."""
HOLE = 1.9
"""An interval longer than so many of the others leaves out samples."""


def instants(columns: Columns, column: str, unit: str, *, holes: bool = False) -> Array:
    """The times of all rows [s], (T,).

    Parameters
    ----------
    holes : bool
        A log that is even but for some left-out samples is meant so.

    Raises
    ------
    CrankcheckError
        Fewer than 2 rows; times that go back or stand still; a hole in a log that is even else.
    """
    time_s = columns.numbers(column) * UNITS["time"][unit]
    if time_s.size < 2:
        raise CrankcheckError(f"{columns.source}: {time_s.size} row; a motion has at least 2")
    refuse_back(columns, column, time_s)
    if not holes:
        _refuse_holes(columns, column, time_s, np.diff(time_s))
    return np.asarray(time_s)


def refuse_back(columns: Columns, column: str, time_s: Array) -> None:
    """Refuse times that go back or stand still. Raises CrankcheckError."""
    steps = np.diff(time_s)
    back = np.flatnonzero(steps <= 0.0)
    if back.size:
        row = int(back[0])
        does = "goes back" if steps[row] < 0.0 else "stands still"
        raise CrankcheckError(
            f"{columns.at(column, row + 1)}: time {does}, from {time_s[row]:.9g} s to "
            f"{time_s[row + 1]:.9g} s ({back.size} such rows); sort the rows, and keep one of each "
            "instant"
        )


def refuse_far(columns: Columns, column: str, time_s: Array, scene: Scene) -> None:
    """Refuse times so late that the place within a turn is lost. Raises CrankcheckError."""
    far = float(np.max(np.abs(time_s)))
    turns = far / scene.driver.law.period_s
    if turns > MOST_TURNS:
        raise CrankcheckError(
            f"{columns.source}, column {cut(column)!r}: t = {far:.9g} s is {turns:.3g} turns of "
            f"{scene.driver.joint} after the start; count the time from the start of the motion, "
            f"or from the first row: zero = {'first'!r} in [time] of the map"
        )


def _refuse_holes(columns: Columns, column: str, time_s: Array, steps: Array) -> None:
    """Refuse an even log that lacks samples in between. Raises CrankcheckError."""
    usual = float(np.median(steps))
    same = np.abs(steps - usual) <= EVEN * usual
    far = np.flatnonzero(steps > HOLE * usual)
    if far.size == 0 or np.mean(same) < MOSTLY:
        return
    row = int(far[0])
    lacking = round(float(steps[row]) / usual) - 1
    raise CrankcheckError(
        f"{columns.at(column, row + 1)}: a gap of {steps[row]:.4g} s in a log of a sample every "
        f"{usual:.4g} s, {lacking} of them missing after t = {time_s[row]:.6g} s ({far.size} such "
        f"gaps); fill them, cut the log there, or say {cut('holes = ' + repr('meant'))} in [file] "
        "of the map"
    )
