"""Texts to be copied: the cheapest settings of each engine that reach a target on every scene, and
programs that read forces."""

import math
from collections import Counter
from collections.abc import Iterator, Sequence

import numpy as np
import pandas as pd

from analytic.kinematics import solve
from models.errors import CrankcheckError
from reports.output.numbers import count
from reports.page.sections.section import Section
from reports.quantities import QUANTITIES
from reports.results.lines import Named, called, named
from reports.results.overview import Report
from reports.results.recommend import Recommendation
from sim.engine.settings import profile_of, resolved
from sim.registry import engine, offering
from sim.registry.offers import force_recipe

RecommendationRow = dict[str, object]


def recommended(report: Report) -> list[RecommendationRow]:
    """Return the rows of the recommendations, the least demanding target first."""
    # Copied texts are written for the period of most lines.
    period_s = Counter(line.period_s for line in report.lines).most_common(1)[0][0]
    ordered = sorted(report.recommendations, key=lambda one: -one.target)
    rows = [row for one in ordered for row in _rows(report, one, period_s)]
    return [{**row, "id": f"settings-{number}"} for number, row in enumerate(rows)]


def recommendation(report: Report) -> Section:
    """Return the section."""
    return Section(
        anchor="recommendation",
        title="What to set",
        template="recommendation.html",
        words={
            "rows": recommended(report),
            "scenes": count(len(report.scenes), "scene"),
            "noise": report.noise if math.isfinite(report.noise) else None,
            "timed": report.timed,
        },
        scripts=("copying.js",),
    )


def _rows(report: Report, one: Recommendation, period_s: float) -> Iterator[RecommendationRow]:
    """Yield a recommendation, and after it the steadier one."""
    yield {**_row(report, one, period_s), "cheapest": _cheapest(report, one)}
    if one.steadier is not None:
        yield {**_row(report, one.steadier, period_s), "steadier": True}


def _row(report: Report, one: Recommendation, period_s: float) -> RecommendationRow:
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
    """True if no other engine reaches the target in less or, within the noise, the same time."""
    if one.reason or len(report.engines) < 2:
        return False
    others = [
        other.best.s_per_turn
        for other in report.recommendations
        if other.target == one.target and other is not one and not other.reason
    ]
    return one.best.s_per_turn * (1.0 + report.noise) < min(others, default=math.inf)


def _first(names: Sequence[str], most: int = 2) -> str:
    rest = len(names) - most
    return "; ".join(names[:most]) + (f"; and {rest} more" if rest > 0 else "")


SHOWN = ("reaction", "torque")
STEPS_PER_TURN = 720.0
"""Step of the programs, at which all engines have reached their order."""


def reading_forces(report: Report) -> Section | None:
    """Return the section; None where no forces were requested."""
    columns = [f"{name}_pure" for name in SHOWN]
    if not set(columns) <= set(report.cells) or bool(report.cells[columns].isna().all(axis=None)):
        return None
    return Section(
        anchor="reading_forces",
        title="Forces",
        template="reading_forces.html",
        words={
            "shares": {name: QUANTITIES[name].share for name in SHOWN},
            "rows": [_force_row(report, name) for name in report.looks],
            "recipes": list(_recipes(report)),
        },
        scripts=("copying.js",),
    )


def _force_row(report: Report, name: Named) -> dict[str, object]:
    """Return the largest errors of an engine with its settings, each line at its finest step."""
    own = [line for line in report.lines if named(line) == name]
    finest = pd.DataFrame([line.cells.iloc[-1] for line in own])
    row: dict[str, object] = {
        "engine": name[0],
        "called": called(*name[1:]),
        "look": report.looks[name],
        "steps": float(finest["steps_per_turn"].max()),
    }
    for quantity in SHOWN:
        errors = finest[f"{quantity}_pure"].astype("float64")
        errors = errors.where(finest["status"] == "ok", np.inf)
        worst = None if errors.isna().all() else int(np.nanargmax(errors))
        row[quantity] = None if worst is None else float(errors.iloc[worst])
        row[f"{quantity}_scene"] = "" if worst is None else str(finest["scene"].iloc[worst])
    return row


def _recipes(report: Report) -> Iterator[dict[str, str]]:
    """Yield the program of each engine that has one, for the first scene that it covers."""
    for name in report.engines:
        for scene in report.scenes.values() if name in offering("force_recipe") else ():
            if scene is None:
                continue
            try:
                settings = resolved(profile_of(engine(name), "tuned"), None)
                start = solve(scene, np.zeros(1), bound=False).state()
                text = force_recipe(name, scene, start, settings, STEPS_PER_TURN)
            except CrankcheckError:  # not installed here, or not for this scene
                continue
            yield {"engine": name, "scene": scene.name, "text": text}
            break
