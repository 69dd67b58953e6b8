"""The verdict: one sentence for all, one for each engine, and the numbers behind them."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import pandas as pd

from reports.output.numbers import count, duration, error_text, floor_words, listed
from reports.page.sections.copied import recommended
from reports.page.sections.section import Section
from reports.protocol.way import FIXED, SHRINKS
from reports.results.lines import Line, named
from reports.results.looks import Look
from reports.results.overview import Report
from reports.results.recommend import Recommendation

ASKED = 1e-4
"""Target in the sentence of an engine."""


@dataclass(frozen=True)
class VerdictRow:
    """An engine with its settings over all scenes."""

    look: Look
    gated: bool
    cells: int
    within: int
    up_to: tuple[int, ...]
    failed: int
    orders: tuple[float, ...]
    floors: tuple[float, ...]
    below: float
    told: int
    lines: int
    finest: float
    worst_scene: str

    @property
    def order(self) -> str:
        """Fitted orders, from the least to the largest."""
        return spread([f"{order:.1f}" for order in sorted(self.orders)])

    @property
    def floor(self) -> str:
        """Floors that were seen, and the number of scenes; or the size below which there may be
        one."""
        if not self.floors:
            return f"below {error_text(self.below)}" if self.told else "too few steps"
        told = spread([error_text(floor) for floor in sorted(self.floors)])
        return f"{told} on {len(self.floors)} of {count(self.lines, 'scene')}"


def build(report: Report) -> Section:
    """Return the section."""
    rows = [
        _row(look, [line for line in report.lines if named(line) == name])
        for name, look in report.looks.items()
    ]
    kinds = sorted((line.kind for line in report.lines), key=lambda kind: kind.stands)
    chosen = () if report.driven is None else report.driven.recommendations
    gated = report.cells[report.cells["gated"]]
    advice = [] if report.driven is None else recommended(report.driven)
    reached = {one.target for one in chosen if not one.reason} or {ASKED}
    return Section(
        anchor="verdict",
        title="Verdict",
        template="verdict.html",
        words={
            "advice": advice,
            "first": ASKED if ASKED in reached else min(reached),
            "moves": report.driven is not None and any(report.driven.scenes.values()),
            "verdict": verdict(gated),
            "level": level(gated),
            "sentences": [
                (engine, version, sentence(engine, rows, chosen))
                for engine, version in report.engines.items()
            ],
            "rows": rows,
            "fixed_heads": [f"to {error_text(target, 1)}:" for target in FIXED],
            "shrinks": SHRINKS,
            "held_to": list(dict.fromkeys(kind.error for kind in kinds)),
            "steps": sorted({f"{s:g}" for s in report.cells["steps_per_turn"]}, key=float),
        },
    )


def level(gated: pd.DataFrame) -> str:
    """Return the colour class of the verdict: within, out, or none."""
    if gated.empty:
        return "none"
    return "within" if bool((gated["verdict"] == "within").all()) else "out"


def verdict(gated: pd.DataFrame) -> str:
    """Return the sentence for all gated cells: profile tuned without overrides."""
    if gated.empty:
        return "No verdict: the store has no cells of profile tuned, the judged profile."
    within, number = int((gated["verdict"] == "within").sum()), len(gated)
    engines = listed(list(dict.fromkeys(gated["engine"])))
    if within == number:
        return f"Within tolerance: all {count(number, 'tuned cell')} of {engines}."
    worst = gated[gated["verdict"] != "within"]["scene"].value_counts()
    where = listed([f"{scene} ({n})" for scene, n in worst.head(3).items()])
    return (
        f"Out of tolerance: {number - within} of {count(number, 'tuned cell')} of {engines}, "
        f"most of them on {where}."
    )


def sentence(engine: str, rows: Sequence[VerdictRow], chosen: Sequence[Recommendation]) -> str:
    """Return the summary of an engine for a user."""
    own = [row for row in rows if row.look.engine == engine]
    texts = [_held(row) for row in own if row.gated]
    texts.append(_cheapest([one for one in chosen if one.best.engine == engine]))
    texts += [_shipped(row) for row in own if row.look.variant == "as-shipped" and not row.gated]
    return " ".join(text for text in texts if text)


def _held(row: VerdictRow) -> str:
    name = row.look.variant
    manner = f"As {name}," if "," in name else f"With {name} settings"
    text = f"{manner} it is within tolerance in {_share(row)}"
    if row.failed:
        text += f", and {count(row.failed, 'run')} of them failed"
    if row.orders:
        text += f"; its error shrinks with order {row.order} of the step"
    if row.floors:
        return f"{text}, with a floor at {row.floor}."
    unseen = floor_words(math.nan, row.below) or "too few steps to see a floor"
    return f"{text}; {unseen}."


def _shipped(row: VerdictRow) -> str:
    text = f"As shipped it is within tolerance in {_share(row)}"
    texts = []
    if row.floors:
        texts.append(
            f"on {len(row.floors)} of {count(row.lines, 'scene')} the error stops shrinking, at "
            f"{spread([error_text(f) for f in sorted(row.floors)])}, however small the step"
        )
    if row.orders:
        rest = "on the others it" if texts else "its error"
        texts.append(f"{rest} shrinks with order {row.order} of the step")
    return text + (f": {'; '.join(texts)}." if texts else ".")


def _cheapest(chosen: Sequence[Recommendation]) -> str:
    asked = next((one for one in chosen if one.target == ASKED), None)
    if asked is None:
        return ""
    if asked.reason:
        return f"For an error of {error_text(ASKED, 1)} on every scene: {asked.reason}."
    return (
        f"Cheapest for an error of {error_text(ASKED, 1)} on every scene: {asked.best.variant} at "
        f"{asked.best.steps_per_turn:g} steps a turn, {duration(asked.best.s_per_turn)} a turn."
    )


def _share(row: VerdictRow) -> str:
    return f"{row.within} of {count(row.cells, 'cell')}"


def spread(told: Sequence[str]) -> str:
    """Return the first and the last of sorted texts, once where they are the same."""
    if not told:
        return "\N{EN DASH}"
    return told[0] if told[0] == told[-1] else f"{told[0]} to {told[-1]}"


def _row(look: Look, lines: Sequence[Line]) -> VerdictRow:
    cells = pd.concat([line.cells for line in lines])
    good = cells[cells["status"] == "ok"]
    finest = [_finest(line) for line in lines]
    return VerdictRow(
        look=look,
        gated=bool(cells["gated"].all()),
        cells=len(cells),
        within=int((cells["verdict"] == "within").sum()),
        up_to=tuple(int((good["place_pure"] <= target).sum()) for target in FIXED),
        failed=int((cells["status"] != "ok").sum()),
        orders=tuple(x.fit.order for x in lines if x.fit.kind == "order"),
        floors=tuple(x.fit.floor for x in lines if x.fit.kind == "floor"),
        below=max((x.fit.floor_below for x in lines if x.fit.kind == "order"), default=math.nan),
        told=sum(line.fit.kind not in ("too few", "not run") for line in lines),
        lines=len(lines),
        finest=max(error for error, _ in finest),
        worst_scene=max(finest)[1],
    )


def _finest(line: Line) -> tuple[float, str]:
    """Return the error at the finest step, infinite if that run did not end well, and the scene."""
    last = line.cells.iloc[-1]
    good = last["status"] == "ok" and math.isfinite(last["place_pure"])
    return (float(last["place_pure"]) if good else math.inf), line.scene
