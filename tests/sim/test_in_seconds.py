"""What of the settings is in seconds: without any, angles depend on the steps in a turn alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from analytic.kinematics import solve
from models.files import load_scene
from sim.engine import Settings
from sim.registry import ENGINES, engine
from sim.run import run
from sim.settings import resolved

SCENES = ("fourbar-lecture-1", "slider-crank-offset")
STEPS = 120
IN_SECONDS = {
    "mujoco": {"solref_timeconst_s": 0.03, "solref_timeconst_steps": 0.0},
    "pymunk": {"error_bias": 0.3, "damping": 0.5},
}
"""By engine, values that are times, or losses in a second, of their own."""


def angles(name: str, engine_name: str, settings: Settings, speed: float) -> np.ndarray:
    """The angles of all links over a turn at a speed of the driver."""
    scene = load_scene(name)
    law = scene.driver.law
    scene = replace(scene, driver=replace(scene.driver, law=replace(law, speed_rad_s=speed)))
    done = run(
        scene,
        solve(scene, np.zeros(1)).state(),
        engine_name,
        dt_s=scene.driver.law.period_s / STEPS,
        steps=STEPS,
        settings=settings,
    )
    return np.stack([link.theta for link in done.motion.links.values()])


@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize("name", ENGINES)
def test_without_them_a_speed_changes_no_angle(name: str, scene: str) -> None:
    settings = resolved(engine(name).profiles["tuned"], None)
    assert engine(name).in_seconds(settings) == ()
    slow, fast = (angles(scene, name, settings, speed) for speed in (0.37, 211.0))
    error = np.abs(slow - angles(scene, name, settings, 10.0)).max()
    assert max(error, np.abs(slow - fast).max()) < 1e-9


@pytest.mark.parametrize(
    ("name", "setting"), [(name, each) for name, values in IN_SECONDS.items() for each in values]
)
def test_each_that_is_named_does(name: str, setting: str) -> None:
    tuned = resolved(engine(name).profiles["tuned"], None)
    settings = tuned | {setting: IN_SECONDS[name][setting]}
    if setting == "solref_timeconst_s":
        assert engine(name).in_seconds(settings) == ()  # it is not in force
        settings |= {"solref_timeconst_steps": 0.0}
        named: tuple[str, ...] = ("solref_timeconst_s",)
    elif setting == "solref_timeconst_steps":
        named = ("solref_timeconst_s",)
    else:
        settings |= {"iterations": 3}  # joints that are held take no notice of a damping
        named = (setting,)
    assert engine(name).in_seconds(settings) == named
    slow, fast = (angles(SCENES[0], name, settings, speed) for speed in (1.0, 10.0))
    assert np.abs(slow - fast).max() > 1e-7


def test_an_engine_that_has_such_has_them_as_shipped() -> None:
    for name in IN_SECONDS:
        assert engine(name).in_seconds(resolved(engine(name).profiles["as-shipped"], None))
