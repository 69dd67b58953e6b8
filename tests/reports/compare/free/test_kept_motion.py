"""Loads over time that are given to the end of a run and no further."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from models.characteristics import Constant
from models.files import load_scene
from models.loads import Load
from models.scene import Scene
from models.tabulated import Tabulated
from reports.compare.compare import compare
from reports.compare.free.free_truth import free_truth
from reports.compare.free.kept_motion import kept_motion
from reports.drawing.true_motion import true_motion
from sim.run import run
from tests.worlds.tiers import slowly

DT_S, STEPS = 1e-3, 100
END_S = DT_S * STEPS
LEVEL = Constant(0.1)


def pushed(name: str, link: str, *more: tuple[float, float]) -> Scene:
    """A scene with a torque over time, whose table ends with the run but for ``more`` rows."""
    rows = ((0.0, 0.1), (0.5 * END_S, 0.2), (END_S, 0.1), *more)
    places, values = zip(*rows, strict=True)
    table = Tabulated(places, values)
    return replace(load_scene(name), loads={"push": Load("push", link, None, table)})


@pytest.mark.parametrize(
    ("name", "link"),
    [
        ("fourbar-swing", "crank"),
        slowly("double-pendulum", "upper", reason="two drivers: another truth, the same table"),
    ],
)
def test_what_follows_a_table_that_ends_with_the_run_is_as_if_it_went_on(
    name: str, link: str
) -> None:
    ends = free_truth(pushed(name, link), STEPS, DT_S)
    goes_on = free_truth(pushed(name, link, (2.0 * END_S, -0.1)), STEPS, DT_S)
    assert ends.free.until_s == END_S < goes_on.free.until_s
    time_s = DT_S * (np.arange(STEPS + 1.0) + 0.5)  # as some engines have their velocities
    own, other = (truth.at(time_s).links[link] for truth in (ends, goes_on))
    np.testing.assert_allclose(own.omega, other.omega, rtol=0, atol=1e-7)
    np.testing.assert_allclose(own.theta, other.theta, rtol=0, atol=1e-10)


@pytest.mark.parametrize("engine", ["mujoco", "pymunk"])
def test_a_run_is_compared_to_the_end_of_the_table(engine: str) -> None:
    scene = pushed("fourbar-swing", "crank")
    truth = free_truth(scene, STEPS, DT_S)
    done = run(scene, truth.start, engine, dt_s=DT_S, steps=STEPS, drive="free")
    assert done.status == "ok"
    errors = compare(truth.beside(done))
    worst = errors.worst("velocity")
    assert worst.pure < 1e-3


def test_what_is_drawn_is_what_was_compared() -> None:
    scene, same = (
        replace(load_scene("fourbar-swing"), loads={"push": Load("push", "crank", None, LEVEL)})
        for _ in range(2)
    )
    motion = free_truth(scene, STEPS, DT_S).free
    assert kept_motion(same, END_S * (1.0 + 1e-15)) is motion
    time_s = np.linspace(0.0, END_S, 5)
    theta = true_motion(same, time_s).links["crank"].theta
    assert np.array_equal(theta, motion.at(time_s).links["crank"].theta)


def test_a_motion_is_drawn_to_the_end_of_the_table() -> None:
    drawn = true_motion(pushed("fourbar-swing", "crank"), np.array([0.0, END_S]))
    assert np.isfinite(drawn.links["crank"].theta).all()
