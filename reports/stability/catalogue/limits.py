"""Cranks that are driven against a limit position which they cannot pass."""

from __future__ import annotations

import math
from functools import partial

from analytic.mechanism.fourbar import FourBar
from models.hard import fourbar
from reports.stability.case import Case, Trial

BEFORE_RAD = 0.5
"""How far before the limit the crank starts, and how far beyond it its command ends."""
DT_S = 1e-4
SAMPLES = 1000


def _towards(name: str, lengths: tuple[float, float, float, float], speed: float) -> Trial:
    """A crank that is told to pass its far limit by as much as it starts before it."""
    limit = FourBar(*lengths).driver_range_rad[1]
    start = math.degrees(limit - BEFORE_RAD)
    source = f"{name}, driven by a servo towards the end of its range"
    scene = fourbar(name, *lengths, source=source, start_deg=start, speed_rad_s=speed)
    steps = scene.driver.law.period_s / DT_S
    turns = 2.0 * BEFORE_RAD / math.tau
    return Trial(
        scene,
        steps_per_turn=steps,
        turns=turns,
        every=max(round(turns * steps / SAMPLES), 1),
        drive="servo",
        limit_rad=limit,
    )


CASES = tuple(
    Case(
        name=f"{name}-limit",
        title=f"{name.capitalize()} against its limit",
        source="limit positions from the triangle of the links in line",
        truth="the driver angle at which coupler and rocker are in line",
        expected="locked: the crank stands at the limit, the pins stay closed, nothing explodes",
        parameter="speed towards the limit",
        unit="rad/s",
        values=(0.1, 1.0, 10.0, 100.0),
        trial=partial(_towards, name, lengths_m),
        good=("locked",),
        judge="limit",
        within=2e-2,
    )
    for name, lengths_m in (
        ("triple-rocker", (0.2, 0.25, 0.3, 0.5)),
        ("double-rocker", (0.25, 0.1, 0.2, 0.3)),
    )
)
