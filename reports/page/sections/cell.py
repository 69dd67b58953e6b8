"""What a page knows of the cells behind its tables: how each ended, its errors with their limits,
its settings, and the command that repeats it."""

import math
import shlex
from collections.abc import Hashable, Mapping, Sequence
from typing import Any

from models.errors import CrankcheckError
from reports.judge.rules import RULES
from reports.page.sections.errors import DIAGRAMS, SHARES
from reports.plan.chosen_study import StudyChoice
from reports.protocol.length import SECONDS
from reports.quantities import QUANTITIES
from reports.results.lines import Line, value_text
from reports.results.overview import Report
from sim.engine.settings import profile_of
from sim.registry import engine


def words_of(report: Report) -> dict[str, object]:
    """Return settings by look and titles of rules, to be embedded beside cells."""
    told = report.settings_told.items()
    return {
        "settings": {report.looks[name].number: words for name, words in told},
        "rules": {name: rule.title for name, rule in RULES.items()},
    }


def known(report: Report, lines: Sequence[Line]) -> dict[str, object]:
    """Return lines with all their cells, to be embedded where none of them is drawn."""
    return words_of(report) | {
        "known": [
            {
                "scene": line.scene,
                "look": report.look(line).number,
                "command": command(line),
                "cells": [cell_facts(line, row) for row in line.cells.to_dict("records")],
            }
            for line in lines
        ]
    }


def cell_facts(line: Line, row: Mapping[Hashable, Any]) -> dict[str, object]:
    """Return the facts of a cell: its step, its end, its failed rules, and errors with limits."""
    limits = {
        name: row.get(name.replace("_pure", "_limit_pure"), math.nan)
        for name in map(str, row)
        if name.endswith("_pure") and not name.endswith("_limit_pure")
    }
    is_free, step = line.way.clock is SECONDS, line.way.clock.step(row)
    return {
        "steps": row["steps_per_turn"],
        "at": f"{row['dt_s' if is_free else 'steps_per_turn']:.10g}",
        "step": f"dt {step}" if is_free else f"{step} steps a turn",
        "verdict": row["verdict"] if row["status"] == "ok" else f"{row['status']}: {row['reason']}",
        "failed": str(row.get("failed_rules") or "").replace(",", " ").split(),
        "errors": [
            [*of, row[name], limit]
            for name, limit in limits.items()
            if (of := _quantity(name)) and math.isfinite(row[name])
        ],
    }


def _quantity(column: str) -> tuple[str, str] | None:
    """Return name and unit of a column of pure errors; None for one that is no error of a quantity,
    as the place, which is the worst of several."""
    if column != "place_pure" and column in DIAGRAMS:
        return DIAGRAMS[column]
    words = column.removesuffix("_pure").replace("_differenced", ", from logged places")
    entry = QUANTITIES.get(words.partition(",")[0])
    return (words, SHARES.get(entry.share, entry.share)) if entry else None


def command(line: Line) -> str:
    """Return the command that repeats a cell of a line, to which its step is added; a variant with
    settings of its own names them as differences from its profile."""
    first, is_free = line.cells.iloc[0], line.way.clock is SECONDS
    profile, length = str(first["profile"]), float(first["turns"])
    try:
        usual = dict(profile_of(engine(line.engine), profile).values)
    except CrankcheckError:  # not installed here
        usual = dict(line.settings)
    own = {n: value_text(v) for n, v in line.settings.items() if v != usual.get(n)}
    bent = math.isfinite(first.get("segments", math.nan))
    choice = StudyChoice(
        scenes=[line.scene],
        engines=[line.engine],
        profiles=[profile],
        overrides={line.engine: own},
        free=is_free,
        segments=[int(first["segments"])] if bent else [],
        springs=[str(first["springs"])] if bent else [],
        turns=None if is_free else length,
        duration_s=length if is_free else None,
    )
    step = "--dt" if is_free else "--steps-per-turn"
    return shlex.join([*choice.command("again"), "--no-timing", step])
