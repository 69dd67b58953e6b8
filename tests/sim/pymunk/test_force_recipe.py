"""The recipe of pymunk for forces: a program of its own, whose numbers are the reference's."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from analytic.forces.kinetostatics import forces
from analytic.kinematics import solve
from models.array import Array
from models.characteristics import Constant
from models.errors import EngineError
from models.files import load_scene
from models.hard import double_parallelogram
from models.loads import Load
from models.scene import Scene
from sim.pymunk.engine import ENGINE
from sim.pymunk.force_recipe import FORCE_RECIPE
from sim.settings import resolved
from tests.sim.test_force_recipes import printed


def recipe(scene: Scene, steps: int = 720) -> str:
    state = solve(scene, np.array([0.1])).state()
    settings = resolved(ENGINE.profiles["tuned"], None)
    return FORCE_RECIPE(scene, state, settings, scene.driver.law.period_s / steps)


def compare(scene: Scene, text: str, most: float) -> list[str]:
    """The columns, all of which agree with the reference."""
    head, *rows = text.splitlines()
    columns = head.split(",")
    numbers: Array = np.array([[float(x) for x in row.split(",")] for row in rows])
    exact = forces(scene, numbers[:, 0], bound=False)
    largest = max(np.abs(force).max() for pin in exact.pins.values() for force in pin.values())
    for k, column in enumerate(columns[1:-1], 1):
        point, body, axis = column.split(".")
        off = np.abs(numbers[:, k] - exact.pins[point][body][:, "xy".index(axis[0])])
        assert off.max() < most * largest, column
    off = np.abs(numbers[:, -1] - exact.torque)
    assert off.max() < most * np.abs(exact.torque).max()
    return columns


def test_the_program_prints_a_row_for_each_step() -> None:
    scene = load_scene("fourbar-lecture-1")
    program = recipe(scene)
    assert "crankcheck" not in program
    text = printed(program)
    columns = compare(scene, text, 5e-4)
    assert len(text.splitlines()) == 721
    assert columns[0] == "time_s"
    assert columns[-1] == "torque_n_m"
    assert {"C.rocker.x_n", "C.rocker.y_n"} < set(columns)


@pytest.mark.parametrize(
    "name",
    [
        "slider-crank-excel-350",  # a rail
        "scotch-yoke",  # a groove in a moving guide, a gear, and a body that can not turn
        "slotted-lever",  # a rail that moves
    ],
)
def test_every_kind_of_line_is_held(name: str) -> None:
    scene = load_scene(name)
    compare(scene, printed(recipe(scene, 360)), 2e-3)


def test_what_the_program_would_leave_out_is_refused() -> None:
    scene = load_scene("fourbar-lecture-1")
    loaded = replace(scene, loads={"push": Load("push", "rocker", None, Constant(1.0))})
    with pytest.raises(EngineError, match=r"leaves out loads\.push; take them out"):
        recipe(loaded)
    with pytest.raises(EngineError, match="leaves out a driver whose speed is not constant"):
        recipe(load_scene("tangent"))
    with pytest.raises(EngineError, match="redundant links leave the reactions open"):
        recipe(double_parallelogram("double-parallelogram", source="test"))
