"""Bounds and how loose they are, at hundreds of thousands of samples of random mechanisms."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import pytest

from analytic.kinematics import solve
from models.array import Array
from models.motion import Motion
from tests.analytic.change_points.jets import Jet
from tests.analytic.oracle import Place
from tests.analytic.wide_chain import HAS_DIGITS, PI, Rows, Solved, Wide, WideChain
from tests.worlds.tiers import slowly
from tests.worlds.wide_angles import made, times

pytestmark = pytest.mark.skipif(not HAS_DIGITS, reason="long doubles here are floats")
SAMPLES = 200
"""Of each mechanism."""
OWN = 2.0**-58
"""What the long doubles are wrong by themselves, over the largest of the motion at that level, or
one below and the fastest link: of what is exact, a bound of 0."""
LEVELS = ("value", "rate", "second")
QUANTITIES = {
    "links": ("theta", "omega", "alpha"),
    "points": ("position", "velocity", "acceleration"),
    "sliders": ("displacement", "speed", "rate of speed"),
}
LOOSE = {"position": 40.0, "velocity": 50.0, "acceleration": 80.0, "alpha": 300.0}
"""What the bounds may be over the errors; of those that are exact, none."""


@dataclass(frozen=True)
class Held:
    """Errors and bounds of one quantity of one body, (T,)."""

    quantity: str
    error: Array
    bound: Array


def _beside(motion: Motion, exact: Solved) -> Iterator[Held]:
    fastest = max(np.abs(link.omega).max() for link in motion.links.values())
    for kind, names in QUANTITIES.items():
        bodies = {body: _levels(jet) for body, jet in getattr(exact, kind).items()}
        if not bodies:
            continue
        largest = [max(np.abs(rows[k]).max() for rows in bodies.values()) for k in range(3)]
        first = 1.0 if kind == "links" else largest[0]  # whole turns have no part in it
        largest = [first, max(largest[1], first * fastest), largest[2]]
        largest[2] = max(largest[2], largest[1] * fastest)
        for body, levels in bodies.items():
            found = vars(getattr(motion, kind)[body]).values()
            limits = vars(getattr(motion.bound, kind)[body]).values()
            for k, (array, limit) in enumerate(zip(found, limits, strict=True)):
                apart = Wide(array.T) - levels[k]
                if names[k] == "theta":
                    apart -= 2 * PI * np.round(apart / (2 * PI))
                error = np.hypot(*apart) if kind == "points" else np.abs(apart)
                error = np.where(error > OWN * largest[k], error, 0)
                yield Held(names[k], np.float64(error), limit)


def _levels(exact: Jet | Place) -> list[Rows]:
    """Value, rate and second derivative, (T,) or (2, T)."""
    if isinstance(exact, Jet):
        return [getattr(exact, name) for name in LEVELS]
    pairs = [(getattr(exact.x, name), getattr(exact.y, name)) for name in LEVELS]
    return [np.stack(np.broadcast_arrays(*pair)).reshape(2, -1) for pair in pairs]


MANY = "three hundred thousand instants: one in ten thousand may be worse"
PARTS = [slowly(range(k, k + 150), reason=MANY) for k in range(0, 1500, 150)]


@pytest.mark.parametrize("numbers", [range(6), *PARTS], ids=str)
def test_errors_stay_below_their_bounds_at_thousands_of_samples(numbers: range) -> None:
    """Of all dyads, with angles up to a million degrees and times up to a million turns: no error
    above its bound, and none that is missing. Within the first turn the bounds are some ten times
    the errors; they grow with what is derived from what."""
    loose: dict[str, list[Array]] = {name: [] for name in LOOSE}
    for number in numbers:
        turned = made(number)
        motion = solve(turned.scene, times(turned.scene, number, SAMPLES))
        exact = WideChain(turned.scene, turned.given).solve(motion)
        for row in _beside(motion, exact):
            over = np.flatnonzero(~(row.error <= row.bound))
            assert not over.size, (
                f"mechanism {number}: {row.quantity}: error {row.error[over[0]]:.3g} above the "
                f"bound {row.bound[over[0]]:.3g}, at {over.size} of {SAMPLES} samples"
            )
            if row.quantity in LOOSE:
                known = np.flatnonzero((row.error > 0.0) & np.isfinite(row.bound))
                known = known[known < SAMPLES // 3]
                loose[row.quantity].append(row.bound[known] / row.error[known])
    for name, most in LOOSE.items():
        assert np.median(np.concatenate(loose[name])) < most, name
