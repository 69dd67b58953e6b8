"""The errors of a comparison on the terminal."""

from __future__ import annotations

import math
from collections.abc import Mapping

from rich.console import Console

from models.driver_shown import driver_unit
from models.scene import Scene
from reports.compare.errors import Error, ErrorKind, Errors, largest
from reports.describe.held_to import held_to
from reports.output.console import plain_table, say
from reports.output.numbers import short
from reports.quantities import QUANTITIES

PARTS: Mapping[ErrorKind, str] = {
    "geometric": "geometry",
    "start": "at the start",
    "passage": "change points",
}
"""What sets a row apart: at the logged angle of the crank, first samples, near change points."""


def show_errors(console: Console, scene: Scene, source: str, errors: Errors) -> None:
    """Print the worst body of each quantity, source and kind."""
    table = plain_table(f"{scene.name}: {source}")
    for head in ("quantity", "", "worst body"):
        table.add_column(head, no_wrap=True)
    for head in ("largest\nerror", "of its\nscale", "at t\ns", f"driver\n{driver_unit(scene)}"):
        table.add_column(head, justify="right", no_wrap=True)
    for worst in worst_rows(errors):
        table.add_row(
            worst.tolerance,
            PARTS.get(worst.kind, ""),
            f"{worst.body_kind} {worst.body}",
            f"{short(worst.maximum)} {worst.unit}",
            f"{short(worst.pure)} {QUANTITIES[worst.quantity].of(worst.body_kind).share}",
            f"{worst.time_of_maximum_s:.4g}",
            _driver(worst),
        )
    console.print(table, "")
    said = held_to(free=errors.free is not None, elastic=errors.elastic)
    say(console, said, "dim")
    for note in errors.notes:
        say(console, note, "yellow")


def _driver(error: Error) -> str:
    place = error.driver_at_maximum_rad
    return f"{place:.4g}" if error.driver_unit == "m" else f"{math.degrees(place):.1f}"


def worst_rows(errors: Errors) -> list[Error]:
    """The largest error of each quantity, source and kind, in the order of the quantities."""
    keys = dict.fromkeys((row.quantity, row.source, row.kind) for row in errors.rows)
    found = (
        largest(row for row in errors.rows if (row.quantity, row.source, row.kind) == key)
        for key in keys
    )
    order = list(QUANTITIES)
    return sorted((row for row in found if row), key=lambda row: order.index(row.quantity))
