"""A line of a model with what came of it, and what of its run is kept to be drawn."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from models.array import Array
from models.scene import Same
from reports.compare.beside import Beside, truth_of
from reports.compare.last_turn import Trace, trace
from reports.compare.tracks import length
from reports.judge.cell import Cell, Checked, examined
from sim.engine import Engine, Run

MOST = 600
"""Instants of a course."""


@dataclass(frozen=True)
class ErrorCourse:
    """The largest error of place of all bodies over time, and the widest gap, as pure numbers (T,):
    of a long run the largest of each stretch, at its own instant [s]."""

    time_s: Array
    error: Array
    gap: Array


@dataclass(frozen=True, kw_only=True)
class CheckedLine(Checked):
    """A line that was run and judged: also its last turn, and its whole course; without both where
    it logged nothing."""

    last_turn: Trace = field(default_factory=dict)
    course: ErrorCourse | None = None


def checked(cell: Cell, adapter: Engine) -> CheckedLine:
    """Run and judge a line in an engine that holds the model."""
    found, run = examined(cell, adapter=adapter)
    if run is None or found.errors is None:
        return without_run(found)
    return CheckedLine(
        **vars(found), last_turn=trace(cell.shown_truth, run), course=course_of(cell, run)
    )


def without_run(found: Checked) -> CheckedLine:
    """A line that has nothing to be drawn."""
    return CheckedLine(**vars(found))


def course_of(cell: Cell, run: Run) -> ErrorCourse | None:
    """The course of a run, None where it logged nothing. Raises CrankcheckError where there is no
    reference."""
    beside = Beside.of(truth_of(Same(cell.scene)), run)
    if beside is None:
        return None
    time_s = beside.motion.time_s
    error = np.max([length(each.error) / each.scale for each in beside.places], axis=0)
    gap = _widest(run.gaps, time_s.size) / (cell.scene.longest_m or 1.0)
    kept = _largest_rows(np.nan_to_num(error, nan=np.inf, posinf=np.inf))
    return ErrorCourse(time_s[kept], error[kept], gap[kept])


def _widest(gaps: Mapping[str, Array], samples: int) -> Array:
    return np.asarray(np.max([np.zeros(samples), *map(np.abs, gaps.values())], axis=0))


def _largest_rows(series: Array) -> list[int]:
    """The first row, the last, and the largest of each stretch, about `MOST` in all."""
    if series.size <= MOST:
        return list(range(series.size))
    ends = np.linspace(0, series.size, MOST - 1).astype(int)
    largest = (int(start + np.argmax(series[start:end])) for start, end in itertools.pairwise(ends))
    return sorted({0, *largest, series.size - 1})
