"""A verification on the terminal: failures first with their cure, then the tables, then where the
numbers come from."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from rich.console import Console
from rich.markup import escape
from rich.table import Table
from rich.text import Text

from reports.compare.errors import Error, Errors, largest
from reports.judge.cell import Checked
from reports.judge.precision import precision
from reports.judge.rules import FORCES, RULES
from reports.judge.rules.rule import Finding
from reports.output.columns import hanging, plain_table
from reports.output.numbers import count
from reports.quantities import QUANTITIES, named

MARKS = {
    "within": Text("ok", "green"),
    "out": Text("OUT", "bold red"),
    "unsupported": Text("NONE", "bold red"),
}


ANGLE, GAP, REACTION, TORQUE = (
    QUANTITIES[name].head for name in ("angle", "gap", "reaction", "torque")
)
NUMBERS = {
    entry.head: [name for name, each in QUANTITIES.items() if each.head == entry.head]
    for entry in QUANTITIES.values()
    if entry.head and entry.role not in ("force", "free")
}
"""The columns of numbers: head, and the quantities that it shows the worst of."""
FORCE_NUMBERS = {QUANTITIES[name].head: [name] for name in named("force")}
"""Those of the table of forces."""
FREE_NUMBERS = {
    QUANTITIES["phase"].head: ["phase"],
    "place\n/ G": list(named("place")),
    QUANTITIES["geometry"].head: ["geometry"],
    GAP: ["gap"],
    "veloc.\n/ w G": ["velocity"],
    QUANTITIES["energy"].head: ["energy"],
}
"""Those of the table of what was let go."""
DRIVEN_SAID = (
    "Largest errors against the closed form at the commanded time; L longest link, w driver's peak "
    "speed."
)
FREE_SAID = (
    "Let go: errors at the same time over G, by how much a small change of the start has grown; "
    "geometry at the run's own angle; drift of energy over the largest kinetic energy T. Classes: "
    "fine is a thousandth of the limit of the phase; 1e-1 and 1e-3 of the error as it is, and to "
    "when 1e-3 holds."
)
FORCES_SAID = (
    "Forces against kinetostatics at the instants that they act at; F largest reaction, M largest "
    "torque over the run."
)
WIDE, STACKED = 100, 76
FREE_WIDE = 110
"""Columns of a terminal that show every number, below which the engine stands under the scene, and
that show every number of free motion."""


def show(console: Console, checked: Sequence[Checked], facts: Mapping[str, str]) -> None:
    """Print the whole verification."""
    failed = [one for one in checked if one.cell.gated and one.verdict != "within"]
    _failures(console, failed)
    for profile, gated in dict.fromkeys((one.cell.profile, one.cell.gated) for one in checked):
        chosen = [one for one in checked if (one.cell.profile, one.cell.gated) == (profile, gated)]
        for free in (False, True):
            own = [one for one in chosen if (one.cell.drive == "free") == free]
            if own:
                shown = _free_table if free else _table
                console.print(shown(profile, gated, own, console.width), "")
        loaded = [one for one in chosen if one.cell.with_forces and one.errors]
        if loaded:
            console.print(_table(profile, gated, loaded, console.width, forces=True), "")
    _advice(console, checked)
    console.print(_summary(checked, failed))
    console.print(_footer(checked, facts), style="dim", highlight=False)


def _failures(console: Console, failed: Sequence[Checked]) -> None:
    """What is out of tolerance, cell by cell and with what was tried on it, then what would mend
    the others, rule by rule."""
    for one in failed:
        console.print(Text(f"{_mark(one).plain}  {one.cell.label}", "bold red"))
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


def _mark(one: Checked) -> Text:
    """The verdict; red only where it counts."""
    mark = MARKS[one.verdict]
    return mark if one.cell.gated or one.verdict == "within" else Text(mark.plain, "yellow")


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
        numbers = _cells(one, heads, forces=forces)
        table.add_row(_mark(one), *(["\n".join(names)] if stacked else names), *numbers)
    return table


def _free_table(profile: str, gated: bool, chosen: Sequence[Checked], width: int) -> Table:
    """The cells of one profile that were let go, those out of tolerance first."""
    heads, stacked = tuple(FREE_NUMBERS), width < STACKED
    heads = heads if width >= FREE_WIDE else (heads[0], heads[2], heads[5])[: 1 if stacked else 3]
    role = "gated" if gated else "shown, not gated"
    table = plain_table(f"free motion, profile {profile} ({role})")
    table.add_column("")
    table.add_column("scene\nengine", overflow="fold", min_width=18)
    for head in heads:
        table.add_column(head, justify="right", no_wrap=True)
    table.add_column("most of\na limit", no_wrap=True)
    table.add_column("class\nto 1e-3", no_wrap=True)
    table.add_column("when dt\nis halved", overflow="fold", max_width=14)
    for one in sorted(chosen, key=lambda one: one.verdict == "within"):
        names = f"{one.cell.scene.name}\n{one.cell.engine}"
        *numbers, seen = _cells(one, heads, forces=False, numbers=FREE_NUMBERS)
        table.add_row(_mark(one), names, *numbers, _precision(one), seen)
    return table


def _precision(one: Checked) -> str:
    """The classes that are reached, and the time to which the high one of IFToMM's is."""
    facts = one.errors.free if one.errors else None
    return f"{precision(one)}\n{facts.horizon_s(1e-3):.3g} s" if facts else "-"


