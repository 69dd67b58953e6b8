"""Steady vibration on the terminal, and as tables and JSON with all digits."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict
from typing import TYPE_CHECKING

import numpy as np
from rich.console import Console
from rich.table import Table

from analytic.lectures.vibration.over_speeds import InertiaMap, OverSpeeds
from analytic.lectures.vibration.steady_vibration import SteadyVibration
from models.scene import Scene
from reports.lectures.machine import vibration_rows
from reports.lectures.machine.cycle_rows import origin_of
from reports.output.console import grid, say, say_each
from reports.output.formats import json_text
from reports.output.numbers import NONE, count, readable

if TYPE_CHECKING:
    import pandas as pd


MODES = 6
"""Most modes of the mechanism on the terminal; files have all."""


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
    say_each(console, vibration_rows.notes(vibration))


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
            say_each(console, [f"{count(left, 'weaker one')} left out; -o writes all."])
    else:
        say_each(console, ["No critical speed lies between them."])
    say_each(console, vibration_rows.speeds_notes(over))


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
    say_each(
        console, ["Deflection: the largest over the length of a link, in the middle of speeds."]
    )


def _head(console: Console, text: str) -> None:
    say(console, f"{text}\n")


def _table(*heads: str) -> Table:
    """A table of a name, then numbers."""
    first, *others = heads
    return grid((first, *(f"{head}:" for head in others)), whole=(first,))


def _digits(value: float) -> str:
    return f"{value + 0.0:.6g}" if math.isfinite(value) else NONE


def _milli(value_m: float) -> str:
    return readable(1e3 * value_m, 4)


def _percent(share: float) -> str:
    return f"{readable(100.0 * share)} %"


def turn_frame(vibration: SteadyVibration) -> pd.DataFrame:
    """Table of instants of a turn: deflections, extensions, deflections by linear theories."""
    import pandas as pd

    columns = {
        "time_s": vibration.motion.time_s,
        f"{vibration.scene.driver.link}_theta_rad": vibration.angles,
    }
    for name, own in vibration.swings.items():
        columns[f"{name}_middle_m"], columns[f"{name}_extension_m"] = own.middle, own.extension
        for theory, swings in vibration.theories.items():
            key = theory.replace(", ", "_").replace(" ", "_")
            columns[f"{name}_middle_{key}_m"] = swings[name].middle
    return pd.DataFrame(columns)


def natural_frame(vibration: SteadyVibration) -> pd.DataFrame:
    """Table of natural frequencies with the driver fixed, over its angle."""
    import pandas as pd

    frequencies = vibration.natural.frequency_rad_s
    law, count = vibration.scene.driver.law, len(frequencies)
    angles = law.at(law.period_s * np.arange(count) / count)[0]
    columns = {f"{vibration.scene.driver.link}_theta_rad": angles}
    columns |= {f"mode_{k + 1}_rad_s": own for k, own in enumerate(frequencies.T)}
    return pd.DataFrame(columns)


def spectrum_frame(vibration: SteadyVibration) -> pd.DataFrame:
    """Table of amplitudes over orders: of middles, or of extensions of links that only stretch."""
    import pandas as pd

    each = {f"{name}_m": own.amplitudes for name, own in vibration.swings.items()}
    orders = np.arange(len(next(iter(each.values()))))
    return pd.DataFrame({"order": orders, **each})


def speeds_frame(over: OverSpeeds) -> pd.DataFrame:
    """Table of speeds, a row each."""
    import pandas as pd

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
    return pd.DataFrame(rows)


def waterfall_frame(over: OverSpeeds) -> pd.DataFrame:
    """Table of the amplitudes of all links, a row per speed and order."""
    import pandas as pd

    frames = []
    for point in over.points:
        each = {f"{name}_m": own.amplitudes for name, own in point.swings.items()}
        orders = np.arange(len(next(iter(each.values()))))
        frames.append(pd.DataFrame({"speed_rad_s": point.speed_rad_s, "order": orders, **each}))
    return pd.concat(frames, ignore_index=True)


def critical_frame(over: OverSpeeds) -> pd.DataFrame:
    """Table of all critical speeds, the widest band first."""
    import pandas as pd

    columns = ["speed_rad_s", "ratio", "mode", "order", "band"]
    return pd.DataFrame([asdict(each) for each in over.critical], columns=columns)


def map_frame(found: InertiaMap) -> pd.DataFrame:
    """Table with a row per factor and speed."""
    import pandas as pd

    frames = []
    for factor, over in zip(found.factors, found.over, strict=True):
        own = speeds_frame(over)
        own.insert(0, f"{found.link}_times", factor)
        frames.append(own)
    return pd.concat(frames, ignore_index=True)


def vibration_document(vibration: SteadyVibration) -> str:
    """The numbers of a vibration as JSON."""
    return _text(
        vibration.scene,
        {
            "speed_rad_s": vibration.speed_rad_s,
            "links": [asdict(row) for row in vibration_rows.link_rows(vibration)],
            "modes": [asdict(row) for row in vibration_rows.mode_rows(vibration)],
            "deflections": [asdict(row) for row in vibration_rows.swing_rows(vibration)],
            "stable": vibration.stability.is_stable,
            "largest_multiplier": vibration.stability.largest,
            "sensitivity": asdict(vibration.motion.sensitivity),
            "last_of_series": vibration.motion.decay,
        },
    )


def speeds_document(over: OverSpeeds) -> str:
    """Critical and unstable speeds as JSON."""
    return _text(
        over.scene,
        {
            "critical": [asdict(each) for each in over.critical],
            "unstable": [asdict(each) for each in vibration_rows.unstable_speeds(over)],
        },
    )


def map_document(found: InertiaMap) -> str:
    """The rows of a map as JSON."""
    rows = [asdict(row) for row in vibration_rows.inertia_rows(found)]
    return _text(found.scene, {"link": found.link, "inertia": rows})


def _text(scene: Scene, content: Mapping[str, object]) -> str:
    return json_text({**origin_of(scene), **content})
