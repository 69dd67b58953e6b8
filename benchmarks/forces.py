"""What driving torque and all reactions cost beyond the kinematics that they follow from.

The four-bar at 1e5 crank positions, in this process: kinematics of all its links and points, and
forces from the same times, taking turns in rounds of a few calls; without error bounds, and with
them. Prints nanoseconds a position and the cost of the forces over that of the kinematics, with an
A/A pair that shows the noise. Exits with 1 where a ratio asked for is missed.
"""

import sys

sys.path.pop(0)  # this folder, whose logging.py would hide the standard library's

import gc
import platform
import time
from collections.abc import Callable
from importlib.metadata import version

import numpy as np

from analytic.forces.kinetostatics import forces
from analytic.kinematics import solve
from models.files.reading import load_scene
from reports.output.write import processor

POSITIONS = 100_000
ROUNDS, CALLS = 6, 4
WANTED_RATIO = 1.5
SCENE = load_scene("fourbar-lecture-1")
TIME_S = np.linspace(0.0, 10.0, POSITIONS)


def calls() -> dict[str, Callable[[], object]]:
    """What is timed, by name."""
    return {
        "kinematics": lambda: solve(SCENE, TIME_S, bound=False),
        "kinematics again (A/A)": lambda: solve(SCENE, TIME_S, bound=False),
        "forces": lambda: forces(SCENE, TIME_S, bound=False),
        "kinematics with bounds": lambda: solve(SCENE, TIME_S),
        "forces with bounds": lambda: forces(SCENE, TIME_S),
    }


def nanoseconds() -> dict[str, list[float]]:
    """Time per position of each call, the calls taking turns in rounds."""
    found: dict[str, list[float]] = {}
    gc.disable()
    for _ in range(ROUNDS):
        for name, call in calls().items():
            call()
            for _ in range(CALLS):
                start = time.perf_counter()
                call()
                spent = 1e9 * (time.perf_counter() - start) / POSITIONS
                found.setdefault(name, []).append(spent)
    gc.enable()
    return found


def main() -> int:
    """Print the table; 1 where a ratio is missed."""
    times = nanoseconds()
    print(f"{POSITIONS} crank positions of a four-bar: torque and the reactions in its four pins\n")
    print(f"{'ns a position':28}{'min':>8}{'median':>8}")
    for name, found in times.items():
        print(f"{name:28}{min(found):8.1f}{np.median(found):8.1f}")
    missed = False
    print()
    for bounds in ("", " with bounds"):
        # The times of forces hold those of the kinematics that they solve on their way.
        base = times[f"kinematics{bounds}"]
        ratio = min(times[f"forces{bounds}"]) / min(base) - 1.0
        print(f"forces{bounds} beyond kinematics: {ratio:.2f} of it (asked: {WANTED_RATIO:g})")
        missed |= ratio > WANTED_RATIO
    print(f"\nPython {platform.python_version()}, numpy {version('numpy')}; {processor()}")
    return int(missed)


if __name__ == "__main__":
    sys.exit(main())
