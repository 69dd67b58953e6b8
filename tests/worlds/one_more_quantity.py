"""Cells with a quantity more than crankcheck has: one entry, and all that it is seen in.

Run as a program, as entries are read when their readers are imported. Prints JSON.
"""

import io
import json
from collections.abc import Mapping
from dataclasses import replace

from models.array import Array
from models.files.reading import load_scene
from models.motion import Motion
from reports.quantities import QUANTITIES
from reports.quantities.places import ACCELERATION
from reports.quantities.quantity import Criterion, Measure, Quantity

MASS_KG = 2.0


def _pull(motion: Motion) -> Mapping[str, Array]:
    """What it takes to move a mass at C as C moves [N]."""
    return {"C": MASS_KG * motion.points["C"].acceleration}


QUANTITIES["pull"] = Quantity(
    name="pull",
    role="derived",
    head="pull\n/ G",
    measures=(
        Measure(
            body_kind="point",
            column="pull_error_N",
            unit="N",
            share="G",
            scale=lambda scene, _: MASS_KG * scene.longest_m * scene.driver.law.peak_speed_rad_s**2,
            truth=lambda scene, reference: _pull(reference) if "rocker" in scene.links else {},
            logged=lambda scene, run: {} if run.motion is None else _pull(run.motion),
        ),
    ),
    criteria=(
        Criterion(
            "CC901",
            "pull",
            "What it takes to move a mass at C.",
            "Shorten the step.",
            "pull",
            replace(ACCELERATION.criteria[0].tolerance, reason="As an acceleration."),
            diagram="pull at C",
        ),
    ),
    instants=lambda run: run.acceleration_time_s,
    silent=lambda run: not run.reports_accelerations,
)


def main() -> None:
    """Cells of an engine that has accelerations, of one that has none, of a scene without a pull,
    and one that is held to too little."""
    from rich.console import Console

    from reports.history.table import COLUMNS
    from reports.history.verification import FOLLOWED
    from reports.judge.cell import Cell, check
    from reports.judge.rows import cell_frame, error_frame
    from reports.page.sections.errors import DIAGRAMS
    from reports.results.runs import COMPARED
    from reports.store.manifest import table
    from reports.tune.table import OTHERS
    from reports.verify.table import show

    cells = [
        Cell(scene, engine, "tuned", scene.driver.law.period_s / 360, 360, converge=False)
        for scene in map(load_scene, ("fourbar-lecture-1", "slider-crank-offset"))
        for engine in ("mujoco", "pymunk")
    ]
    strict = replace(cells[0], tolerance={"pull": 1e-9})
    checked = [check(each) for each in (*cells, strict)]
    text = io.StringIO()
    show(Console(file=text, width=120), checked, {})
    frame = cell_frame(checked)
    rows = frame.to_dict("records")
    told = {
        "findings": [[vars(finding) for finding in one.findings] for one in checked],
        "not_reported": [one.errors.not_reported for one in checked if one.errors],
        "cells": rows,
        "errors": error_frame(checked).to_dict("records"),
        "types": {each.name: str(each.type) for each in table(rows).schema},
        "table": text.getvalue(),
        "page": DIAGRAMS,
        "tune": OTHERS,
        "history": [vars(FOLLOWED["pull"]), COLUMNS],
        "diff": COMPARED,
    }
    print(json.dumps(told))


if __name__ == "__main__":
    main()
