"""The matrix on the terminal: case by case, a line per engine and profile."""

import math
from collections.abc import Mapping

from rich.console import Console
from rich.text import Text

from reports.output.console import plain_table
from reports.output.numbers import short
from reports.stability.case import WITHIN
from reports.stability.grades import MEANINGS
from reports.stability.matrix import CaseFacts, Graded, Matrix, Outcome, with_forces

LETTERS: Mapping[Outcome, str] = {
    "ok": "",
    "degraded": "d",
    "drifts": "~",
    "branch-changed": "B",
    "locked": "L",
    "silently-open": "S",
    "diverged": "X",
    "crashed": "!",
    "unsupported": "-",
}
NARROW = 80
"""Columns of a terminal below which a case is shown in words alone."""
BARE = ("X", "!", "-")
"""Letters of outcomes whose error means nothing."""
STYLES: Mapping[Outcome, str] = {
    "degraded": "yellow",
    "drifts": "yellow",
    "unsupported": "dim",
}


def show(console: Console, matrix: Matrix) -> None:
    """Print the whole matrix, with its legend and origin."""
    group = ""
    for case in matrix.cases:
        if case.group != group:
            group = case.group
            console.print(Text(group.upper(), "bold"), "")
        _case(console, matrix, case)
    console.print(_legend(matrix), "", style="dim", highlight=False)
    facts = ", ".join(f"{name} {value}" for name, value in matrix.facts.items())
    console.print(facts, style="dim", highlight=False)


def _case(console: Console, matrix: Matrix, case: CaseFacts) -> None:
    unit = f" [{case.unit}]" if case.unit else ""
    console.print(Text.assemble((case.name, "bold"), f"  {case.title}; {case.parameter}{unit}"))
    lines = [critical for critical in matrix.critical if critical.case == case.name]
    if console.width < NARROW:
        for critical in lines:
            style = _style(case, critical.outcome)
            console.print(f"  {critical.engine} {critical.profile}:", Text(critical.words, style))
        console.print()
        return
    table = plain_table()
    table.pad_edge = False
    table.add_column("", no_wrap=True)
    for text in case.labels:
        table.add_column(text, justify="right", no_wrap=True, header_style="dim")
    table.add_column("", overflow="fold")
    for critical in lines:
        runs = {at: run for at, run in matrix.runs_of(critical.line).items() if run.grid}
        cells = [_cell(case, runs.get(value)) for value in case.values]
        name = f"  {critical.engine} {critical.profile}"
        style = _style(case, critical.outcome)
        table.add_row(name, *cells, Text(f" {critical.words}", style))
        if with_forces(matrix):
            borne = [_force(runs.get(value)) for value in case.values]
            table.add_row("    forces", *borne, "")
    console.print(table, "")


def _cell(case: CaseFacts, run: Graded | None) -> Text:
    if run is None:
        return Text("")
    letter = LETTERS[run.outcome]
    bare = letter in BARE or math.isnan(run.error)
    return Text(
        letter + ("" if bare else short(run.error, 1).removesuffix("e0")), _style(case, run.outcome)
    )


def _force(run: Graded | None) -> Text:
    if run is None or math.isnan(run.force):
        return Text("")
    return Text(short(run.force, 1).removesuffix("e0"), "dim")


def _style(case: CaseFacts, outcome: Outcome) -> str:
    return "green" if outcome in case.good else STYLES.get(outcome, "red")


def _legend(matrix: Matrix) -> str:
    """Return the meaning of letters and numbers, and the command for a single run."""
    outcomes = {run.outcome for run in matrix.runs}
    letters = "; ".join(
        f"{LETTERS[outcome]} {outcome}: {meaning}"
        for outcome, meaning in MEANINGS.items()
        if outcome in outcomes and LETTERS[outcome]
    )
    errors = dict.fromkeys(case.error_of for case in matrix.cases)
    within = {case.within: case.group for case in matrix.cases}
    usual = f"{WITHIN:g}"
    classes = ", ".join([usual, *(f"{w:g} ({g})" for w, g in within.items() if w != WITHIN)])
    forces = "Forces: the worst error of a reaction or the torque, over the largest; not graded.\n"
    forces *= with_forces(matrix)
    return (
        f"Numbers: the worst error of {'; of '.join(errors)}; easy to hard from left to right; "
        f"held: within {classes}{f'. {letters}' * bool(letters)}.\n{forces}"
        "Each alone: crankcheck stability CASE --engine ENGINE --profile PROFILE --at VALUE"
    )


def show_run(console: Console, case: CaseFacts, run: Graded) -> None:
    """Print one run in full."""
    good, slides = run.outcome in case.good, case.driver_unit == "m"
    head = f"{case.name}, {case.parameter} {run.label} {case.unit}".rstrip()
    console.print(Text(f"{head}, {run.engine}, {run.profile}", "bold"))
    console.print(Text(f"  {run.outcome}", "green" if good else "bold red"), Text(run.reason))
    if not math.isnan(run.at_s):
        place = run.at_driver_rad
        driver = f"{place:.4g} m" if slides else f"{math.degrees(place):.4g} deg"
        console.print(f"  at t = {run.at_s:.6g} s, driver {driver}", highlight=False)
    for name, number in (
        (f"error of {case.error_of}", run.error),
        ("widest open joint, over the longest link", run.gap),
        (f"error of the {'slider, over the longest link' if slides else 'crank, rad'}", run.drive),
        ("error of forces, over the largest", run.force),
        ("distance of the scene from a singular position, 0 to 1", run.sine),
    ):
        if not math.isnan(number):
            console.print(f"  {name}: {number:.3g}", highlight=False)
    console.print(f"  {run.steps} steps of {run.dt_s:.4g} s", highlight=False)
    console.print(
        f"  reference: {case.truth}", f"  expected: {case.expected}", sep="\n", style="dim"
    )
