"""The table of the cells of one profile: names, the largest errors, whose limit they are nearest
to, and what the error does when the step is halved; and what stands under the tables."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import cast

from rich.markup import escape
from rich.table import Table
from rich.text import Text

from reports.compare.errors import Error, largest
from reports.judge.cell import Checked
from reports.judge.rules import FORCES
from reports.judge.rules.rule import Finding
from reports.judge.three_steps import Convergence
from reports.output.console import plain_table
from reports.quantities import QUANTITIES

Texts = Callable[[Checked], Sequence[str]]
Part = tuple[int, Callable[[Sequence[Checked]], Sequence[str]]]
"""A part of what stands under the tables, its place among the others, and its lines for cells."""


def _none(one: Checked) -> Sequence[str]:
    return ()


@dataclass(frozen=True, eq=False)
class CellTable:
    """The columns of cells of a kind.

    ``numbers`` are quantities by the head of their column. ``rooms`` says for terminals of at least
    so many columns which heads are shown, and which of those that ``before`` fills before the share
    of a limit; ``after`` is filled behind it. From ``apart`` columns on the engine has its own.
    """

    title: str
    numbers: Mapping[str, Sequence[str]]
    rooms: Sequence[tuple[int, Sequence[str], Sequence[str]]]
    before: Texts = _none
    after_heads: Sequence[str] = ()
    after: Texts = _none
    apart: float = math.inf
    names: int = 18
    forces: bool = False

    def shown(self, profile: str, gated: bool, chosen: Sequence[Checked], width: int) -> Table:
        """The cells of one profile, those out of tolerance first."""
        heads, before = next(
            (heads, before) for least, heads, before in self.rooms if width >= least
        )
        apart = width >= self.apart
        role = "gated" if gated else "shown, not gated"
        table = plain_table(f"{self.title}profile {profile} ({role})")
        table.add_column("")
        table.add_column(
            "scene" if apart else "scene\nengine", overflow="fold", min_width=self.names
        )
        if apart:
            table.add_column("engine", no_wrap=True)
        for head in (*heads, *before):
            table.add_column(head, justify="right", no_wrap=True)
        for head in ("most of\na limit", *self.after_heads):
            table.add_column(head, no_wrap=True)
        least, most = (15, None) if apart else (None, 14)
        table.add_column("when dt\nis halved", overflow="fold", min_width=least, max_width=most)
        for one in sorted(chosen, key=lambda one: one.verdict == "within"):
            names = (one.cell.scene.name, one.cell.engine)
            *numbers, share, seen = row_cells(one, heads, self.numbers, forces=self.forces)
            more = self.before(one)[: len(before)]
            table.add_row(
                mark(one),
                *(names if apart else ["\n".join(names)]),
                *(*numbers, *more, share, *self.after(one), seen),
            )
        return table


MARKS = {
    "within": Text("ok", "green"),
    "out": Text("OUT", "bold red"),
    "unsupported": Text("NONE", "bold red"),
}
SHORT = {each.id: each.short for entry in QUANTITIES.values() for each in entry.criteria}
"""The rules that hold an error to a limit, short; a dash marks differenced rates."""


def mark(one: Checked) -> Text:
    """The verdict; red only where it counts."""
    shown = MARKS[one.verdict]
    return shown if one.cell.gated or one.verdict == "within" else Text(shown.plain, "yellow")


def row_cells(
    one: Checked,
    heads: Sequence[str],
    numbers: Mapping[str, Sequence[str]],
    *,
    forces: bool = False,
) -> list[Text | str]:
    """One row, from its numbers on; ``numbers`` are the quantities by head."""
    errors = one.errors
    if errors is None:
        return [*["-"] * len(heads), "", Text(f"{one.status}: {one.reason}", "red")]
    worst = (filter(None, map(errors.worst, numbers[head])) for head in heads)
    seen = halved(one, one.force_convergence if forces else one.convergence)
    own = [finding for finding in one.findings if (finding.rule in FORCES) == forces]
    return [*(_number(largest(each)) for each in worst), _share(own), seen]


def halved(one: Checked, convergence: Convergence | None) -> str:
    """What an error does when the step is halved, or how the run ended."""
    if one.status != "ok":
        early = one.status != "branch-changed"  # such a run goes on to its end
        return one.status + (f" at t = {one.stopped_at_s:.3g} s" if early else "")
    return convergence.words.replace(": ", "\n") if convergence else ""


def _number(error: Error | None) -> str:
    """A pure number, or a dash where nothing of the kind was reported."""
    return "-" if error is None else f"{error.pure:.1e}" if error.finite else "nan"


def _share(findings: Sequence[Finding]) -> Text:
    """The largest share of a limit that an error takes, and whose it is."""
    shares = [
        (finding.number / finding.limit, SHORT[finding.rule])
        for finding in findings
        if finding.rule in SHORT and finding.number is not None and finding.limit
    ]
    if not shares:
        return Text("")
    share, name = max(shares, key=lambda pair: math.inf if math.isnan(pair[0]) else pair[0])
    if math.isnan(share):
        return Text("nan", "red")
    size = f"{share:.0%}" if share < 10 else f"x{share:.0f}" if share < 1e4 else f"x{share:.0e}"
    style = "red" if share > 1 else "yellow" if share > 0.5 else ""
    return Text(f"{size} {name}", style)


UNITS, LINK_UNITS, OF_FORCES, MORE_UNITS, MORE_STEPS, NOTES, STEPS = range(7)
"""Places of parts: units and steps of cells stand there, those of free motion between."""
OF_FORCES_WORDS = (
    "Forces against kinetostatics at the instants that they act at; F largest reaction, M largest "
    "torque over the run."
)


def footer(checked: Sequence[Checked], facts: Mapping[str, str]) -> str:
    """Units, steps and versions."""
    of_all: list[Part] = [(OF_FORCES, _of_forces), (NOTES, _notes)]
    own = {part: [*checked] for part in of_all}
    for one in checked:
        for part in cast(Sequence[Part], one.cell.way.part("footer")):
            own.setdefault(part, []).append(one)
    parts = sorted(own, key=lambda part: part[0])
    lines = [line for part in parts for line in part[1](own[part])]
    lines.append(", ".join(f"{name} {value}" for name, value in facts.items()))
    return escape("\n".join(lines))


def _of_forces(checked: Sequence[Checked]) -> Sequence[str]:
    return [OF_FORCES_WORDS] * any(one.cell.with_forces for one in checked)


def _notes(checked: Sequence[Checked]) -> list[str]:
    """What is to be said of forces, and of free motion, once for a scene: counts may differ by a
    sample."""
    notes = dict[tuple[str, str], str]()
    for one in checked:
        told = one.cell.with_forces or one.cell.way.noted
        for note in one.errors.notes if told and one.errors else ():
            words = "".join(letter for letter in note if not letter.isdigit())
            notes.setdefault((one.cell.scene.name, words), f"{one.cell.scene.name}: {note}.")
    return list(notes.values())


def span(values: Sequence[float]) -> str:
    """One value, or the smallest and the largest."""
    low, high = f"{values[0]:.4g}", f"{values[-1]:.4g}"
    return low if low == high else f"{low} to {high}"
