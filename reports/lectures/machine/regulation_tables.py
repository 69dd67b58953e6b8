"""The steady cycle and the flywheel on the terminal."""

from __future__ import annotations

import math

from rich.console import Console
from rich.table import Table

from analytic.lectures.regulation.flywheel import WantedFlywheel
from analytic.lectures.regulation.steady_cycle import SteadyCycle
from reports.lectures.machine import cycle_rows, flywheel_rows
from reports.output.console import plain_table
from reports.output.numbers import NONE, error_text


def show_cycle(console: Console, cycle: SteadyCycle) -> None:
    """Print a cycle."""
    console.print(cycle_rows.heading(cycle), "", highlight=False, markup=False, sep="\n")
    table = _table(("", "value", "", f"{cycle.machine.scene.driver.link} at"))
    for row in cycle_rows.number_rows(cycle):
        at = "" if math.isnan(row.at_deg) else f"{row.at_deg:.4f} deg"
        table.add_row(row.name, _digits(row.value), row.unit, at)
    console.print(table, "")
    works = _table(("work of a cycle by", "work J", "", "mean torque N m"))
    for work in cycle_rows.work_rows(cycle):
        works.add_row(work.name, _digits(work.work_j), "", _digits(work.mean_n_m))
    console.print(works, "")
    _notes(console, cycle_rows.notes(cycle))


def show_flywheel(console: Console, found: WantedFlywheel) -> None:
    """Print a flywheel."""
    console.print(flywheel_rows.heading(found), "", highlight=False, markup=False, sep="\n")
    ways = _table(("flywheel", "kg m^2", "", "off the exact one"))
    for row in flywheel_rows.way_rows(found):
        off = "" if row.key == "exact" else f"{'+' * (row.off > 0.0)}{error_text(row.off)}"
        ways.add_row(row.name, _digits(row.inertia_kg_m2), "", off)
    console.print(ways, "")
    beside = _table(("cycle", "without", "with it", ""))
    for each in flywheel_rows.beside_rows(found):
        beside.add_row(each.name, _digits(each.without), _digits(each.with_it), each.unit)
    console.print(beside, "")
    _notes(console, flywheel_rows.notes(found))


def _table(heads: tuple[str, str, str, str]) -> Table:
    """Names, then numbers; a column without a head has units."""
    table = plain_table(gap=2)
    for k, head in enumerate(heads):
        table.add_column(head, justify="right" if head and k else "left", no_wrap=True)
    return table


def _digits(value: float) -> str:
    """Seven significant digits; a dash where there is none."""
    return NONE if math.isnan(value) else f"{value + 0.0:.7g}"


def _notes(console: Console, told: list[str]) -> None:
    for note in told:
        console.print(note, style="dim", highlight=False, markup=False)
