"""Forces beside other forces, and the balance of power."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from analytic.forces import kinetostatics
from analytic.kinematics import solve, solve_driven
from models.array import Array
from models.motion import Forces, Motion
from models.scene import Scene
from tests.second_opinions import multipliers, power

AGREED = 1e-11
SAMPLES = 61


def turn(scene: Scene) -> Array:
    """Times over a period, none of them in a position of symmetry."""
    return np.linspace(0.0, scene.driver.law.period_s, SAMPLES) + 1e-3 * scene.driver.law.period_s


def at(scene: Scene, *angles_rad: float, speed: float = 1.0) -> Motion:
    return solve_driven(scene, np.array(angles_rad), np.array(speed), np.array(0.0))


def unlocked(scene: Scene, time_s: Array) -> Array:
    """The instants at which a tenth more friction would still have one equilibrium: there the
    substitutions of the second opinion settle."""
    if not scene.coulomb_joints:
        return time_s
    more = {n: replace(scene.friction[n], mu=1.1 * scene.friction[n].mu) for n in scene.friction}
    found = kinetostatics.forces(
        replace(scene, friction=more), time_s, bound=False, skip_dead_points=True
    )
    single = time_s[found.friction_solution.solutions == 1]
    assert 0 < single.size < time_s.size
    return single


def series(found: Forces) -> Iterator[tuple[str, Array]]:
    yield "torque", found.torque
    for point, by_body in found.pins.items():
        for body, force in by_body.items():
            yield f"pin {point} on {body}", force
    for name, one in found.sliders.items():
        yield f"normal {name}", one.normal
        yield f"moment {name}", one.moment
    for joint, rubbing in found.friction.items():
        yield f"rubbing {joint}", rubbing


def apart(one: Forces, other: Forces) -> float:
    """The largest difference over the largest torque or force of either."""
    ours, theirs = dict(series(one)), dict(series(other))
    assert ours.keys() == theirs.keys()
    forces = max(float(np.abs(a).max()) for n, a in ours.items() if n[0] in "pn")
    moments = max(float(np.abs(a).max()) for n, a in ours.items() if n[0] in "tm")
    return max(
        float(np.abs(a - theirs[n]).max()) / (forces if n[0] in "pn" else moments)
        for n, a in ours.items()
    )


def out_of_balance(scene: Scene, time_s: Array, found: Forces) -> float:
    balance = power.power_balance(scene, solve(scene, time_s), found.torque, found.friction)
    return float(np.max(np.abs(balance.put_in - balance.used)) / np.max(balance.scale))


def agreed(scene: Scene, time_s: Array, told: object = "") -> tuple[Forces, Forces]:
    """The forces by groups and by multipliers, which agree, and with the balance of power."""
    found = kinetostatics.forces(scene, time_s)
    other = multipliers.forces(scene, solve(scene, time_s))
    assert apart(found, other) <= AGREED, told
    assert out_of_balance(scene, time_s, found) <= AGREED, told
    return found, other
