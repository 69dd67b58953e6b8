"""A verification on the terminal, failures first with their cure, then the tables, then where the
numbers come from; and as JUnit XML."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import cast
from xml.etree.ElementTree import Element

from rich.console import Console
from rich.text import Text

from reports.judge.cell import Checked
from reports.judge.rules import RULES
from reports.judge.rules.rule import Finding
from reports.output.console import hanging
from reports.output.junit import case_of, remark, suite_of
from reports.output.numbers import count
from reports.quantities import QUANTITIES, named
from reports.verify.cell_table import CellTable, footer, mark
from reports.way.way import WAYS

REACTION, TORQUE = QUANTITIES["reaction"].head, QUANTITIES["torque"].head
FORCE_NUMBERS = {QUANTITIES[name].head: [name] for name in named("force")}
FORCE_TABLE = CellTable(
    "forces, ", FORCE_NUMBERS, ((76, tuple(FORCE_NUMBERS), ()), (0, (REACTION, TORQUE), ())),
    apart=76, names=22, forces=True,
)  # fmt: skip


def show(console: Console, checked: Sequence[Checked], facts: Mapping[str, str]) -> None:
    """Print the whole verification."""
    failed = [one for one in checked if one.cell.gated and one.verdict != "within"]
    _failures(console, failed)
    for profile, gated in dict.fromkeys((one.cell.profile, one.cell.gated) for one in checked):
        chosen = [one for one in checked if (one.cell.profile, one.cell.gated) == (profile, gated)]
        for table in _tables(chosen):
            own = [one for one in chosen if one.cell.way.part("table") is table]
            console.print(table.shown(profile, gated, own, console.width), "")
        loaded = [one for one in chosen if one.cell.with_forces and one.errors]
        if loaded:
            console.print(FORCE_TABLE.shown(profile, gated, loaded, console.width), "")
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


def _tables(checked: Sequence[Checked]) -> list[CellTable]:
    """Those of the cells, the most general first."""
    ways = {one.cell.way.name: one.cell.way for one in checked}
    return list(
        dict.fromkeys(
            cast(CellTable, ways[name].part("table")) for name in reversed(WAYS) if name in ways
        )
    )


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


def suite(checked: Sequence[Checked], facts: Mapping[str, str]) -> Element:
    """One test case per cell; a cell that is shown without being gated is skipped, with its
    findings in the message."""
    return suite_of(
        "verify",
        [_case(one) for one in checked],
        facts,
        time=f"{sum(one.wall_s for one in checked):.3f}",
        timestamp=facts["made"].removesuffix("+00:00"),
    )


def _case(one: Checked) -> Element:
    """One cell."""
    cell = one.cell
    case = case_of(f"{cell.engine}.{cell.profile}", cell.scene.name, f"{one.wall_s:.3f}")
    text = "\n".join(_line(finding) for finding in one.failures)
    head = one.failures[0].text if one.failures else "within tolerance"
    if not cell.gated:
        remark(case, "skipped", message=f"shown, not gated: {head}")
    elif one.verdict == "unsupported":
        remark(case, "error", text, message=head, type="unsupported")
    elif one.failures:
        remark(case, "failure", text, message=head, type=one.failures[0].rule)
    if one.advice:
        remark(case, "system-out", "\n".join(_line(finding) for finding in one.advice))
    return case


def _line(finding: Finding) -> str:
    """A finding with its rule and cure."""
    rule = RULES[finding.rule]
    return f"{rule.id} {rule.title}: {finding.text}" + (
        f"\n  cure: {finding.cure}" if finding.cure else ""
    )
