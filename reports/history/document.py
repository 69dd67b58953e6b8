"""A history as files: every number as CSV, and the whole as a Markdown page."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence

from reports.history.table import compared
from reports.history.version_changes import FollowedChange, by_cell, headlines, steps
from reports.history.version_result import FOLLOWED, VersionResult, errors_of, overview, profiles_of
from reports.output.markdown import plain, table
from reports.results.changes.runs import StoredCell

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


def table_text(results: Sequence[VersionResult]) -> str:
    """history.csv: one line per version, scene, profile and quantity; a version without a result
    and a cell without errors are one line each, with the reason."""
    changes = by_cell(results)
    buffer = io.StringIO()
    writer = csv.DictWriter(buffer, COLUMNS, lineterminator="\n")
    writer.writeheader()
    for result in results:
        version = {"engine": result.asked.engine, "version": result.version}
        if not result.cells:
            writer.writerow(version | {"status": "not measured", "reason": result.reason})
        for cell in result.cells:
            lines = list(_lines(cell, changes.get((result.version, cell.name), [])))
            about = {
                "scene": cell.name.scene,
                "profile": cell.name.variant,
                "verdict": cell.verdict,
                "status": cell.status,
                "reason": cell.reason,
            }
            writer.writerows(version | about | line for line in lines or [{}])
    return buffer.getvalue()


def _lines(cell: StoredCell, changes: Sequence[FollowedChange]) -> Iterator[dict[str, object]]:
    """What the lines of one cell say of each error."""
    errors = errors_of(cell)
    changed = {change.quantity: change for change in changes}
    for name in (name for name in FOLLOWED if name in errors or name in changed):
        line: dict[str, object] = {"quantity": name, "unit": FOLLOWED[name].unit}
        line["error"] = errors.get(name, "")
        if change := changed.get(name):
            line |= {"version_before": change.before, "times_better": change.times_better}
        yield line


def page(results: Sequence[VersionResult], footer: str) -> str:
    """history.md: versions, what stands out, and the errors of every scene."""
    heads, rows = overview(results)
    parts = [f"# {results[0].asked.engine} {', '.join(result.version for result in results)}", ""]
    parts.append(table([" ".join(head.split()) for head in heads], rows))
    for step in steps(results):
        parts += ["", f"## {step.after.version} against {step.before.version}", ""]
        parts += [f"- {plain(line.text)}" for line in headlines(step)]
    changes = by_cell(results)
    names = [f"{name} [{error.unit}]" for name, error in FOLLOWED.items()]
    for profile in profiles_of(results):
        cells = [(r, c) for r in results for c in r.cells if c.name.variant == profile]
        scenes = list(dict.fromkeys(cell.name.scene for _, cell in cells))
        cells.sort(key=lambda each: scenes.index(each[1].name.scene))
        rows = [
            [
                cell.name.scene,
                result.version,
                *_numbers(cell),
                _last(cell, changes.get((result.version, cell.name), [])),
            ]
            for result, cell in cells
        ]
        parts += ["", f"## Profile {profile}, largest errors", ""]
        parts.append(table(["scene", "version", *names, "against the version before"], rows))
    return "\n".join([*parts, "", "  \n".join(map(plain, footer.splitlines())), ""])


def _numbers(cell: StoredCell) -> list[str]:
    errors = errors_of(cell)
    return [f"{errors[name]:.2e}" if name in errors else "-" for name in FOLLOWED]


def _last(cell: StoredCell, changes: Sequence[FollowedChange]) -> str:
    """The largest change of a cell, or how it ended."""
    return compared(changes).plain if cell.ok else f"{cell.status}: {cell.reason}"
