"""The runs of free motion that faults are planted in."""

from __future__ import annotations

SWING, PULSE = "fourbar-swing", "fourbar-pulse"
SPRING, PRESS, SQUEEZER = "slider-crank-spring", "press-motor", "squeezer"
FREE_RUNS: dict[str, tuple[float, int]] = {
    SWING: (4e-4, 2500),
    PULSE: (1e-3, 1500),
    SPRING: (5e-4, 2000),
    PRESS: (1e-3, 500),
    SQUEEZER: (5e-4, 400),
}
"""Step [s] and number of steps by scene: as long as the fault needs to show, and no longer."""
