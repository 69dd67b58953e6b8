"""What to set: the cheapest settings of each engine that reach a target on every scene."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence

from reports.output.numbers import count
from reports.page.sections.section import Section
from reports.results.lines import called
from reports.results.overview import Report
from reports.results.recommend import Recommendation

RecommendationRow = dict[str, object]


def build(report: Report) -> Section:
    """The section."""
    period_s = _usual_period(report)
    # Engines side by side for each target, the least demanding first.
    ordered = sorted(report.recommendations, key=lambda one: -one.target)
    rows = [row for one in ordered for row in _rows(report, one, period_s)]
    return Section(
        anchor="recommendation",
        title="What to set",
        template="recommendation.html",
        words={
            "rows": rows,
            "scenes": count(len(report.scenes), "scene"),
            "noise": report.noise if math.isfinite(report.noise) else None,
            "timed": report.timed,
        },
        scripts=("copying.js",),
    )


def _usual_period(report: Report) -> float:
    """The period of most lines [s]: what a copied text is written for."""
    return Counter(line.period_s for line in report.lines).most_common(1)[0][0]


def _rows(report: Report, one: Recommendation, period_s: float) -> Iterator[RecommendationRow]:
    """A recommendation, and after it the one that is steadier."""
    yield {**_row(report, one, period_s), "cheapest": _cheapest(report, one)}
    if one.steadier is not None:
        yield {**_row(report, one.steadier, period_s), "steadier": True}


def _row(report: Report, one: Recommendation, period_s: float) -> RecommendationRow:
    """A recommendation with its look and its text to be copied."""
    best = one.best
    return {
        "one": one,
        "look": report.looks.get((best.engine, best.variant, best.drive)),
        "called": called(best.variant, best.drive),
        "steadier": False,
        "cheapest": False,
        "equal": _first(one.equal_to),
        "snippet": one.snippet(period_s),
    }


def _cheapest(report: Report, one: Recommendation) -> bool:
    """Whether no other engine reaches the target in less or, within the noise, the same time."""
    if one.reason or len(report.engines) < 2:
        return False
    others = [
        other.best.s_per_turn
        for other in report.recommendations
        if other.target == one.target and other is not one and not other.reason
    ]
    return one.best.s_per_turn * (1.0 + report.noise) < min(others, default=math.inf)


def _first(names: Sequence[str], most: int = 2) -> str:
    """The first names of a list, and how many more there are."""
    rest = len(names) - most
    return "; ".join(names[:most]) + (f"; and {rest} more" if rest > 0 else "")
