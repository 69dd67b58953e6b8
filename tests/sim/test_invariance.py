"""The same mechanism elsewhere, turned, mirrored, larger, faster or backwards errs as much."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from analytic.check.moved_scene import moved, rotated, scaled
from analytic.kinematics import solve
from models.files import load_scene
from models.laws import ConstantSpeed
from models.scene import Scene
from sim.registry import ENGINES
from sim.run import run
from tests.worlds.other_way import mirrored

SCENES = ("fourbar-lecture-1", "slider-crank-offset", "slotted-lever", "shaper")
STEPS_PER_TURN = 400
SOLVED = 1e-9
"""As pure numbers: errors up to this are where an engine ends that solves for its joints."""


def at_speed(scene: Scene, speed_rad_s: float) -> Scene:
    law = scene.driver.law
    assert isinstance(law, ConstantSpeed)
    return replace(scene, driver=replace(scene.driver, law=replace(law, speed_rad_s=speed_rad_s)))


CHANGES: dict[str, Callable[[Scene], Scene]] = {
    "rotated": lambda scene: rotated(scene, 0.7),
    "moved": lambda scene: moved(scene, (3.0, -2.0)),
    "mirrored": mirrored,
    "ten times as large": lambda scene: scaled(scene, 10.0),
    "a tenth as large": lambda scene: scaled(scene, 0.1),
    "backwards": lambda scene: at_speed(scene, -10.0),
    "at 500 rad/s": lambda scene: at_speed(scene, 500.0),
    "at 0.01 rad/s": lambda scene: at_speed(scene, 0.01),
}


def pure_errors(scene: Scene, engine: str) -> dict[str, float]:
    """Largest errors over 1.5 turns as pure numbers: position, velocity, acceleration and gap."""
    law, scale = scene.driver.law, scene.longest_m
    start = solve(scene, np.array([0.0])).state(0)
    dt_s = law.period_s / STEPS_PER_TURN
    result = run(scene, start, engine, dt_s=dt_s, steps=3 * STEPS_PER_TURN // 2)
    assert result.motion is not None
    assert result.velocity_time_s is not None
    exact, beside = (solve(scene, t) for t in (result.motion.time_s, result.velocity_time_s))
    found: dict[str, list[float]] = {"angle": [], "speed": [], "acceleration": [], "slide": [0.0]}
    for name, link in result.motion.links.items():
        wanted = exact.links[name]
        found["angle"].append(float(np.abs(link.theta - wanted.theta).max()))
        off = np.abs(link.omega - beside.links[name].omega).max()
        found["speed"].append(float(off) / law.peak_speed_rad_s)
        off = np.abs(link.alpha - wanted.alpha).max()
        found["acceleration"].append(float(off) / law.peak_speed_rad_s**2)
    for name, slider in result.motion.sliders.items():
        off = np.abs(slider.displacement - exact.sliders[name].displacement).max()
        found["slide"].append(float(off) / scale)
    found["gap"] = [float(gap.max()) / scale for gap in result.gaps.values()]
    if engine == "pymunk":
        del found["acceleration"]
    return {kind: max(numbers) for kind, numbers in found.items()}


@cache
def plain_errors(name: str, engine: str) -> dict[str, float]:
    """The errors of the scene as it is shipped."""
    return pure_errors(load_scene(name), engine)


@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("engine", ENGINES)
def test_pure_number_errors_stay_within_a_factor_of_two(
    engine: str, name: str, change: str
) -> None:
    plain = plain_errors(name, engine)
    other = pure_errors(CHANGES[change](load_scene(name)), engine)
    for kind, error in plain.items():
        if max(error, other[kind]) < SOLVED:
            continue
        assert error / 2 <= other[kind] <= 2 * error, f"{kind}: {other[kind]:.3g}, not {error:.3g}"
