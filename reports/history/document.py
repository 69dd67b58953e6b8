"""A history as files: every number as CSV, and the whole as a Markdown page."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Sequence

from reports.history.changes import Change, changes, headlines, steps
from reports.history.measured import QUANTITIES, Found, Outcome
from reports.history.overview import overview
from reports.history.table import compared
from reports.output.markdown import plain, table

COLUMNS = (
    "engine",
    "version",
    "scene",
    "profile",
    "verdict",
    "status",
    "quantity",
    "unit",
    "error",
    "version_before",
    "times_better",
    "reason",
)


def table_text(outcomes: Sequence[Outcome]) -> str:
    """history.csv: one line per version, scene, profile and quantity; a version without a result
    and a cell without errors are one line each, with the reason."""
    found = _by_cell(outcomes)
    lines: list[dict[str, object]] = []
    for outcome in outcomes:
        here: dict[str, object] = {"engine": outcome.one.engine, "version": outcome.version}
        if not outcome.cells:
            lines.append(here | {"status": "not measured", "reason": outcome.reason})
        for cell in outcome.cells:
            lines += [here | line for line in _lines(cell, found, outcome.version)]
    buffer = io.StringIO()
    writer = csv.DictWriter(buffer, COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows(lines)
    return buffer.getvalue()


def page(outcomes: Sequence[Outcome], footer: str) -> str:
    """history.md: versions, what stands out, and the errors of every scene."""
    engine = outcomes[0].one.engine
    heads, rows = overview(outcomes)
    parts = [f"# {engine} {', '.join(outcome.version for outcome in outcomes)}", ""]
    parts.append(table([" ".join(head.split()) for head in heads], rows))
    for before, after in steps(outcomes):
        parts += ["", f"## {after.version} against {before.version}", ""]
        parts += [f"- {plain(line.text)}" for line in headlines(before, after)]
    found = _by_cell(outcomes)
    measured = [outcome for outcome in outcomes if outcome.cells]
    for profile in dict.fromkeys(cell.profile for outcome in measured for cell in outcome.cells):
        parts += ["", f"## Profile {profile}, largest errors", ""]
        names = [f"{quantity.name} [{quantity.unit}]" for quantity in QUANTITIES]
        rows = [
            _row(cell, outcome.version, found)
            for scene in dict.fromkeys(c.scene for o in measured for c in o.cells)
            for outcome in measured
            for cell in outcome.cells
            if (cell.scene, cell.profile) == (scene, profile)
        ]
        parts.append(table(["scene", "version", *names, "against the version before"], rows))
    return "\n".join([*parts, "", "  \n".join(map(plain, footer.splitlines())), ""])


Key = tuple[str, str, str]


def _by_cell(outcomes: Sequence[Outcome]) -> dict[Key, list[Change]]:
    """The changes by version, scene and profile."""
    found: dict[Key, list[Change]] = {}
    for before, after in steps(outcomes):
        for change in changes(before, after):
            found.setdefault((change.after, change.scene, change.profile), []).append(change)
    return found


def _lines(cell: Found, found: dict[Key, list[Change]], version: str) -> list[dict[str, object]]:
    """The lines of one cell."""
    about: dict[str, object] = {
        "scene": cell.scene,
        "profile": cell.profile,
        "verdict": cell.verdict,
        "status": cell.status,
        "reason": cell.reason,
    }
    changed = {c.quantity.name: c for c in found.get((version, cell.scene, cell.profile), [])}
    lines = []
    for quantity in QUANTITIES:
        if quantity.name not in cell.errors:
            continue
        change = changed.get(quantity.name)
        lines.append(
            about
            | {
                "quantity": quantity.name,
                "unit": quantity.unit,
                "error": cell.errors[quantity.name],
                "version_before": change.before if change else "",
                "times_better": change.ratio if change else "",
            }
        )
    return lines or [about]


def _row(cell: Found, version: str, found: dict[Key, list[Change]]) -> list[str]:
    """One cell as a row of the page."""
    numbers = [cell.errors.get(quantity.name, math.nan) for quantity in QUANTITIES]
    texts = ["-" if math.isnan(number) else f"{number:.2e}" for number in numbers]
    changed = found.get((version, cell.scene, cell.profile), [])
    last = compared(changed).plain if cell.status == "ok" else f"{cell.status}: {cell.reason}"
    return [cell.scene, version, *texts, last]
