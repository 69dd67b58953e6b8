"""The clauses with what came of them, on the terminal."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import Console
from rich.padding import Padding
from rich.text import Text

from models.errors import few, harmless
from reports.contract.ruling import Ruling
from reports.output.numbers import count

MARKS = {"held": ("ok ", "green"), "broken": ("OUT", "bold red"), "not tried": ("-  ", "dim")}
BREACHES = 4
"""That are told of a clause; the others are counted."""
INDENT = 10


def show(console: Console, called: str, rulings: Sequence[Ruling], scenes: Sequence[str]) -> None:
    """A line for each clause; below it what breaks it, why it matters and what to look at."""
    for ruling in rulings:
        mark, style = MARKS[ruling.answer]
        line = Text(f"{mark} {ruling.id}  ", style)
        line.append(ruling.clause.title, "" if ruling.answer == "held" else style)
        console.print(line, highlight=False)
        for text in _below(ruling):
            below = Text(harmless(text), "dim" if ruling.answer == "not tried" else "")
            console.print(Padding(below, (0, 0, 0, INDENT)), highlight=False)
    console.print()
    console.print(_verdict(called, rulings), highlight=False)
    if held := [name for name in scenes if any(name in ruling.scenes for ruling in rulings)]:
        console.print(f"Tried on {', '.join(held)}.", style="dim", highlight=False)
    for text in _refused(rulings, scenes):
        console.print(Text(harmless(text), "dim"), highlight=False)


def _below(ruling: Ruling) -> list[str]:
    """What is to be said of a clause that is not held."""
    if ruling.answer == "held":
        return []
    if ruling.answer == "not tried":
        return list(dict.fromkeys(text.partition(": ")[2] for text in ruling.untried))[:1]
    lines = [*ruling.breaches[:BREACHES]]
    if left := len(ruling.breaches) - len(lines):
        lines.append(f"and {left} more")
    return [*lines, f"why: {ruling.clause.why}", f"cure: {ruling.clause.cure}"]


def _verdict(called: str, rulings: Sequence[Ruling]) -> Text:
    broken = [ruling.id for ruling in rulings if ruling.answer == "broken"]
    held = sum(ruling.answer == "held" for ruling in rulings)
    if broken:
        told = f"{count(len(broken), 'clause')} of {len(rulings)}: {few(broken, 8)}"
        return Text(f"BREAKS THE CONTRACT: {called}, {told}", "bold red")
    if not held:
        return Text(f"NOTHING COULD BE TRIED: {called} refuses every scene", "bold red")
    return Text(f"HOLDS THE CONTRACT: {called}, {held} of {count(held, 'clause')}", "bold green")


def _refused(rulings: Sequence[Ruling], scenes: Sequence[str]) -> list[str]:
    """The scenes that no clause could be tried on, and why."""
    tried = {name for ruling in rulings for name in ruling.scenes}
    tried |= {text.partition(": ")[0] for ruling in rulings for text in ruling.breaches}
    reasons: dict[str, str] = {}
    for ruling in rulings:
        for text in ruling.untried:
            name, _, why = text.partition(": ")
            if name not in tried:
                reasons.setdefault(name, why)
    return [f"Refused: {name}: {reasons[name]}" for name in scenes if name in reasons]
