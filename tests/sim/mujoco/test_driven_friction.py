"""What rubs in the driven joint itself is no part of what the drive exerts."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from analytic.forces.kinetostatics import forces
from analytic.kinematics import solve
from models.files import load_scene
from models.friction import ConstantFriction
from models.scene import Scene
from sim.run import run


def turned(scene: Scene) -> Scene:
    """The same driver, with the two links of its pin in the other order."""
    driver = scene.driver
    law = replace(driver.law, start_rad=-driver.law.start_rad, speed_rad_s=-driver.law.speed_rad_s)  # type: ignore[attr-defined, call-arg]  # of constant speed
    return replace(scene, driver=replace(driver, link=driver.base, base=driver.link, law=law))


@pytest.mark.parametrize(
    ("scene", "joint", "size"),
    [
        (load_scene("slider-crank-by-piston"), "C", 0.5),
        (load_scene("fourbar-by-coupler"), "B", 0.02),
        (turned(load_scene("fourbar-by-coupler")), "B", 0.02),
        (load_scene("fourbar-lecture-1"), "A", 0.02),
    ],
    ids=["slider", "pin", "pin, links in the other order", "crank"],
)
def test_friction_of_the_driven_joint_is_not_taken_for_the_drive(
    scene: Scene, joint: str, size: float
) -> None:
    rubbing = replace(scene, friction={joint: ConstantFriction(joint, size)})
    start = solve(rubbing, np.zeros(1)).state()
    dt_s = scene.driver.law.period_s / 720
    done = run(rubbing, start, "mujoco", "tuned", dt_s=dt_s, steps=120, with_forces=True)
    acting = done.motion.forces
    times = acting.time_s[20:]
    drive = forces(rubbing, times, skip_dead_points=True).torque
    off = np.nanmax(np.abs(acting.torque[20:] - drive))
    assert off < 0.02 * size
