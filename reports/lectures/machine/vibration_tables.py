"""Steady vibration on the terminal, and as tables and JSON with all digits.

Tables of files are columns by name, or rows, as pandas takes them.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from rich.console import Console

from analytic.lectures.vibration.over_speeds import InertiaMap, OverSpeeds
from analytic.lectures.vibration.steady_vibration import SteadyVibration
from models.array import Array
from reports.lectures.machine import vibration_rows
from reports.lectures.machine.cycle_rows import numbers_text
from reports.output.console import grid, say, say_each
from reports.output.numbers import NONE, count, readable

MODES = 6
"""Most modes of the mechanism on the terminal; files have all."""
Rows = list[dict[str, object]]


def show_vibration(console: Console, vibration: SteadyVibration) -> None:
    """Print a vibration."""
    say(console, f"{vibration_rows.heading(vibration)}\n")
    links = ("natural frequency of", "", "mode", "rad/s", "Hz", "over speed")
    _show(console, links, (
        (own.link, own.kind, str(own.number),
         *map(_digits, (own.frequency_rad_s, own.frequency_rad_s / math.tau, own.ratio)))
        for own in vibration_rows.link_rows(vibration)
    ))  # fmt: skip
    modes = [
        (str(row.mode),
         *map(_digits, (row.least_rad_s, row.most_rad_s, row.ratio, row.order)),
         readable(abs(row.order - round(row.order))) if math.isfinite(row.order) else NONE,
         f"{row.multiplier:.6f}")
        for row in vibration_rows.mode_rows(vibration)[:MODES]
    ]  # fmt: skip
    heads = (
        "mechanism, mode", "rad/s, least", "most", "over speed", "order", "from whole", "multiplier"
    )  # fmt: skip
    _show(console, heads, modes)
    swings = vibration_rows.swing_rows(vibration)
    heads = (
        "largest deflection", "mm", "of length", "at mm", "driver deg", "middle mm", "extension mm"
    )  # fmt: skip
    _show(console, heads, (
        (each.link, _milli(each.largest_m), _percent(each.share), _milli(each.place_m),
         f"{each.at_deg:.1f}", _milli(each.middle_m), _milli(each.extension_m))
        for each in swings
    ))  # fmt: skip
    _show(console, ("off that", "linear", "linear, not stiffened"), (
        (each.link, f"{100.0 * each.linear_off:+.2g} %", f"{100.0 * each.unstiffened_off:+.2g} %")
        for each in swings
    ))  # fmt: skip
    say_each(console, vibration_rows.notes(vibration))


def show_speeds(console: Console, over: OverSpeeds) -> None:
    """Print vibration over speeds."""
    say(console, f"{vibration_rows.speeds_heading(over)}\n")
    critical = over.critical
    if critical:
        heads = ("critical speed rad/s", "over speed", "mode", "order", "band +- %")
        _show(console, heads, (
            (_digits(each.speed_rad_s), _digits(each.ratio), str(each.mode), str(each.order),
             readable(100.0 * each.band, 2))
            for each in critical[: vibration_rows.MOST_ROWS]
        ))  # fmt: skip
        left = len(critical) - vibration_rows.MOST_ROWS
        if left > 0:
            say_each(console, [f"{count(left, 'weaker one')} left out; -o writes all."])
    else:
        say_each(console, ["No critical speed lies between them."])
    say_each(console, vibration_rows.speeds_notes(over))


def show_map(console: Console, found: InertiaMap) -> None:
    """Print a map over inertia."""
    say(console, f"{vibration_rows.map_heading(found)}\n")
    heads = (
        f"{found.link} times", "median deflection", "largest multiplier", "at rad/s", "unstable at"
    )  # fmt: skip
    _show(console, heads, (
        (f"{row.factor:.4g}", _percent(row.share), readable(row.multiplier, 4),
         _digits(row.at_rad_s), count(row.unstable, "speed"))
        for row in vibration_rows.inertia_rows(found)
    ))  # fmt: skip
    words = "Deflection: the largest over the length of a link, in the middle of speeds."
    say_each(console, [words])


def _show(console: Console, heads: Sequence[str], rows: Iterable[Sequence[str]]) -> None:
    """Print a table of a name, then numbers."""
    first, *others = heads
    console.print(grid((first, *(f"{head}:" for head in others)), rows, whole=(first,)), "")


def _digits(value: float) -> str:
    return f"{value + 0.0:.6g}" if math.isfinite(value) else NONE


def _milli(value_m: float) -> str:
    return readable(1e3 * value_m, 4)


def _percent(share: float) -> str:
    return f"{readable(100.0 * share)} %"


def turn_columns(vibration: SteadyVibration) -> Mapping[str, Array]:
    """Instants of a turn: deflections, extensions, deflections by linear theories."""
    columns = {
        "time_s": vibration.motion.time_s,
        f"{vibration.scene.driver.link}_theta_rad": vibration.angles,
    }
    for name, own in vibration.swings.items():
        columns[f"{name}_middle_m"], columns[f"{name}_extension_m"] = own.middle, own.extension
        for theory, swings in vibration.theories.items():
            key = theory.replace(", ", "_").replace(" ", "_")
            columns[f"{name}_middle_{key}_m"] = swings[name].middle
    return columns


def natural_columns(vibration: SteadyVibration) -> Mapping[str, Array]:
    """Natural frequencies with the driver fixed, over its angle."""
    frequencies, driver = vibration.natural.frequency_rad_s, vibration.scene.driver
    angles = driver.law.at(driver.law.period_s * np.arange(len(frequencies)) / len(frequencies))[0]
    modes = {f"mode_{k}_rad_s": own for k, own in enumerate(frequencies.T, 1)}
    return {f"{driver.link}_theta_rad": angles} | modes


def spectrum_columns(vibration: SteadyVibration) -> Mapping[str, ArrayLike]:
    """Amplitudes over orders: of middles, or of extensions of links that only stretch."""
    each = {f"{name}_m": own.amplitudes for name, own in vibration.swings.items()}
    return {"order": np.arange(len(next(iter(each.values())))), **each}


def speeds_rows(over: OverSpeeds) -> Rows:
    """A row for each speed."""
    rows = []
    for point in over.points:
        row: dict[str, object] = {
            "speed_rad_s": point.speed_rad_s,
            "ratio": point.ratio,
            "largest_multiplier": point.stability.largest,
            "stable": point.stability.is_stable,
            "sensitivity": point.sensitivity.size,
            "sensitive_order": point.sensitivity.order,
        }
        row |= {f"{name}_largest_m": own.largest_m for name, own in point.swings.items()}
        row |= {f"mode_{each.mode}_order": each.order for each in point.deviations}
        rows.append(row)
    return rows


def waterfall_rows(over: OverSpeeds) -> Rows:
    """The amplitudes of all links, a row per speed and order."""
    return [
        {"speed_rad_s": point.speed_rad_s, "order": order}
        | {f"{name}_m": own.amplitudes[order] for name, own in point.swings.items()}
        for point in over.points
        for order in range(len(next(iter(point.swings.values())).amplitudes))
    ]


def critical_columns(over: OverSpeeds) -> Mapping[str, list[float]]:
    """All critical speeds, the widest band first."""
    names = ("speed_rad_s", "ratio", "mode", "order", "band")
    return {name: [getattr(each, name) for each in over.critical] for name in names}


def map_rows(found: InertiaMap) -> Rows:
    """A row per factor and speed."""
    return [
        {f"{found.link}_times": factor} | row
        for factor, over in zip(found.factors, found.over, strict=True)
        for row in speeds_rows(over)
    ]


def vibration_document(vibration: SteadyVibration) -> str:
    """The numbers of a vibration as JSON."""
    return numbers_text(
        vibration.scene,
        speed_rad_s=vibration.speed_rad_s,
        links=_all_facts(vibration_rows.link_rows(vibration)),
        modes=_all_facts(vibration_rows.mode_rows(vibration)),
        deflections=_all_facts(vibration_rows.swing_rows(vibration)),
        stable=vibration.stability.is_stable,
        largest_multiplier=vibration.stability.largest,
        sensitivity=asdict(vibration.motion.sensitivity),
        last_of_series=vibration.motion.decay,
    )


def speeds_document(over: OverSpeeds) -> str:
    """Critical and unstable speeds as JSON."""
    critical, unstable = over.critical, vibration_rows.unstable_speeds(over)
    return numbers_text(over.scene, critical=_all_facts(critical), unstable=_all_facts(unstable))


def map_document(found: InertiaMap) -> str:
    """The rows of a map as JSON."""
    rows = _all_facts(vibration_rows.inertia_rows(found))
    return numbers_text(found.scene, link=found.link, inertia=rows)


def _all_facts(rows: Iterable[Any]) -> Rows:
    return [asdict(row) for row in rows]