def _cells(
    one: Checked,
    heads: Sequence[str],
    *,
    forces: bool,
    numbers: Mapping[str, Sequence[str]] | None = None,
) -> list[Text | str]:
    """One row, from its numbers on."""
    errors = one.errors
    if errors is None:
        return [*["-"] * len(heads), "", Text(f"{one.status}: {one.reason}", "red")]
    of_head = numbers or (FORCE_NUMBERS if forces else NUMBERS)
    shown = [_largest(errors, of_head[head]) for head in heads]
    convergence = one.force_convergence if forces else one.convergence
    seen = convergence.words.replace(": ", "\n") if convergence else ""
    if one.status != "ok":
        early = one.status != "branch-changed"  # such a run goes on to its end
        seen = one.status + (f" at t = {one.stopped_at_s:.3g} s" if early else "")
    own = [finding for finding in one.findings if (finding.rule in FORCES) == forces]
    return [*(_number(error) for error in shown), _share(own), seen]


def _largest(errors: Errors, quantities: Sequence[str]) -> Error | None:
    """The worst of some quantities, as reported."""
    return largest(worst for name in quantities if (worst := errors.worst(name)))


def _number(error: Error | None) -> str:
    """A pure number, or a dash where nothing of the kind was reported."""
    return "-" if error is None else f"{error.pure:.1e}" if error.finite else "nan"


SHORT = {each.id: each.short for entry in QUANTITIES.values() for each in entry.criteria}
"""The rules that hold an error to a limit, short; a dash marks differenced rates."""


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


def _footer(checked: Sequence[Checked], facts: Mapping[str, str]) -> str:
    """Units, steps and versions."""
    free = [one for one in checked if one.cell.drive == "free"]
    driven = [one for one in checked if one.cell.drive != "free"]
    lines = [
        *([DRIVEN_SAID] if driven else ()),
        *(FORCES_SAID for _ in checked[:1] if any(one.cell.with_forces for one in checked)),
        *(_free_words(free) if free else ()),
        *_notes(checked),
        *(_driven_steps(driven) if driven else ()),
        ", ".join(f"{name} {value}" for name, value in facts.items()),
    ]
    return escape("\n".join(lines))


def _driven_steps(driven: Sequence[Checked]) -> list[str]:
    """How driven cells were stepped."""
    steps = sorted({round(one.cell.steps_per_turn, 3) for one in driven})
    turns = sorted({round(one.cell.turns, 3) for one in driven})
    dts = sorted({one.cell.dt_s for one in driven})
    drives = [e for one in driven if one.errors and (e := one.errors.worst("drive"))]
    drive = largest(drives)
    turned = f"{_span(turns)} turn" + ("" if turns == [1.0] else "s")
    return [
        f"dt {_span(dts)} s, {_span(steps)} steps a turn, {turned}; "
        + (f"largest drive error {drive.maximum:.1e} rad; " if drive else "")
        + "- not reported."
    ]


def _free_words(free: Sequence[Checked]) -> list[str]:
    """What the numbers of free cells are, and how these were stepped."""
    dts = sorted({one.cell.dt_s for one in free})
    lasts = sorted({round(one.cell.dt_s * one.cell.steps, 9) for one in free})
    growth = sorted(one.errors.free.sensitivity for one in free if one.errors and one.errors.free)
    return [
        FREE_SAID,
        f"dt {_span(dts)} s over {_span(lasts)} s"
        + (f"; G up to {_span(growth)}" if growth else "")
        + "; - not reported.",
    ]


def _notes(checked: Sequence[Checked]) -> list[str]:
    """What is to be said of forces, and of free motion, once for a scene: counts may differ by a
    sample."""
    notes = dict[tuple[str, str], str]()
    for one in checked:
        told = one.cell.with_forces or one.cell.drive == "free"
        for note in one.errors.notes if told and one.errors else ():
            words = "".join(letter for letter in note if not letter.isdigit())
            notes.setdefault((one.cell.scene.name, words), f"{one.cell.scene.name}: {note}.")
    return list(notes.values())


def _span(values: Sequence[float]) -> str:
    """One value, or the smallest and the largest."""
    low, high = f"{values[0]:.4g}", f"{values[-1]:.4g}"
    return low if low == high else f"{low} to {high}"
