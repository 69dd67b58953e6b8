"""A verification on the terminal: failures first with their cure, then the tables, then where the
numbers come from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from rich.console import Console
from rich.table import Table
from rich.text import Text

from reports.judge.cell import Checked
from reports.judge.rules import RULES
from reports.judge.rules.rule import Finding
from reports.output.columns import hanging, plain_table
from reports.output.numbers import count
from reports.quantities import QUANTITIES, named
from reports.verify.elastic_table import elastic_table
from reports.verify.footer import footer
from reports.verify.free_table import free_table
from reports.verify.row_cells import mark, row_cells

ANGLE, GAP, REACTION, TORQUE = (
    QUANTITIES[name].head for name in ("angle", "gap", "reaction", "torque")
)
NUMBERS = {
    entry.head: [name for name, each in QUANTITIES.items() if each.head == entry.head]
    for entry in QUANTITIES.values()
    if entry.head and entry.role not in ("force", "free", "elastic")
}
"""The columns of numbers: head, and the quantities that it shows the worst of."""
FORCE_NUMBERS = {QUANTITIES[name].head: [name] for name in named("force")}
"""Those of the table of forces."""
WIDE, STACKED = 100, 76
"""Columns of a terminal that show every number, below which the engine stands under the scene."""


def show(console: Console, checked: Sequence[Checked], facts: Mapping[str, str]) -> None:
    """Print the whole verification."""
    failed = [one for one in checked if one.cell.gated and one.verdict != "within"]
    _failures(console, failed)
    for profile, gated in dict.fromkeys((one.cell.profile, one.cell.gated) for one in checked):
        chosen = [one for one in checked if (one.cell.profile, one.cell.gated) == (profile, gated)]
        for kind, shown in TABLES.items():
            own = [one for one in chosen if _kind(one) == kind]
            if own:
                console.print(shown(profile, gated, own, console.width), "")
        loaded = [one for one in chosen if one.cell.with_forces and one.errors]
        if loaded:
            console.print(_table(profile, gated, loaded, console.width, forces=True), "")
    _advice(console, checked)
    console.print(_summary(checked, failed))
    console.print(footer(checked, facts), style="dim", highlight=False)


def _failures(console: Console, failed: Sequence[Checked]) -> None:
    """What is out of tolerance, cell by cell and with what was tried on it, then what would mend
    the others, rule by rule."""
    for one in failed:
        console.print(Text(f"{mark(one).plain}  {one.cell.label}", "bold red"))
        for finding in one.failures:
            rule = RULES[finding.rule]
            hanging(console, f"  {rule.id} ", f"{rule.title}: {finding.text}")
        if one.remedy:
            hanging(console, "  cure: ", one.remedy, style="cyan")
    cures = {(f.rule, f.cure) for one in failed for f in one.failures if f.cure != one.remedy}
    for rule_id, cure in sorted(cures):
        if cure:
            hanging(console, f"{rule_id} cure: ", cure, style="cyan")
    if failed:
        console.print()


def _heads(width: int, *, forces: bool) -> tuple[str, ...]:
    """The numbers that a terminal of a width has room for; the others are in the files."""
    if forces:
        return tuple(FORCE_NUMBERS) if width >= STACKED else (REACTION, TORQUE)
    if width >= WIDE:
        return tuple(NUMBERS)
    return (ANGLE, GAP) if width >= STACKED else (ANGLE,)


def _table(
    profile: str, gated: bool, chosen: Sequence[Checked], width: int, *, forces: bool = False
) -> Table:
    """The cells of one profile, those out of tolerance first: how they move, or their forces."""
    heads, stacked = _heads(width, forces=forces), width < STACKED
    role = "gated" if gated else "shown, not gated"
    table = plain_table(f"{'forces, ' * forces}profile {profile} ({role})")
    table.add_column("")
    table.add_column("scene\nengine" if stacked else "scene", overflow="fold", min_width=22)
    if not stacked:
        table.add_column("engine", no_wrap=True)
    for head in heads:
        table.add_column(head, justify="right", no_wrap=True)
    table.add_column("most of\na limit", no_wrap=True)
    least, most = (None, 14) if stacked else (15, None)
    table.add_column("when dt\nis halved", overflow="fold", min_width=least, max_width=most)
    for one in sorted(chosen, key=lambda one: one.verdict == "within"):
        names = (one.cell.scene.name, one.cell.engine)
        numbers = row_cells(one, heads, FORCE_NUMBERS if forces else NUMBERS, forces=forces)
        table.add_row(mark(one), *(["\n".join(names)] if stacked else names), *numbers)
    return table


def _kind(one: Checked) -> str:
    """The table that a cell stands in."""
    if one.cell.scene.elastic:
        return "elastic"
    return "free" if one.cell.drive == "free" else "driven"


TABLES = {"driven": _table, "free": free_table, "elastic": elastic_table}
"""By what the cells are of."""


def _advice(console: Console, checked: Sequence[Checked]) -> None:
    """What is not a failure and still worth knowing: one line per rule, profile and engine."""
    groups: dict[tuple[str, str, str], list[tuple[Checked, Finding]]] = {}
    for one in checked:
        for finding in one.advice:
            key = (finding.rule, one.cell.engine, one.cell.profile)
            groups.setdefault(key, []).append((one, finding))
    for (rule, engine, profile), members in groups.items():
        one, finding = members[0]
        others = f" (and {count(len(members) - 1, 'more scene')})" if len(members) > 1 else ""
        head = f"{rule} {engine} {profile}, {one.cell.scene.name}{others}: "
        console.print(Text(f"{head}{finding.text}"))
        console.print(Text(f"  {finding.cure}", "cyan"))
    if groups:
        console.print()


def _summary(checked: Sequence[Checked], failed: Sequence[Checked]) -> Text:
    """The verdict in one line."""
    gated = [one for one in checked if one.cell.gated]
    scenes = len({one.cell.scene.name for one in gated})
    engines = len({one.cell.engine for one in gated})
    counted = f"{count(scenes, 'scene')} x {count(engines, 'engine')}"
    what = f"{count(len(gated), 'cell')} ({counted})"
    if failed:
        return Text(f"OUT OF TOLERANCE: {len(failed)} of {what}", "bold red")
    every = "all " if len(gated) > 1 else ""
    return Text(f"WITHIN TOLERANCE: {every}{what}", "bold green")
