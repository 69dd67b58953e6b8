"""Four-bars that are thrown at their toggle with just enough energy, or with just too little."""

from __future__ import annotations

import math
from functools import lru_cache, partial

from analytic.free.toggle_barrier import ToggleBarrier
from analytic.mechanism.fourbar import FourBar
from models.hard import fourbar
from reports.stability.case import Case, Throw, Trial

LENGTHS_M = (0.2, 0.25, 0.3, 0.5)
BEFORE_RAD = 0.3
DT_S = 1e-3


@lru_cache(maxsize=1)
def _barrier() -> ToggleBarrier:
    limit = FourBar(*LENGTHS_M).driver_range_rad[1]
    return ToggleBarrier.of(
        fourbar(
            "triple-rocker-thrown",
            *LENGTHS_M,
            source="gravity points to where the toggle is the highest place",
            start_deg=math.degrees(limit - BEFORE_RAD),
        )
    )


def _thrown(side: float, margin: float) -> Trial:
    throw = Throw(_barrier(), side * margin)
    scene = throw.barrier.thrown(throw.margin)
    steps = scene.driver.law.period_s / DT_S
    return Trial(scene, steps_per_turn=steps, turns=1.0, drive="free", throw=throw)


CASES = tuple(
    Case(
        name=f"toggle-{name}",
        title=f"Thrown at the toggle with {words}",
        source="limit position on top of a hill of the potential energy",
        truth=f"by its energy it {truth}",
        expected="as its energy says",
        parameter="energy beside that of the top, over the height of the hill",
        values=(1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6),
        trial=partial(_thrown, side),
        judge="toggle",
    )
    for name, words, truth, side in (
        ("over", "just enough energy", "gets over into the other assembly", 1.0),
        ("short", "too little energy", "falls back before the toggle", -1.0),
    )
)
