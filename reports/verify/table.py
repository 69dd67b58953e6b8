"""A verification on the terminal, failures first with their cure, then the tables, then the origin
of the numbers; and as JUnit XML.

The heads of columns stand in `reports.quantities`, footers and room in ``reports/ways/*/table.py``.
"""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import cast
from xml.etree.ElementTree import Element

from rich.console import Console
from rich.markup import escape
from rich.table import Table
from rich.text import Text

from reports.compare.errors import Error, largest
from reports.compare.worlds import MOST_ALONE
from reports.judge.cell import Checked
from reports.judge.rules import FORCES, RULES, titled
from reports.judge.rules.rule import Finding
from reports.judge.three_steps import Convergence
from reports.output.console import grid, hanging, show_failed
from reports.output.formats import case_of, remark, suite_of
from reports.output.numbers import count, readable
from reports.output.palette import engine_styles
from reports.plan.requirements import PROFILES
from reports.protocol.way import WAYS
from reports.quantities import QUANTITIES, named
from sim.registry import declaration

Texts = Callable[[Checked], Sequence[str]]
Styles = Mapping[str, str]
Part = tuple[int, Callable[[Sequence[Checked]], Sequence[str]]]
"""A part of the text below the tables, its place among the others, and its lines for cells."""


HALVED = "when dt\nis halved"


def _none(one: Checked) -> Sequence[str]:
    return ()


@dataclass(frozen=True, eq=False)
class CellTable:
    """The columns of cells of a kind.

    ``numbers`` are quantities by the head of their column. ``rooms`` lists, for terminals of at
    least so many columns, the heads shown, and those filled by ``before``, before the share of a
    limit; ``after`` comes behind it, and ``last`` at the end. From ``apart`` columns on the engine
    has its own.
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
    last: str = HALVED

    def shown(self, role: str, chosen: Sequence[Checked], width: int, styles: Styles) -> Table:
        """Return the cells of one profile in a role, those out of tolerance first; ``styles`` are
        those of engines' names."""
        heads, before = next(
            (heads, before) for least, heads, before in self.rooms if width >= least
        )
        apart = width >= self.apart
        first = ("scene", "engine") if apart else ("scene\nengine",)
        after = ("error /\nlimit", *self.after_heads)
        table = grid(
            ("", *first, *(f"{head}:" for head in (*heads, *before)), *after, self.last),
            title=f"{self.title}profile {role}",
            gap=1,
            whole=("engine", *after),
            cut=("",),
            least={first[0]: self.names} | ({self.last: 15} if apart else {}),
        )
        table.columns[-1].max_width = None if apart else 14
        shares = []
        for one in sorted(chosen, key=lambda one: one.verdict == "within"):
            engine = one.cell.engine
            names = (Text(one.cell.scene.name), Text(engine, styles[engine]))
            *numbers, share, seen = row_cells(one, heads, self.numbers, forces=self.forces)
            more = self.before(one)[: len(before)]
            shares.append(str(share))
            table.add_row(
                mark(one),
                *(names if apart else [Text("\n").join(names)]),
                *(*numbers, *more, share, *self.after(one), seen),
            )
        table.caption = Text(_words_of_rules(shares), "dim")
        table.caption_justify = "left"
        return table


MARKS = {
    "within": Text("ok", "green"),
    "out": Text("OUT", "bold red"),
    "known": Text("known", "yellow"),
    "unsupported": Text("NONE", "bold red"),
}
SHORT = {each.id: each.short for entry in QUANTITIES.values() for each in entry.criteria}
"""The rules that compare an error with a limit, short; a dash marks differenced rates."""


def mark(one: Checked) -> Text:
    """Return the verdict; red only where it counts."""
    shown = MARKS[one.verdict]
    return shown if one.cell.gated or one.verdict == "within" else Text(shown.plain, "yellow")


def row_cells(
    one: Checked,
    heads: Sequence[str],
    numbers: Mapping[str, Sequence[str]],
    *,
    forces: bool = False,
) -> list[Text | str]:
    """Return one row, from its numbers on; ``numbers`` are the quantities by head."""
    errors = one.errors
    if errors is None:
        return [*["-"] * len(heads), "", Text(f"{one.status}: {one.reason}", "red")]
    worst = (filter(None, map(errors.worst, numbers[head])) for head in heads)
    seen = halved(one, one.force_convergence if forces else one.convergence)
    own = [finding for finding in one.findings if (finding.rule in FORCES) == forces]
    return [*(_number(largest(each)) for each in worst), _share(own), seen]


