"""Forces of random mechanisms by groups and by multipliers: nowhere further apart than the bounds.

The multipliers carry no bounds. What rounding may do to them is taken from the matrix of each
sample, component by component (R. D. Skeel, Scaling for numerical stability in Gaussian
elimination, J. ACM 26, 1979): eps |A^-1| (|A| |x| + |b|), which grows towards dead points as the
bounds do.
"""

from __future__ import annotations

import numpy as np
import pytest

from analytic.check import multipliers
from analytic.dyads.plane import EPS
from analytic.forces import kinetostatics
from analytic.kinematics import solve
from models.array import Array
from models.forces import ForceBound, Forces
from models.motion import Motion
from models.scene import Scene
from tests.analytic.forces.beside import series
from tests.worlds.loading import loaded_mechanism
from tests.worlds.tiers import slowly

SAMPLES = 3
ROUNDINGS = 1.0
"""Of the entries of a matrix and of its elimination, in units of Skeel's bound."""


def worst(number: int) -> tuple[float, str]:
    """How far the two are apart in the mechanism of a number, over what they may be, and where."""
    scene, near = loaded_mechanism(number)
    period = scene.driver.law.period_s
    time_s = np.array([0.0]) if near else np.linspace(0.05, 0.95, SAMPLES) * period
    motion = solve(scene, time_s)
    found = kinetostatics.forces(scene, time_s)
    assert found.bound is not None
    other, rounded = _multipliers(scene, motion)
    theirs, limits, roundings = dict(series(other)), _limits(found.bound), dict(series(rounded))
    most = (0.0, "")
    for name, ours in series(found):
        apart, rounding = _length(ours - theirs[name]), _length(roundings[name])
        ratio = float(np.max(apart / (2.0 * limits[name] + ROUNDINGS * rounding)))
        most = max(most, (ratio, name))
    return most


def _multipliers(scene: Scene, motion: Motion) -> tuple[Forces, Forces]:
    """The forces, and what rounding may do to each."""
    system = multipliers.equations(scene, motion)
    turned = np.swapaxes(system.jacobian, 1, 2)
    q, x = system.accelerations()[:, :, None], system.multipliers()[:, :, None]
    by_q = EPS * _skeel(system.jacobian, q, system.gamma[:, :, None])
    inertia = np.abs(system.mass)
    right = np.abs(system.applied)[:, :, None] + inertia @ (np.abs(q) + by_q / EPS)
    off = EPS * (_skeel(turned, x, right) + np.abs(x).max(axis=1, keepdims=True))
    held, time_s = system.constraints, motion.time_s
    found = multipliers.reactions(scene, held, time_s, -x[:, :, 0])
    return found, multipliers.reactions(scene, held, time_s, off[:, :, 0])


def _skeel(matrix: Array, x: Array, right: Array) -> Array:
    return np.abs(np.linalg.inv(matrix)) @ (np.abs(matrix) @ np.abs(x) + np.abs(right))


def _length(series: Array) -> Array:
    """Of every sample (T,) of numbers or of vectors."""
    return np.abs(series) if series.ndim == 1 else np.hypot(*series.T)


def _limits(bound: ForceBound) -> dict[str, Array]:
    """The bounds under the names of the series."""
    limits = {"torque": bound.torque}
    for point, by_body in bound.pins.items():
        limits |= {f"pin {point} on {body}": limit for body, limit in by_body.items()}
    for name, one in bound.sliders.items():
        limits |= {f"normal {name}": one.normal, f"moment {name}": one.moment}
    return limits


PARTS = [range(1000 * part, 1000 * (part + 1)) for part in range(8)]


@pytest.mark.parametrize(
    "numbers",
    [range(12), *(slowly(part, reason="one in a thousand is rarer") for part in PARTS)],
    ids=str,
)
def test_two_methods_are_within_their_bounds(numbers: range) -> None:
    """Of all dyads, on fixed and moving guides, half of them near a dead point."""
    for number in numbers:
        ratio, where = worst(number)
        assert ratio <= 1.0, f"mechanism {number}, {where}: {ratio:.3g} times what may be"
