"""Forces: how far reactions and torque are off at the finest step, and programs that read them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pandas as pd

from analytic.kinematics import solve
from models.errors import CrankcheckError
from reports.page.sections.section import Section
from reports.quantities import QUANTITIES
from reports.results.lines import Named, called, named
from reports.results.overview import Report
from sim.offers import force_recipe
from sim.registry import engine, offering
from sim.settings import profile_of, resolved

SHOWN = ("reaction", "torque")
STEPS_PER_TURN = 720.0
"""Of the programs: a step at which all engines have come to their order."""


def build(report: Report) -> Section | None:
    """The section; None where no forces were asked for."""
    columns = [f"{name}_pure" for name in SHOWN]
    if not set(columns) <= set(report.cells) or bool(report.cells[columns].isna().all(axis=None)):
        return None
    return Section(
        anchor="reading_forces",
        title="Forces",
        template="reading_forces.html",
        words={
            "shares": {name: QUANTITIES[name].share for name in SHOWN},
            "rows": [_row(report, name) for name in report.looks],
            "recipes": list(_recipes(report)),
        },
        scripts=("copying.js",),
    )


def _row(report: Report, name: Named) -> dict[str, object]:
    """The largest errors of an engine with its settings, each line at its finest step."""
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
    """A program for each engine that has one, of the first scene that it covers."""
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