def halved(one: Checked, convergence: Convergence | None) -> str:
    """Return the convergence of an error when the step is halved, or how the run ended."""
    if one.status != "ok":
        early = one.status != "branch-changed"  # such a run goes on to its end
        return one.status + (f" at t = {one.stopped_at_s:.3g} s" if early else "")
    return convergence.words.replace(": ", "\n") if convergence else ""


def _number(error: Error | None) -> str:
    return "-" if error is None else f"{error.pure:.1e}" if error.finite else "nan"


def _share(findings: Sequence[Finding]) -> Text:
    own = [each for each in findings if each.rule in SHORT and not math.isnan(each.taken)]
    if not own:
        return Text("")
    worst = max(own, key=lambda finding: finding.taken)
    share, name = worst.taken, SHORT[worst.rule]
    style = "red" if share > 1 else "yellow" if share > 0.5 else ""
    return Text(f"{readable(share, 2)} {name}", style)


def _words_of_rules(shares: Iterable[str]) -> str:
    """Return the meaning of the short names of rules behind such shares of a limit."""
    named = dict.fromkeys(share.rpartition(" ")[2] for share in shares)
    told = [f"{SHORT[rule]} {RULES[rule].title}" for rule in SHORT if SHORT[rule] in named]
    return f"error / limit: {'; '.join(told)}" if told else ""


UNITS, LINK_UNITS, OF_FORCES, MORE_UNITS, MORE_STEPS, NOTES, STEPS, BATCHES, SLOW = range(9)
"""Places of parts: units and steps of cells, with those of free motion between."""
OF_FORCES_WORDS = (
    "Forces against kinetostatics at their own instants; F largest reaction, M largest torque over "
    "the run."
)


OF_BATCHES_WORDS = (
    "Batches: the cranks of the worlds, numbered from 0, start spread over a turn; errors are the "
    "largest of all worlds. From alone: largest difference of place [rad, or of L] from at most "
    f"{MOST_ALONE} worlds that are run alone too, 0 to the bit. Costs are those of a step of one "
    "world, logged, one run at a time, without compiling; alone: the median."
)


def footer(checked: Sequence[Checked], facts: Mapping[str, str]) -> str:
    """Return units, steps and versions."""
    of_all: list[Part] = [(OF_FORCES, _of_forces), (NOTES, _notes), (SLOW, _slow)]
    of_all.append((BATCHES, _of_batches))
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


def _of_batches(checked: Sequence[Checked]) -> Sequence[str]:
    return [OF_BATCHES_WORDS] * any(one.cell.worlds for one in checked)


def _notes(checked: Sequence[Checked]) -> list[str]:
    """Return notes on forces and free motion, once for a scene: counts may differ by a sample."""
    notes = dict[tuple[str, str], str]()
    for one in checked:
        told = one.cell.with_forces or one.cell.way.noted
        for note in one.errors.notes if told and one.errors else ():
            words = "".join(letter for letter in note if not letter.isdigit())
            notes.setdefault((one.cell.scene.name, words), f"{one.cell.scene.name}: {note}.")
    return list(notes.values())


def _slow(checked: Sequence[Checked]) -> list[str]:
    """Return the defaults of engines whose steps take long, each once."""
    names = {one.cell.engine: one.cell.worlds for one in checked}
    found = {name: declaration(name).fewer for name in names}
    return [
        f"{name}: slow on a processor; by default {fewer.steps_per_turn:g} steps a turn, "
        f"{fewer.lasts(in_batch=bool(names[name]))}, and {count(len(fewer.scenes), 'scene')} where "
        "none is named."
        for name, fewer in found.items()
        if fewer
    ]


def span(values: Sequence[float]) -> str:
    """Return one value, or the smallest and the largest."""
    low, high = f"{values[0]:.4g}", f"{values[-1]:.4g}"
    return low if low == high else f"{low} to {high}"


REACTION, TORQUE = QUANTITIES["reaction"].head, QUANTITIES["torque"].head
FORCE_NUMBERS = {QUANTITIES[name].head: [name] for name in named("force")}
FORCE_TABLE = CellTable(
    "forces, ", FORCE_NUMBERS, ((76, tuple(FORCE_NUMBERS), ()), (0, (REACTION, TORQUE), ())),
    apart=76, names=22, forces=True,
)  # fmt: skip


