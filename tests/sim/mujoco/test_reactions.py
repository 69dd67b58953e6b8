"""The forces that MuJoCo reports: each body in equilibrium, and against the reference."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

from analytic.forces import kinetostatics
from analytic.kinematics import solve
from models.files import load_scene, shipped
from models.forces import Forces
from models.scene import Scene
from sim.engine import Drive, ForceSession, Settings
from sim.registry import engine
from sim.settings import resolved
from tests.worlds.equilibrium import left_over
from tests.worlds.tiers import few

STEPS = 720
WITHIN: Mapping[str, float] = {
    "scotch-yoke": 4e-4,
    "shaper": 8e-4,
    "fourbar-double-crank": 3e-4,
    "slider-crank-offset": 1.2e-4,
    "slider-crank-central": 1.2e-4,
}
"""Of the largest reaction, and torque of the largest torque, where it is not 1e-4."""

KINDS = ("sixbar-watt", "slider-crank-excel-210", "shaper", "scotch-yoke", "slotted-lever")


def opened(
    scene: Scene,
    settings: Settings | None = None,
    *,
    steps: int = STEPS,
    drive: Drive = "prescribed",
    profile: str = "tuned",
) -> ForceSession:
    mujoco, state = engine("mujoco"), solve(scene, np.zeros(1)).state()
    chosen = resolved(mujoco.profiles[profile], settings)
    session = mujoco.open(scene, state, chosen, scene.driver.law.period_s / steps, drive)
    assert hasattr(session, "record_forces")
    return session  # type: ignore[return-value]


def worst_of(scene: Scene, forces: Forces) -> tuple[float, float]:
    """The largest error of a reaction over the largest reaction, and that of the torque."""
    true = kinetostatics.forces(scene, forces.time_s, bound=False, skip_dead_points=True)
    pairs = [(forces.pins[p][b], f) for p, by in true.pins.items() for b, f in by.items()]
    normals = [(forces.sliders[s].normal, one.normal) for s, one in true.sliders.items()]
    largest = max(np.nanmax(np.hypot(*f.T)) for _, f in pairs)
    off = [np.nanmax(np.hypot(*(found - f).T)) for found, f in pairs]
    off += [np.nanmax(np.abs(found - f)) for found, f in normals]
    turning = [(forces.sliders[s].moment, one.moment) for s, one in true.sliders.items()]
    off += [np.nanmax(np.abs(found - m)) / scene.longest_m for found, m in turning]
    torque = np.nanmax(np.abs(forces.torque - true.torque)) / np.nanmax(np.abs(true.torque))
    return float(max(off) / largest), float(torque)


@pytest.mark.parametrize("name", few(sorted(shipped()), KINDS, "shapes of the same kinds"))
def test_forces_are_those_of_the_reference_and_of_each_bodys_equilibrium(name: str) -> None:
    scene = load_scene(name)
    log = opened(scene).record_forces(STEPS, 1)
    for by_body in log.forces.pins.values():
        assert np.abs(sum(by_body.values())).max() == pytest.approx(0.0, abs=1e-12)
    force, moment = left_over(scene, log)
    assert max(force, moment / scene.longest_m) < 1e-9
    reaction, torque = worst_of(scene, log.forces)
    assert max(reaction, torque) < WITHIN.get(name, 1e-4)


def test_forces_change_nothing_of_the_motion() -> None:
    scene = load_scene("whitworth")
    alone, with_forces = opened(scene).record(60, 3), opened(scene).record_forces(60, 3)
    for name, pose in alone.poses.bodies.items():
        for key, series in vars(pose).items():
            np.testing.assert_array_equal(series, vars(with_forces.poses.bodies[name])[key])
    assert len(with_forces.forces.time_s) == len(alone.poses.time_s) == 21


@pytest.mark.parametrize("close", ["B", "C", "D"])
def test_forces_do_not_depend_on_where_the_loop_is_closed(close: str) -> None:
    scene = load_scene("fourbar-lecture-1")
    log = opened(scene, {"close": close}).record_forces(STEPS, 4)
    force, moment = left_over(scene, log)
    assert max(force, moment / scene.longest_m) < 1e-9
    assert max(worst_of(scene, log.forces)) < 1e-4
