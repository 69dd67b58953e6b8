"""The faults on the terminal: escaped ones first, then the table, then the count."""

from collections.abc import Mapping, Sequence

from rich.console import Console
from rich.markup import escape
from rich.table import Table
from rich.text import Text

from reports.judge.cell import Checked
from reports.judge.rules import RULES
from reports.output.console import grid
from reports.selftest.fault import PROFILE, Fault
from reports.selftest.trial import GROUPS, RUNS, FaultTrial, Passed, Verdict, passes

WIDE = 96
"""Columns of a terminal with room for the description of a fault."""
MODEL_CHECK = "*"
"""Mark of the rule where the run is refused before its first step."""
FEW = 3
"""Number of faults up to which each is shown with the text of its rule."""


def show_faults(
    console: Console,
    healthy: Sequence[Checked],
    verdicts: Sequence[Verdict],
    engines: Sequence[str],
    facts: Mapping[str, str],
    passed: Sequence[Passed] = (),
) -> None:
    """Print the whole selftest; ``passed`` need not be seen, and has the reason."""
    for one in verdicts:
        if not one.caught or len(verdicts) <= FEW:
            _told(console, one)
    for run in healthy:
        console.print(_without(run))
    console.print("", _table(verdicts, engines, console.width), "")
    if passed:
        console.print(Text("not seen, and not required", "bold"), _unseen(passed), "")
    console.print(total(verdicts))
    console.print(_footer(verdicts, facts), style="dim", highlight=False)


def total(verdicts: Sequence[Verdict]) -> Text:
    """Return the result in one line."""
    caught = sum(one.caught for one in verdicts)
    noun = "fault" if len(verdicts) == 1 else "faults"
    text = f"{caught} of {len(verdicts)} {noun} caught by the named rule"
    return Text(text, "bold green" if caught == len(verdicts) else "bold red")


def _without(one: Checked) -> Text:
    place = f"no fault: {one.cell.scene.name}, {one.cell.engine}: "
    if passes(one):
        return Text(f"{place}all {len(one.findings)} rules pass", "green")
    bad = [finding.rule for finding in one.findings if finding.level != "pass"]
    return Text(f"{place}{', '.join(bad)} {'does' if len(bad) == 1 else 'do'} not pass", "bold red")


def _told(console: Console, verdict: Verdict) -> None:
    fault, rule = verdict.fault, RULES[verdict.fault.rule]
    head = "caught" if verdict.caught else "ESCAPES"
    style = "bold green" if verdict.caught else "bold red"
    console.print(Text(f"{head}  {fault.name}: {fault.what}", style))
    if verdict.lost:
        console.print(Text(f"  {verdict.lost}"))
    for place in verdict.places:
        where = f"  {place.scene}, {place.engine}: "
        if place.finding is not None:
            console.print(Text(f"{where}{rule.id} {rule.title}: {place.finding.text}"))
        elif place.nothing:
            console.print(Text(f"{where}nothing was planted: every error is that of size 0"))
        else:
            others = ", ".join(place.failed) or "none"
            words = f" with {' and '.join(map(repr, fault.says))}" if fault.says else ""
            console.print(
                Text(f"{where}{rule.id} {rule.title}{words} does not fail; failing: {others}")
            )
        if place.false:
            console.print(Text(f"{where}with a size of 0 there fail: {', '.join(place.false)}"))
    console.print()


def _table(verdicts: Sequence[Verdict], engines: Sequence[str], width: int) -> Table:
    wide = width >= WIDE
    heads = ["", "fault", *["fault"] * wide, "planted size", "caught\nby"]
    heads += [f"from on,\n{engine}:" for engine in engines]
    table = grid(heads, gap=1, whole=("fault", "caught\nby"), cut=("",))
    for group in dict.fromkeys(one.fault.group for one in verdicts):
        table.add_row("", Text(group, "bold"), *([Text(GROUPS[group], "bold")] if wide else []))
        for one in verdicts:
            if one.fault.group == group:
                table.add_row(*_cells(one, engines, wide))
    return table


def _unseen(passed: Sequence[Passed]) -> Table:
    table = grid(("", "planted", "why it is not required to be seen"), gap=1)
    for one in passed:
        failed = dict.fromkeys(rule for rules in one.failed.values() for rule in rules)
        reason = f"Seen nevertheless, by {', '.join(failed)}." if failed else one.unseen.reason
        if one.nothing:
            reason = (
                f"Nothing was planted in {' and '.join(one.nothing)}: every error is as before."
            )
        table.add_row(one.unseen.name, one.unseen.what, Text(reason, "red" * bool(one.nothing)))
    return table


def _cells(one: Verdict, engines: Sequence[str], wide: bool) -> list[Text]:
    fault = one.fault
    mark = Text("ok", "green") if one.caught else Text("OUT", "bold red")
    size = "" if fault.size is None else fault.words(fault.size)
    return [
        mark,
        Text(fault.name),
        *([Text(fault.what)] if wide else []),
        Text(size),
        Text(fault.rule + MODEL_CHECK * fault.refused),
        *(_from(one, engine) for engine in engines),
    ]


def _from(one: Verdict, engine: str) -> Text:
    places = [place for place in one.places if place.engine == engine]
    if not one.fault.possible(engine):
        return Text("-")
    if not places or not all(place.finding for place in places):
        return Text("escapes", "bold red")
    least = one.least(engine)
    return Text("yes" if least is None else least_words(one.fault, least))


def least_words(fault: Fault, least: float) -> str:
    """Return the smallest size that is caught, without its unit where that stands beside it."""
    if least == 0.0:
        return "any"
    if fault.shown:
        return fault.words(least)
    return f"{least:.0f}" if fault.whole else f"{least:.1e}"


def _footer(verdicts: Sequence[Verdict], facts: Mapping[str, str]) -> str:
    named = {one.fault.rule for one in verdicts}
    rules = ", ".join(f"{name} {rule.title}" for name, rule in RULES.items() if name in named)
    refused = any(one.fault.refused for one in verdicts)
    lines = [
        f"{rules}.",
        *(
            [f"{MODEL_CHECK} by the model check: the run is refused before its first step."]
            * refused
        ),
        "From on: the smallest size that its rule still sees in every scene, to 10 % (any: down to "
        "1e-12 of the planted size; yes: there or not; -: can not be planted there). With a size "
        "of 0 nothing may be found.",
        f"Profile {PROFILE}, {_spans(verdicts)}. L longest link, w driver's speed.",
        ", ".join(f"{name} {value}" for name, value in facts.items()),
    ]
    return escape("\n".join(lines))


def _spans(verdicts: Sequence[Verdict]) -> str:
    kinds = {one.fault.kind for one in verdicts}
    scenes = dict.fromkeys(scene for one in verdicts for scene in one.fault.scenes)
    words = (text for kind, runs in RUNS.items() if kind in kinds for text in runs.words(scenes))
    return "; ".join(dict.fromkeys(words))


def place_row(verdict: Verdict, place: FaultTrial) -> dict[str, object]:
    """Return a fault in one place, as plain values."""
    fault, finding = verdict.fault, place.finding
    return {
        "fault": fault.name,
        "group": fault.group,
        "what": fault.what,
        "size": fault.size,
        "unit": fault.unit,
        "rule": fault.rule,
        "title": RULES[fault.rule].title,
        "scene": place.scene,
        "engine": place.engine,
        "caught": finding is not None,
        "from_size": place.least,
        "said": finding.text if finding else "",
        "failed": ", ".join(place.failed),
        "failed_at_size_0": ", ".join(place.false),
    }
