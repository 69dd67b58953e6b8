"""A diff on the terminal, as Markdown short enough for a pull request comment, and as JUnit XML."""

from collections.abc import Iterable, Sequence
from xml.etree.ElementTree import Element

from rich.console import Console
from rich.text import Text

from reports.diff import words
from reports.output.console import grid, hanging, say
from reports.output.formats import case_of, counted, folded, plain, remark, suite_of, table
from reports.results.changes import CellPair, Diff
from reports.results.runs import CellName, StoredCell

MOST = {"worse": 200, "better": 10}
"""Rows of a table; all worse cells are named, unless they are more than anyone reads."""
LEFT_OUT = 8
NARROW = 76
"""Columns below which old and new give way to their ratio."""
STYLES = {"worse": "bold red", "better": "green"}


def show_diff(console: Console, diff: Diff, strict: bool = False) -> None:
    """Print the whole diff."""
    style = STYLES["worse"] if diff.code(strict) else "bold green"
    console.print(Text(f"{words.verdict(diff, strict)}: {words.headline(diff)}", style))
    for line in words.remarks(diff):
        hanging(console, "  ", line)
    console.print()
    _grid(console, "worse", words.lines(diff, "worse"))
    _grid(console, "better", words.lines(diff, "better"))
    _left_out(console, "new", diff.added)
    _left_out(console, "missing", diff.missing)
    console.print(Text("\n".join(words.footer(diff)), "dim"), highlight=False)


def _grid(console: Console, word: str, rows: Sequence[words.PrintedRow]) -> None:
    """Print the rows of worse cells, or better ones, and the reasons of engines that gave up."""
    if not rows:
        return
    wide = console.width >= NARROW
    shown = rows[: MOST[word]]
    kept = [head for head in words.HEADS if wide or head not in ("old:", "new:")]
    cells = ([Text(line.cells[head]) for head in kept] for line in shown)
    console.print(grid(kept, cells, word, gap=1, style=STYLES[word]))
    if len(rows) > len(shown):
        more = f"and {len(rows) - len(shown)} more rows; --junit FILE names every cell"
        say(console, more, "dim")
    reasons = (f"{line.cells['engine']}: {line.reason}" for line in shown if line.reason)
    for text in dict.fromkeys(reasons):
        hanging(console, "  ", text)
    console.print()


def _left_out(console: Console, word: str, cells: Sequence[StoredCell]) -> None:
    texts = words.left_out(cells)
    if not texts:
        return
    console.print(Text(word, "bold"))
    for text in texts[:LEFT_OUT]:
        hanging(console, "  ", text)
    if len(texts) > LEFT_OUT:
        console.print(f"  and {len(texts) - LEFT_OUT} more lines like these", style="dim")
    console.print()


BUDGETS = {"worse": 30_000, "better": 8_000, "new": 4_000, "missing": 4_000}
"""Bytes of each part: all of them with the heads stay below the 65,536 of a comment on GitHub."""
HEAD = 6_000
"""Bytes for the remarks, and for the footer."""


def markdown(diff: Diff, strict: bool = False) -> str:
    """Return the whole diff; rows that exceed their room are counted."""
    parts = [
        f"## crankcheck diff: {words.verdict(diff, strict).lower()}",
        f"**{words.headline(diff)}**",
    ]
    parts.append(_fitted((f"- {plain(text)}" for text in words.remarks(diff)), HEAD))
    worse, better = words.lines(diff, "worse"), words.lines(diff, "better")
    if worse:
        parts.append(f"### worse\n\n{_rows(worse, BUDGETS['worse'])}")
    if better:
        parts.append(folded(f"{len(better)} better", _rows(better, BUDGETS["better"])))
    for word, cells in (("new", diff.added), ("missing", diff.missing)):
        texts = (f"- {plain(text)}" for text in words.left_out(cells))
        if listed := _fitted(texts, BUDGETS[word]):
            parts.append(folded(f"{len(cells)} {word}", listed))
    parts.append(_fitted((f"{plain(text)}  " for text in words.footer(diff)), HEAD))
    return "\n\n".join(part for part in parts if part) + "\n"


def _rows(rows: Sequence[words.PrintedRow], room: int) -> str:
    cells = []
    for line in rows:
        quantity = line.cells["quantity"] + f": {line.reason}" * bool(line.reason)
        cells.append([*{**line.cells, "quantity": quantity}.values()])
    return table(words.HEADS, cells, room, "rows")


def _fitted(texts: Iterable[str], room: int) -> str:
    return "\n".join(counted(texts, room, "lines"))


def suite(diff: Diff, strict: bool = False) -> Element:
    """Return one test case per cell of either run: a failure where it is worse, skipped where there
    is nothing to compare it with; ``strict`` makes failures of skipped ones but the new."""
    lost = "failure" if strict else "skipped"
    cases = [
        *map(_compared, diff.pairs),
        *_uncompared(diff.missing, lost, "missing: only the old run has it"),
        *_uncompared(diff.other_scene, lost, "the scene changed in between"),
        *_uncompared(diff.added, "skipped", "new: only the new run has it"),
    ]
    facts = {
        f"{side} {name}": value
        for side, run in (("old", diff.old), ("new", diff.new))
        for name, value in {"run": run.label, **run.facts}.items()
    }
    return suite_of("diff", cases, facts)


def _compared(pair: CellPair) -> Element:
    case = _case(pair.name)
    if pair.word == "worse":
        versions = f"{pair.name.engine} {pair.old.version} -> {pair.new.version}"
        rows = [
            f"{change.quantity}: {words.size(change.old)} -> {words.size(change.new)}, "
            f"ratio {words.ratio(change)} ({change.word(pair.factor)})"
            for change in pair.changes
        ]
        kind = "status" if pair.turned else "error"
        message = f"{pair.name.label}: {words.told(pair)}"
        remark(case, "failure", "\n".join([versions, *rows]), message=message, type=kind)
    elif pair.word == "better":
        remark(case, "system-out", f"better: {words.told(pair)}")
    return case


def _uncompared(cells: Sequence[StoredCell], tag: str, why: str) -> list[Element]:
    cases = [_case(cell.name) for cell in cells]
    for case in cases:
        remark(case, tag, message=why)
    return cases


def _case(name: CellName) -> Element:
    return case_of(f"diff.{name.engine}.{name.variant}", name.label)
