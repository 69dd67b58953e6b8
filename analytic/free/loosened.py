"""A scene with its driver let go, told by the angle of a link that is pinned to the ground.

Nothing drives what is let go, so any link may tell its motion. Of a crank that is its own angle; in
place of a slider, or of the pin of two moving links, a link at the ground takes over at the angle
and with the speed that it has at the start, in the assembly that stands there.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from analytic.kinematics import in_assembly, solve
from models.driver import Released, let_go
from models.errors import CrankcheckError
from models.laws import ConstantSpeed
from models.motion import Motion
from models.scene import Driver, Scene

STILL = 1e-9
"""Of the fastest link's rate: a link that does not move at the start tells no speed."""


def loosened(scene: Scene, duration_s: float | None = None) -> Scene:
    """The scene let go, as `models.driver.let_go` has it, of whatever joint its driver is.

    Raises
    ------
    CrankcheckError
        No link at the ground can tell its motion: none has groups that are solved, or moves at the
        start.
    """
    free = let_go(scene, duration_s)
    if scene.driver.is_crank:
        return free
    start = solve(scene, np.zeros(1), bound=False)
    law = free.driver.law
    assert isinstance(law, Released)
    for link in _by_speed(scene, start):
        theta, omega = (float(s[0]) for s in (start.links[link].theta, start.links[link].omega))
        told = Driver(link, ConstantSpeed(theta, 1.0))
        held = in_assembly(replace(scene, driver=told), start)
        if held is not None:
            told = Driver(link, Released(theta, omega, law.duration_s))
            return replace(held, driver=told, start=free.start)
    raise CrankcheckError(
        f"{scene.name}: it is driven at {scene.driver.joint}, and no link that is pinned to the "
        "ground can tell its motion when it is let go; drive it at a link"
    )


def _by_speed(scene: Scene, start: Motion) -> list[str]:
    """The links that are pinned to the ground, the fastest first: one near a limit of its own tells
    badly of the others."""
    speeds = {
        name: abs(float(start.links[name].omega[0]))
        for name, link in scene.links.items()
        if any(point in scene.ground for point in link.points)
    }
    most = max((abs(float(m.omega[0])) for m in start.links.values()), default=0.0)
    moving = [name for name, speed in speeds.items() if speed > STILL * most]
    return sorted(moving or speeds, key=lambda name: -speeds[name])
