"""The heat map of hard cases: cases by group, engines with their profiles, runs from easy to hard.

Shapes and words only: a cell says its outcome by a sign, and how large its error was by a shade.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from reports.output.numbers import error_text
from reports.stability.matrix import OUTCOMES, CaseFacts, Graded, Matrix, Outcome
from reports.stability.table import LETTERS

SIGNS: Mapping[str, str] = {str(name): letter for name, letter in LETTERS.items()} | {
    "ok": "\N{CHECK MARK}",
    "unsupported": "\N{EN DASH}",
}
"""One sign per outcome, so that the map is read without its colours: as on the terminal."""
STRANGE = "?"
"""The sign of an outcome that this page does not know."""
SHADES = (1e-6, 1e-4, 1e-2, 1.0)
"""Errors from which on a cell is a shade stronger: pure numbers."""
LONGEST = 200
"""Characters of a reason in the words of a cell; the whole of it is told where the run is."""
HeatKey = tuple[str, str]
"""An engine and its profile: a column of the map."""


@dataclass(frozen=True)
class HeatCell:
    """One value of a case in one column; ``number`` is that of its run, None where it was not run.

    ``kind`` names the outcome for the style sheet, ``shade`` goes from 0 to 4, and is -1 where the
    run has no error; ``held`` says that the outcome is one of an engine that holds.
    """

    number: int | None
    label: str
    sign: str
    kind: str
    shade: int
    held: bool
    words: str
    pictured: bool


@dataclass(frozen=True)
class Strip:
    """A case in one column: its cells from easy to hard, and how far it holds in words."""

    cells: tuple[HeatCell, ...]
    words: str


@dataclass(frozen=True)
class HeatRow:
    """A case with a strip for each column."""

    case: CaseFacts
    strips: tuple[Strip, ...]
    good: str


@dataclass(frozen=True)
class HeatColumn:
    """An engine with a profile, and in how many cases it holds throughout."""

    engine: str
    profile: str
    words: str

    @property
    def name(self) -> str:
        return f"{self.engine} {self.profile}"


@dataclass(frozen=True)
class Heat:
    """The whole map: columns, and rows by group in the order of the cases."""

    columns: tuple[HeatColumn, ...]
    groups: Mapping[str, tuple[HeatRow, ...]]


def kind(outcome: str) -> str:
    """An outcome as a name of the style sheet, whatever it is."""
    return outcome if outcome in OUTCOMES else "strange"


def sign(outcome: str) -> str:
    """The sign of an outcome."""
    return SIGNS.get(outcome, STRANGE)


def shade(error: float | None) -> int:
    """How strong an error is drawn, by its power of ten; -1 where it is no finite number."""
    if error is None or not math.isfinite(error):
        return -1
    return sum(error >= limit for limit in SHADES)


def amount(value: float | None, unit: str) -> str:
    """A value of a case with its unit."""
    return f"{'?' if value is None else f'{value:.6g}'} {unit}".strip()


def same(one: float | None, other: float | None) -> bool:
    """Whether two values of a case are one; what has no number is the same as itself."""
    if _lost(one) or _lost(other):
        return _lost(one) and _lost(other)
    return one == other


def heat(matrix: Matrix, pictured: frozenset[int] = frozenset()) -> Heat:
    """The map of a matrix; ``pictured`` are the runs that have a moving picture, by number."""
    lines = list(dict.fromkeys((run.engine, run.profile) for run in matrix.runs))
    numbered: dict[tuple[str, HeatKey], list[tuple[int, Graded]]] = {}
    for number, run in enumerate(matrix.runs):
        numbered.setdefault((run.case, (run.engine, run.profile)), []).append((number, run))
    words = {(one.case, (one.engine, one.profile)): one.words for one in matrix.critical}
    groups: dict[str, tuple[HeatRow, ...]] = {}
    for case in matrix.cases:
        strips = tuple(
            Strip(
                tuple(_cells(case, numbered.get((case.name, x), []), pictured)),
                words.get((case.name, x), ""),
            )
            for x in lines
        )
        row = HeatRow(case, strips, ", ".join(case.good))
        groups[case.group] = (*groups.get(case.group, ()), row)
    rows = [row for group in groups.values() for row in group]
    columns = [HeatColumn(*x, _held([row.strips[i] for row in rows])) for i, x in enumerate(lines)]
    return Heat(tuple(columns), groups)


def _held(strips: Sequence[Strip]) -> str:
    """In how many of its cases a column holds throughout."""
    run = [s for s in strips if any(cell.number is not None for cell in s.cells)]
    held = sum(all(cell.held for cell in s.cells if cell.number is not None) for s in run)
    return f"holds {held} of {len(run)} throughout"


def _cells(
    case: CaseFacts, runs: Sequence[tuple[int, Graded]], pictured: frozenset[int]
) -> Iterator[HeatCell]:
    """A cell for each value, whether it was run or not."""
    for value, label in zip(case.values, case.labels, strict=True):
        own = [pair for pair in runs if pair[1].grid and same(pair[1].value, value)]
        if not own:
            words = f"{amount(value, case.unit)}: not run"
            yield HeatCell(None, label, "\N{MIDDLE DOT}", "none", -1, False, words, False)
            continue
        number, run = own[0]
        yield HeatCell(
            number=number,
            label=label,
            sign=sign(run.outcome),
            kind=kind(run.outcome),
            shade=shade(run.error),
            held=run.outcome in case.good,
            words=told(case, run),
            pictured=number in pictured,
        )


def told(case: CaseFacts, run: Graded) -> str:
    """A run in words: value, outcome, error and reason."""
    holds = "holds" if run.outcome in case.good else "fails"
    reason = run.reason if len(run.reason) <= LONGEST else f"{run.reason[: LONGEST - 1]}\u2026"
    words = f"{amount(run.value, case.unit)}, {run.engine} {run.profile}: {run.outcome} ({holds})"
    return f"{words}; error {error_text(run.error)}" + (f"; {reason}" if reason else "")


def outcomes_seen(matrix: Matrix) -> dict[str, int]:
    """The outcomes of the grid with how often they came, known ones in their order, then others."""
    counts = Counter(str(run.outcome) for run in matrix.runs if run.grid)
    names: tuple[Outcome, ...] = OUTCOMES
    return {
        name: counts[name] for name in (*names, *sorted(set(counts) - set(names))) if counts[name]
    }


def _lost(value: float | None) -> bool:
    return value is None or math.isnan(value)
