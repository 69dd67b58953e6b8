"""Engines side by side with their tuned profiles: numbers, or the reasons why there are none."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from reports.output.numbers import NONE, count, duration, error_text
from reports.results.line_fit import LineFit
from reports.results.lines import Line, lines, registered
from reports.results.overview import Report
from sim.registry import Declaration

FEWEST = 3
"""Engines from which on they are put side by side."""
NEAR_S = 1e-3
TARGETS = (1e-3, 1e-4)
FREE = ("free",)
FORCES = "reaction_pure"


@dataclass(frozen=True)
class Score:
    """A cell of the table: a number as text, and a remark, the reason where there is none."""

    number: str = NONE
    remark: str = "not run"

    @property
    def words(self) -> str:
        return f"{self.number} ({self.remark})" if self.remark else self.number


@dataclass(frozen=True)
class EngineRow:
    """An engine in the table: its scores, by column."""

    engine: str
    version: str
    declaration: Declaration
    scores: Mapping[str, Score]


def engine_rows(report: Report) -> list[EngineRow]:
    """Return the engines of a store, those of a formulation together; empty for less than three."""
    if len(report.engines) < FEWEST:
        return []
    every = _tuned(report.lines)
    driven = _tuned(report.driven.lines) if report.driven else []
    with_forces = FORCES in report.cells and not report.cells[FORCES].isna().all()
    reacting = _tuned(lines(report.driven.stored, FORCES)) if report.driven and with_forces else []
    rows = []
    for engine, version in report.engines.items():
        own = [line for line in driven if line.engine == engine]
        free = [x for x in every if x.engine == engine and tuple(x.way.kinds) == FREE]
        forces = [x for x in reacting if x.engine == engine and x.cells[FORCES].notna().any()]
        silent = "not reported" if with_forces else "not run"
        scores = {
            "near": _error([_near(line) for line in own], "place_pure"),
            "order": _order(own),
            "floor": _floor([line.fit for line in own]),
            **{f"to {target:g}": _time(report.driven, engine, target) for target in TARGETS},
            "free": _error([line.cells.iloc[-1] for line in free], "place_pure"),
            "free order": _order(free),
            "forces": _error([line.cells.iloc[-1] for line in forces], FORCES, silent),
            "forces order": _order(forces, silent),
        }
        rows.append(EngineRow(engine, version, registered(engine), scores))
    groups = list(dict.fromkeys(row.declaration.formulation for row in rows))
    return sorted(rows, key=lambda row: groups.index(row.declaration.formulation))


def near_ms(report: Report) -> list[float]:
    """Return the finest and the coarsest of the steps nearest to 1 ms [s]; empty without any."""
    steps = [_near(x)["dt_s"] for x in (_tuned(report.driven.lines) if report.driven else ())]
    return [min(steps), max(steps)] if steps else []


def _tuned(every: Sequence[Line]) -> list[Line]:
    """Return the lines of profile tuned without overrides."""
    return [line for line in every if bool(line.cells["gated"].all())]


def _near(line: Line) -> pd.Series[Any]:
    """Return the cell at the step nearest to 1 ms, as a ratio."""
    return line.cells.iloc[int(np.abs(np.log(line.cells["dt_s"] / NEAR_S)).argmin())]


def _error(cells: Sequence[pd.Series[Any]], column: str, silent: str = "not run") -> Score:
    """Return the median of an error over the supported scenes, and the worst; that of a run that
    did not end well is infinite."""
    ran = [cell for cell in cells if cell["status"] != "unsupported"]
    if not ran:
        return Score(remark="unsupported" if cells else silent)
    errors = np.array([c[column] if c["status"] == "ok" else math.inf for c in ran])
    errors = np.where(np.isfinite(errors), errors, math.inf)
    failed, at, median = int(np.isinf(errors).sum()), int(errors.argmax()), np.median(errors)
    if failed == len(ran):
        return Score(remark=Counter(str(cell["status"]) for cell in ran).most_common(1)[0][0])
    remark = f"worst {error_text(errors[at])}, " * (len(ran) > 1) + str(ran[at]["scene"])
    if failed:
        remark = f"fails on {failed} of {count(len(ran), 'scene')}"
    remark += f"; {len(cells) - len(ran)} unsupported" * (len(ran) < len(cells))
    return Score(error_text(median) if math.isfinite(median) else "fails", remark)


def _order(own: Sequence[Line], silent: str = "not run") -> Score:
    """Return the median of the orders over the scenes, and their range."""
    fits = [line.fit for line in own]
    orders = sorted(x.order for x in fits if x.kind != "grows" and math.isfinite(x.order))
    if not orders:
        return Score(remark=_kind(fits) if fits else silent)
    ends = dict.fromkeys(f"{order:.1f}" for order in (orders[0], orders[-1]))
    return Score(f"{np.median(orders):.1f}", " to ".join(ends) * (len(ends) > 1))


def _floor(fits: Sequence[LineFit]) -> Score:
    """Return the largest floor that is seen, or below which there may be one."""
    if floors := [fit.floor for fit in fits if fit.kind == "floor"]:
        seen = f"on {len(floors)} of {count(len(fits), 'scene')}"
        return Score(error_text(max(floors)), seen)
    if below := [fit.floor_below for fit in fits if math.isfinite(fit.floor_below)]:
        return Score(f"< {error_text(max(below))}", "not excluded")
    return Score(remark=_kind(fits) if fits else "not run")


def _kind(fits: Sequence[LineFit]) -> str:
    return Counter(fit.kind for fit in fits).most_common(1)[0][0]


def _time(driven: Report | None, engine: str, target: float) -> Score:
    """Return the least time of a turn [s] of all settings and steps that reach the target."""
    own = [one for one in (driven.candidates if driven else ()) if one.engine == engine]
    if not own:
        return Score()
    good = [one for one in own if one.reaches(target)]
    timed = [one for one in good if math.isfinite(one.s_per_turn)]
    if not timed:
        most, scenes = max(one.reaching(target) for one in own), count(own[0].scenes, "scene")
        return Score(remark="not timed" if good else f"reached on {most} of {scenes}")
    best = min(timed, key=lambda one: one.s_per_turn)
    return Score(duration(best.s_per_turn), f"{best.variant}, {best.steps_told}")
