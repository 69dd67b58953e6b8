"""Hard cases compared with an earlier run of them: outcomes that got worse, and critical values
that moved by more than their doubt.

A critical value is known to lie between the hardest value that holds and the easiest that fails. It
moved where these ranges of both runs have no value in common.
"""

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from rich.console import Console

from models.errors import CrankcheckError, few
from reports.output.console import hanging, say
from reports.stability.matrix import (
    OUTCOMES,
    CaseFacts,
    Critical,
    Graded,
    Line,
    Matrix,
    label,
    read_matrix,
)
from reports.stability.running import CaseLine, harder

ROUNDING = 1.1
"""Growth of the largest error up to which another outcome is no change: processors differ by
less."""
Word = Literal["worse", "better", "not compared"]


@dataclass(frozen=True)
class LineChange:
    """Change of a case in an engine with a profile, and its description."""

    word: Word
    line: Line
    text: str


def baseline(place: Path, planned: Iterable[CaseLine]) -> Matrix:
    """Return the earlier run in a folder or file. Raises CrankcheckError where it can not be read,
    or none of its lines is ``planned`` now."""
    old = read_matrix(place)
    if not old.lines.keys() & {each.line for each in planned}:
        held = few((" ".join(line) for line in old.lines), 3)
        raise CrankcheckError(
            f"--baseline {place}: holds no case, engine and profile that is to run now, but {held}"
        )
    return old


def changes(old: Matrix, new: Matrix) -> list[LineChange]:
    """Return the changes of all lines of either run, the worse ones first."""
    before, now = old.lines, new.lines
    found = []
    for line in {**before, **now}:
        if line not in now or line not in before:
            found.append(LineChange("not compared", line, "new" if line in now else "not run now"))
        elif old.case(line[0]).meaning != new.case(line[0]).meaning:
            found.append(LineChange("not compared", line, "the case is another one now"))
        else:
            found += _changes(old, new, before[line], now[line])
    return sorted(found, key=lambda change: change.word != "worse")


def _changes(old: Matrix, new: Matrix, was: Critical, now: Critical) -> Iterator[LineChange]:
    """Yield the changes of one line: of each value of both runs, and of the critical value."""
    line, case = now.line, new.case(now.case)
    before, after = old.runs_of(line), new.runs_of(line)
    unit = f" [{case.unit}]" if case.unit else ""
    for value in (each for each in case.values if each in before and each in after):
        first, last = before[value], after[value]
        ranks = _rank(case, first), _rank(case, last)
        if ranks[0] != ranks[1] and not _within_rounding(first, last):
            words = f"at {label(value)}{unit} {first.outcome} before, {last.outcome} now"
            yield LineChange("worse" if ranks[1] > ranks[0] else "better", line, words)
    moved: tuple[tuple[Word, Critical, Critical], ...] = ("worse", was, now), ("better", now, was)
    for word, hard, easy in moved:
        if harder(case) * easy.fails < harder(case) * hard.holds:  # false where either is NaN
            words = f"critical value{unit} {_bracket(was)} before, {_bracket(now)} now"
            yield LineChange(word, line, words)


def _rank(case: CaseFacts, run: Graded) -> int:
    """Return how bad an outcome is: 0 for the good ones of the case, the others in their order."""
    return 0 if run.outcome in case.good else 1 + OUTCOMES.index(run.outcome)


def _within_rounding(old: Graded, new: Graded) -> bool:
    """True if the largest error of a run differs so little that its outcome is one of chance."""
    small, large = sorted(np.nanmax([run.error, run.gap, run.drive, 0.0]) for run in (old, new))
    return math.isfinite(old.error + new.error) and bool(large <= ROUNDING * small)


def _bracket(critical: Critical) -> str:
    """Return the hardest value that holds and the easiest that fails."""
    ends = ("holds", critical.holds), ("fails", critical.fails)
    return ", ".join(f"{word} {label(value)}" for word, value in ends if not math.isnan(value))


def is_worse(found: Iterable[LineChange]) -> bool:
    """True if anything got worse."""
    return any(change.word == "worse" for change in found)


def show_changes(console: Console, found: Sequence[LineChange]) -> None:
    """Print the verdict, then each change with its case, engine and profile."""
    counts = {"worse": 0, "better": 0} | Counter(each.word for each in found)
    verdict, style = ("WORSE", "bold red") if is_worse(found) else ("NOT WORSE", "bold green")
    say(console, f"{verdict}: {', '.join(f'{n} {word}' for word, n in counts.items())}", style)
    for each in found:
        hanging(console, f"  {each.word} ", f"{' '.join(each.line)}: {each.text}")
