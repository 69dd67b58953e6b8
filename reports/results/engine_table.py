"""Engines side by side, each with its tuned profile: a number in each column, or why there is none.

| column | number |
|---|---|
| error at 1 ms | largest error of place at the step nearest to 1 ms: median over the scenes, worst |
| order | fitted order of that error: median over the scenes, and the range |
| floor | largest floor of that error that was seen, and on how many scenes |
| turn to 1e-3, 1e-4 | least measured time of a turn, over all settings and steps, with all scenes within |
| free motion, forces | error at the finest step (median, worst), and its order |
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import pandas as pd

from reports.output.numbers import NONE, count, duration, error_text
from reports.results.line_fit import LineFit
from reports.results.lines import Line, lines, registered
from reports.results.overview import Report

FEWEST = 3
"""Engines from which on they are put side by side."""
NEAR_S = 1e-3
TARGETS = (1e-3, 1e-4)
FREE = ("let go",)
FORCES = "reaction_pure"


@dataclass(frozen=True)
class Score:
    """A cell of the table: its number, NaN where there is none; its text; and a remark, which is
    the reason where there is no number."""

    number: float = math.nan
    told: str = NONE
    remark: str = ""


@dataclass(frozen=True)
class EngineRow:
    """An engine in the table: its scores, by column."""

    engine: str
    version: str
    formulation: str
    precision: str
    scores: Mapping[str, Score] = field(repr=False)


def engine_rows(report: Report) -> list[EngineRow]:
    """Return the engines of a store, those of a formulation together; empty for fewer than three."""
    if len(report.engines) < FEWEST:
        return []
    rows = [
        EngineRow(engine, version, own.formulation, own.precision, _scores(report, engine))
        for engine, version in report.engines.items()
        for own in (registered(engine),)
    ]
    groups = list(dict.fromkeys(row.formulation for row in rows))
    return sorted(rows, key=lambda row: groups.index(row.formulation))


def near_ms(report: Report) -> tuple[float, float] | None:
    """Return the finest and the coarsest of the steps nearest to 1 ms [s]; None without any."""
    driven = _judged(report.driven.lines) if report.driven else []
    steps = [float(_near(line)["dt_s"]) for line in driven]
    return (min(steps), max(steps)) if steps else None


def _scores(report: Report, engine: str) -> dict[str, Score]:
    driven = _judged(report.driven.lines, engine) if report.driven else []
    free = [line for line in _judged(report.lines, engine) if tuple(line.way.kinds) == FREE]
    return {
        "near": _error([_near(line) for line in driven], "place_pure"),
        "order": _order([line.fit for line in driven]),
        "floor": _floor([line.fit for line in driven]),
        **{f"to {target:g}": _time(report, engine, target) for target in TARGETS},
        "free": _error([line.cells.iloc[-1] for line in free], "place_pure"),
        "free order": _order([line.fit for line in free]),
        **_of_forces(report, engine),
    }


def _judged(every: Sequence[Line], engine: str = "") -> list[Line]:
    """Return the lines of profile tuned; of one engine, if given."""
    own = [line for line in every if engine in ("", line.engine)]
    return [line for line in own if bool(line.cells["gated"].all())]


def _near(line: Line) -> pd.Series[float]:
    """Return the cell at the step nearest to 1 ms, as a ratio."""
    return line.cells.iloc[int(np.abs(np.log(line.cells["dt_s"] / NEAR_S)).argmin())]


def _error(cells: Sequence[pd.Series[float]], column: str) -> Score:
    """Return the median of an error over scenes, and its worst; a run that ended badly is worst."""
    if not cells:
        return Score(remark="not run")
    errors = np.array([float(c[column]) if c["status"] == "ok" else math.inf for c in cells])
    errors[np.isnan(errors)] = math.inf
    failed = [str(c["status"]) for c, e in zip(cells, errors, strict=True) if math.isinf(e)]
    if len(failed) == len(cells):
        return Score(remark=Counter(failed).most_common(1)[0][0])
    median, worst = float(np.median(errors)), int(np.argmax(errors))
    if failed:
        remark = f"fails on {len(failed)} of {count(len(cells), 'scene')}"
    else:
        remark = f"worst {error_text(errors[worst])}, {cells[worst]['scene']}"
    told = error_text(median) if math.isfinite(median) else "fails"
    return Score(median, told, remark if len(cells) > 1 else str(cells[0]["scene"]))


def _order(fits: Sequence[LineFit]) -> Score:
    orders = sorted(fit.order for fit in fits if math.isfinite(fit.order))
    if not orders:
        return Score(remark=_kind(fits))
    ends = f"{orders[0]:.1f} to {orders[-1]:.1f}" if len(orders) > 1 else ""
    return Score(float(np.median(orders)), f"{np.median(orders):.1f}", ends)


def _floor(fits: Sequence[LineFit]) -> Score:
    floors = [fit.floor for fit in fits if fit.kind == "floor"]
    if floors:
        seen = f"on {len(floors)} of {count(len(fits), 'scene')}"
        return Score(max(floors), error_text(max(floors)), seen)
    below = [fit.floor_below for fit in fits if math.isfinite(fit.floor_below)]
    if below:
        return Score(0.0, "none", f"below {error_text(max(below))}")
    return Score(remark=_kind(fits))


def _kind(fits: Sequence[LineFit]) -> str:
    """Return the most frequent kind of fit, as the reason for no number."""
    return Counter(fit.kind for fit in fits).most_common(1)[0][0] if fits else "not run"


def _time(report: Report, engine: str, target: float) -> Score:
    """Return the least time of a turn [s] of all settings and steps that reach the target."""
    own = [one for one in (report.driven or report).candidates if one.engine == engine]
    if report.driven is None or not own:
        return Score(remark="not run")
    good = [one for one in own if one.reaches(target)]
    if not good:
        most = max(own, key=lambda one: one.reaching(target))
        return Score(remark=f"on {most.reaching(target)} of {count(most.scenes, 'scene')}")
    timed = [one for one in good if math.isfinite(one.s_per_turn)]
    if not timed:
        return Score(remark="not timed")
    best = min(timed, key=lambda one: one.s_per_turn)
    return Score(best.s_per_turn, duration(best.s_per_turn), f"{best.variant}, {best.steps_told}")


def _of_forces(report: Report, engine: str) -> dict[str, Score]:
    """Return the scores of the reactions; without the lines that were run without forces."""
    cells = report.cells
    if FORCES not in cells or cells[FORCES].isna().all() or report.driven is None:
        return dict.fromkeys(("forces", "forces order"), Score(remark="not run"))
    fitted = _judged(lines(report.driven.stored, FORCES), engine)
    own = [line for line in fitted if line.cells[FORCES].notna().any()]
    if not own:
        return dict.fromkeys(("forces", "forces order"), Score(remark="not reported"))
    finest = _error([line.cells.iloc[-1] for line in own], FORCES)
    return {"forces": finest, "forces order": _order([line.fit for line in own])}