def show(console: Console, checked: Sequence[Checked], facts: Mapping[str, str]) -> None:
    """Print the whole verification."""
    out = [one for one in checked if one.verdict not in ("within", "known")]
    _failures(console, [one for one in out if one.cell.gated or one.cell.profile not in PROFILES])
    styles = engine_styles(one.cell.engine for one in checked)
    for profile, gated in dict.fromkeys((one.cell.profile, one.cell.gated) for one in checked):
        chosen = [one for one in checked if (one.cell.profile, one.cell.gated) == (profile, gated)]
        role = f"{profile} ({'gated' if gated else 'shown, not gated'})"
        for table in _tables(chosen):
            own = [one for one in chosen if _table(one) is table]
            console.print(table.shown(role, own, console.width, styles), "")
        loaded = [one for one in chosen if one.cell.with_forces and one.errors]
        if loaded:
            console.print(FORCE_TABLE.shown(role, loaded, console.width, styles), "")
    _advice(console, checked)
    for one in checked:
        if text := one.known_text:
            hanging(console, f"{one.cell.label}: ", text, style="yellow")
    console.print(summary(checked))
    console.print(footer(checked, facts), style="dim", highlight=False)


def _failures(console: Console, failed: Sequence[Checked]) -> None:
    """Print the failures by cell with the tried remedies, then the cures of the others by rule."""
    for one in failed:
        head = f"{mark(one).plain}  {one.cell.label}" + " (not gated)" * (not one.cell.gated)
        show_failed(console, head, titled(one.failures), one.remedy)
    cures = {(f.rule, f.cure) for one in failed for f in one.failures if f.cure != one.remedy}
    for rule_id, cure in sorted(cures):
        if cure:
            hanging(console, f"{rule_id} cure: ", cure, style="cyan")
    if failed:
        console.print()


def _tables(checked: Sequence[Checked]) -> list[CellTable]:
    """Return the tables of the cells, the most general first."""
    ordered = sorted(checked, key=lambda one: -WAYS.index(one.cell.way.name))
    return list(dict.fromkeys(map(_table, ordered)))


def _table(one: Checked) -> CellTable:
    return cast(CellTable, one.cell.way.part("batches" if one.cell.worlds else "table"))


def _advice(console: Console, checked: Sequence[Checked]) -> None:
    """Print advice that is no failure: one line per rule, profile and engine."""
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
        if finding.cure:
            console.print(Text(f"  {finding.cure}", "cyan"))
    if groups:
        console.print()


def summary(checked: Sequence[Checked]) -> Text:
    """Return the verdict on all gated cells, in a line."""
    gated = [one for one in checked if one.cell.gated]
    failed = [one for one in gated if one.verdict not in ("within", "known")]
    scenes = len({one.cell.scene.name for one in gated})
    engines = len({one.cell.engine for one in gated})
    counted = f"{count(scenes, 'scene')} x {count(engines, 'engine')}"
    what = f"{count(len(gated), 'cell')} ({counted})"
    if failed:
        return Text(f"OUT OF TOLERANCE: {len(failed)} of {what}", "bold red")
    known = sum(one.verdict == "known" for one in gated)
    every = f"{len(gated) - known} of " if known else "all " if len(gated) > 1 else ""
    more = f"; {count(known, 'known failure')}" if known else ""
    return Text(f"WITHIN TOLERANCE: {every}{what}{more}", "bold green")


def suite(checked: Sequence[Checked], facts: Mapping[str, str]) -> Element:
    """Return one test case per cell; a cell that is shown without being gated is skipped, with its
    findings in the message."""
    return suite_of(
        "verify",
        [_case(one) for one in checked],
        facts,
        time=f"{sum(one.wall_s for one in checked):.3f}",
        timestamp=facts["made"].removesuffix("+00:00"),
    )


def _case(one: Checked) -> Element:
    cell = one.cell
    name = f"{cell.scene.name}{cell.in_batch}"
    case = case_of(f"{cell.engine}.{cell.profile}", name, f"{one.wall_s:.3f}")
    text = "\n".join(_line(finding) for finding in one.failures)
    head = one.failures[0].text if one.failures else "within tolerance"
    if not cell.gated:
        remark(case, "skipped", message=f"shown, not gated: {head}")
    elif one.verdict == "unsupported":
        remark(case, "error", text, message=head, type="unsupported")
    elif one.is_known:
        remark(case, "skipped", message=one.known_text)
    elif one.failures:
        remark(case, "failure", text, message=head, type=one.failures[0].rule)
    if one.advice:
        remark(case, "system-out", "\n".join(_line(finding) for finding in one.advice))
    return case


def _line(finding: Finding) -> str:
    ((rule, text),) = titled([finding])
    return f"{rule} {text}" + f"\n  cure: {finding.cure}" * bool(finding.cure)
