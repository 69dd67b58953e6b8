"""Steady vibration as tables with all digits, and as JSON."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from typing import TYPE_CHECKING

import numpy as np

from analytic.lectures.vibration.over_speeds import InertiaMap, OverSpeeds
from analytic.lectures.vibration.steady_vibration import SteadyVibration
from models.scene import Scene
from reports.lectures.machine import vibration_rows
from reports.output.numbers import finite
from reports.output.provenance import crankcheck_version

if TYPE_CHECKING:
    import pandas as pd


def turn_frame(vibration: SteadyVibration) -> pd.DataFrame:
    """Over a turn: deflections, extensions, and those of the linear theories; one row per
    instant."""
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
    """Natural frequencies with the driver held still, over its angle."""
    import pandas as pd

    frequencies = vibration.natural.frequency_rad_s
    law, count = vibration.scene.driver.law, len(frequencies)
    angles = law.at(law.period_s * np.arange(count) / count)[0]
    columns = {f"{vibration.scene.driver.link}_theta_rad": angles}
    columns |= {f"mode_{k + 1}_rad_s": own for k, own in enumerate(frequencies.T)}
    return pd.DataFrame(columns)


def spectrum_frame(vibration: SteadyVibration) -> pd.DataFrame:
    """The amplitudes of the middles (of what only stretches, of the extension) over orders."""
    import pandas as pd

    each = {f"{name}_m": own.amplitudes for name, own in vibration.swings.items()}
    orders = np.arange(len(next(iter(each.values()))))
    return pd.DataFrame({"order": orders, **each})


def speeds_frame(over: OverSpeeds) -> pd.DataFrame:
    """One row per speed."""
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
    """One row per speed and order: the amplitudes of all links."""
    import pandas as pd

    frames = []
    for point in over.points:
        each = {f"{name}_m": own.amplitudes for name, own in point.swings.items()}
        orders = np.arange(len(next(iter(each.values()))))
        frames.append(pd.DataFrame({"speed_rad_s": point.speed_rad_s, "order": orders, **each}))
    return pd.concat(frames, ignore_index=True)


def critical_frame(over: OverSpeeds) -> pd.DataFrame:
    """All critical speeds, the widest band first."""
    import pandas as pd

    columns = ["speed_rad_s", "ratio", "mode", "order", "band"]
    return pd.DataFrame([asdict(each) for each in over.critical], columns=columns)


def map_frame(found: InertiaMap) -> pd.DataFrame:
    """One row per factor and speed."""
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
    origin = {"scene": scene.name, "source": scene.source, "crankcheck": crankcheck_version()}
    return json.dumps(finite({**origin, **content}), indent=1) + "\n"
