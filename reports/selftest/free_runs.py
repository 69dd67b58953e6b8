"""The runs of free motion that faults are planted in."""

from __future__ import annotations

SWING, PULSE = "fourbar-swing", "fourbar-pulse"
SPRING, PRESS = "slider-crank-spring", "press-motor"
FREE_RUNS: dict[str, tuple[float, int]] = {
    SWING: (5e-4, 2000),
    PULSE: (1e-3, 1500),
    SPRING: (5e-4, 2000),
    PRESS: (1e-3, 500),
}
"""Step [s] and number of steps by scene: as long as the fault needs to show, and no longer."""
