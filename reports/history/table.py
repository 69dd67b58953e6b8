"""Versions side by side on the terminal: results, headlines, the scenes that changed."""

import csv
import io
from collections.abc import Iterator, Mapping, Sequence
from math import isinf

from rich.console import Console
from rich.text import Text

from reports.history.verification import FOLLOWED, VersionResult, errors_of, overview, profiles_of
from reports.history.version_changes import (
    FollowedChange,
    by_cell,
    headlines,
    largest,
    steps,
    times,
)
from reports.output.console import grid, hanging
from reports.output.formats import plain, table
from reports.quantities import QUANTITIES, named
from reports.results.runs import CellName, StoredCell

COLUMNS: Mapping[str, tuple[str, ...]] = {
    "angle\nrad": ("angle",),
    "place\n/ L": ("place",),
    "gap\n/ L": ("pin gap", "slider gap"),
} | {QUANTITIES[name].head: (name,) for name in named("derived") if QUANTITIES[name].head}
"""Head, and the quantities of which the column shows the largest."""
NARROW = ("angle\nrad", "gap\n/ L")
WIDE = 100
LINES = 9
"""Lines of the table of one profile: with the rest it fits a screen."""
HEADLINES = 10


def show(console: Console, results: Sequence[VersionResult], footer: str) -> None:
    """Print the whole history, headlines first."""
    _versions(console, results)
    _headlines(console, results)
    for profile in profiles_of(results):
        _profile(console, profile, [result for result in results if result.cells])
    console.print(Text(footer, "dim"), highlight=False)


def _versions(console: Console, results: Sequence[VersionResult]) -> None:
    """Print one row per version; one that could not be measured shows why."""
    heads, rows = overview(results)
    table = grid(heads, gap=1, whole=("version",))
    for result, row in zip(results, rows, strict=True):
        table.add_row(*row, style="" if result.cells else "red")
    console.print(table, "")


def _headlines(console: Console, results: Sequence[VersionResult]) -> None:
    styles = {True: "green", False: "bold red", None: ""}
    lines = [line for step in steps(results) for line in headlines(step)]
    lines.sort(key=lambda line: line.good is not False)  # changes for the worse go first
    for line in lines[:HEADLINES]:
        hanging(console, "* ", line.text, styles[line.good])
    if len(lines) > HEADLINES:
        console.print(
            f"  and {len(lines) - HEADLINES} more: -o DIR writes all of them", style="dim"
        )
    if lines:
        console.print()


def _profile(console: Console, profile: str, measured: Sequence[VersionResult]) -> None:
    """Print the scenes of one profile that changed most, a row for each version."""
    cells = {
        (result.version, cell.name): cell
        for result in measured
        for cell in result.cells
        if cell.name.variant == profile
    }
    changes = {key: each for key, each in by_cell(measured).items() if key in cells}
    changed = [change for each in changes.values() for change in each]
    ranked = ranking(list(dict.fromkeys(name for _, name in cells)), changed)
    shown = ranked[: max(1, LINES // max(1, len(measured)))]
    heads = tuple(COLUMNS) if console.width >= WIDE else NARROW
    console.print(Text(f"profile {profile}: {_part(shown, ranked, changed)}", "bold"))
    last = "against the\nversion before"
    named = ("scene", "version", *(f"{head}:" for head in heads), last)
    table = grid(named, gap=1, whole=("version",), least={"scene": 16, last: 14})
    for name in shown:
        for number, result in enumerate(measured):
            key = (result.version, name)
            numbers = _row(cells.get(key), changes.get(key, []), heads, bool(number))
            table.add_row(Text("" if number else name.scene), result.version, *numbers)
    console.print(table, "")


def ranking(names: Sequence[CellName], changes: Sequence[FollowedChange]) -> list[CellName]:
    """Return the cells: worsened ones first, then by the largest factor of any error; the largest
    errors first where nothing changed."""

    def rank(name: CellName) -> tuple[float, float, float]:
        own = [change for change in changes if change.cell == name]
        places = [change for change in own if not change.about.rate]
        worse = max((c.factor for c in own if c.stands_out and c.word() == "worse"), default=0.0)
        most = max((c.factor for c in places if c.changed), default=0.0)
        return -worse, -most, -max((c.new for c in places), default=0.0)

    return sorted(names, key=rank)


def _part(
    shown: Sequence[CellName], ranked: Sequence[CellName], changes: Sequence[FollowedChange]
) -> str:
    if len(shown) == len(ranked):
        return "largest errors"
    by = "changed most" if any(change.changed for change in changes) else "have the largest errors"
    return f"the {len(shown)} of {len(ranked)} scenes that {by} (-o DIR writes all)"


def _row(
    cell: StoredCell | None, changes: Sequence[FollowedChange], heads: Sequence[str], later: bool
) -> list[Text]:
    if cell is None:
        return [Text("-")] * len(heads) + [Text("")]
    errors, numbers = errors_of(cell), []
    for head in heads:
        values = [errors[name] for name in COLUMNS[head] if name in errors]
        top = largest(change for change in changes if change.quantity in COLUMNS[head])
        numbers.append(Text(f"{max(values):.1e}" if values else "-", _style(top)))
    if not cell.ok:
        return [*numbers, Text(cell.status, "red")]
    return [*numbers, compared(changes) if later else Text("")]


def compared(changes: Sequence[FollowedChange]) -> Text:
    """Return the largest change of a cell in two or three words."""
    top = largest(change for change in changes if not change.about.rate)
    top = top if top and top.changed else largest(changes)
    if top is None:
        return Text("")
    if not top.changed:
        return Text("same", "dim")
    factor = "" if isinf(top.factor) else f"{times(top.factor)} x "
    quantity = top.quantity.removeprefix("pin ").removeprefix("slider ")
    return Text(f"{factor}{top.word()} ({quantity})", _style(top))


def _style(change: FollowedChange | None) -> str:
    if change is None or not change.stands_out:
        return ""
    return "green" if change.word() == "better" else "bold red"


FILE_COLUMNS = (
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
    """Return history.csv: one line per version, scene, profile and quantity; a version without a
    result and a cell without errors are one line each, with the reason."""
    changes = by_cell(results)
    buffer = io.StringIO()
    writer = csv.DictWriter(buffer, FILE_COLUMNS, lineterminator="\n")
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
    errors = errors_of(cell)
    changed = {change.quantity: change for change in changes}
    for name in (name for name in FOLLOWED if name in errors or name in changed):
        line: dict[str, object] = {"quantity": name, "unit": FOLLOWED[name].unit}
        line["error"] = errors.get(name, "")
        if change := changed.get(name):
            line |= {"version_before": change.before, "times_better": change.times_better}
        yield line


def page(results: Sequence[VersionResult], footer: str) -> str:
    """Return history.md: versions, headlines, and the errors of every scene."""
    heads, rows = overview(results)
    parts = [f"# {results[0].asked.engine} {', '.join(result.version for result in results)}", ""]
    parts.append(table(heads, rows))
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
    """Return the largest change of a cell, or its ending."""
    return compared(changes).plain if cell.ok else f"{cell.status}: {cell.reason}"
