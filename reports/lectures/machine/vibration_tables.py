"""Steady vibration on the terminal."""

from __future__ import annotations

import math
from collections.abc import Iterable

from rich.console import Console
from rich.table import Table

from analytic.lectures.vibration.over_speeds import InertiaMap, OverSpeeds
from analytic.lectures.vibration.steady_vibration import SteadyVibration
from reports.lectures.machine import vibration_rows
from reports.output.console import plain_table
from reports.output.numbers import NONE, count, readable

MODES = 6
"""Modes of the mechanism that are shown; files hold all."""


def show_vibration(console: Console, vibration: SteadyVibration) -> None:
    """Print a vibration."""
    _head(console, vibration_rows.heading(vibration))
    links = _table("natural frequency of", "", "mode", "rad/s", "Hz", "over speed")
    for own in vibration_rows.link_rows(vibration):
        hertz = own.frequency_rad_s / math.tau
        links.add_row(
            own.link, own.kind, str(own.number), _digits(own.frequency_rad_s), _digits(hertz),
            _digits(own.ratio),
        )  # fmt: skip
    console.print(links, "")
    modes = _table(
        "mechanism, mode", "rad/s, least", "most", "over speed", "order", "from whole", "multiplier"
    )
    for row in vibration_rows.mode_rows(vibration)[:MODES]:
        off = abs(row.order - round(row.order)) if math.isfinite(row.order) else math.nan
        modes.add_row(
            str(row.mode), _digits(row.least_rad_s), _digits(row.most_rad_s), _digits(row.ratio),
            _digits(row.order), readable(off) if off == off else NONE, f"{row.multiplier:.6f}",
        )  # fmt: skip
    console.print(modes, "")
    links = _table(
        "largest deflection", "mm", "of length", "at mm", "driver deg", "middle mm", "extension mm"
    )
    for each in vibration_rows.swing_rows(vibration):
        links.add_row(
            each.link, _milli(each.largest_m), _percent(each.share), _milli(each.place_m),
            f"{each.at_deg:.1f}", _milli(each.middle_m), _milli(each.extension_m),
        )  # fmt: skip
    console.print(links, "")
    theories = _table("off that", "linear", "linear, not stiffened")
    for each in vibration_rows.swing_rows(vibration):
        shares = (each.linear_off, each.unstiffened_off)
        theories.add_row(each.link, *(f"{100.0 * share:+.2g} %" for share in shares))
    console.print(theories, "")
    _notes(console, vibration_rows.notes(vibration))


def show_speeds(console: Console, over: OverSpeeds) -> None:
    """Print vibration over speeds."""
    _head(console, vibration_rows.speeds_heading(over))
    critical = over.critical
    if critical:
        table = _table("critical speed rad/s", "over speed", "mode", "order", "band +- %")
        for each in critical[: vibration_rows.MOST_ROWS]:
            table.add_row(
                _digits(each.speed_rad_s), _digits(each.ratio), str(each.mode), str(each.order),
                readable(100.0 * each.band, 2),
            )  # fmt: skip
        console.print(table, "")
        left = len(critical) - vibration_rows.MOST_ROWS
        if left > 0:
            _notes(console, [f"{count(left, 'weaker one')} left out; -o writes all."])
    else:
        _notes(console, ["No critical speed lies between them."])
    _notes(console, vibration_rows.speeds_notes(over))


def show_map(console: Console, found: InertiaMap) -> None:
    """Print a map over inertia."""
    _head(console, vibration_rows.map_heading(found))
    table = _table(
        f"{found.link} times", "median deflection", "largest multiplier", "at rad/s", "unstable at"
    )
    for row in vibration_rows.inertia_rows(found):
        table.add_row(
            f"{row.factor:.4g}", _percent(row.share), readable(row.multiplier, 4),
            _digits(row.at_rad_s), count(row.unstable, "speed"),
        )  # fmt: skip
    console.print(table, "")
    _notes(console, ["Deflection: the largest over the length of a link, in the middle of speeds."])


def _head(console: Console, text: str) -> None:
    console.print(text, "", highlight=False, markup=False, sep="\n")


def _table(*heads: str) -> Table:
    """A name, then numbers."""
    table = plain_table(gap=2)
    for k, head in enumerate(heads):
        table.add_column(head, justify="right" if k else "left", no_wrap=True)
    return table


def _digits(value: float) -> str:
    return f"{value + 0.0:.6g}" if math.isfinite(value) else NONE


def _milli(value_m: float) -> str:
    return readable(1e3 * value_m, 4)


def _percent(share: float) -> str:
    return f"{readable(100.0 * share)} %"


def _notes(console: Console, told: Iterable[str]) -> None:
    for note in told:
        console.print(note, style="dim", highlight=False, markup=False)
