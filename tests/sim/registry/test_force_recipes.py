"""The recipes run as they are pasted, and print the forces of the reference."""

import contextlib
import io
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from analytic.forces import kinetostatics
from models.errors import EngineError
from models.files.reading import load_scene
from models.scene import Driver, Scene
from models.scene.characteristics import Constant, Sine
from models.scene.driver import Released
from models.scene.hard import double_parallelogram
from models.scene.loads import ConstantFriction, Load, PinSpring
from sim.registry.offers import force_recipe
from tests.worlds.let_go import released
from tests.worlds.runs import acted_on, start_of, tuned

FOURBAR = load_scene("fourbar-lecture-1")
SETTLED = 36
"""Samples after which nothing is left of what a start shakes: exudyn's are off by 6e-3 at first."""


def recipe(name: str, scene: Scene, steps: float = 720.0) -> str:
    return force_recipe(name, scene, start_of(scene), tuned(name), steps)


def elsewhere(text: str, folder: Path) -> str:
    """What a program prints in a Python to which nothing of ours is shown."""
    program = folder / "recipe.py"
    program.write_text(text, encoding="utf-8")
    command = [sys.executable, "-I", "-W", "error", program.name]
    done = subprocess.run(command, check=False, cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def printed(program: str) -> str:
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        exec(program, {})
    return out.getvalue()


def columns_of(text: str) -> dict[str, np.ndarray]:
    rows = np.loadtxt(io.StringIO(text), delimiter=",", skiprows=1)
    return dict(zip(text.splitlines()[0].split(","), rows.T, strict=True))


def off(scene: Scene, columns: dict[str, np.ndarray], settled: int) -> float:
    """The largest error of what was printed, as shares of the largest reaction and torque."""
    columns = {name: column[settled:] for name, column in columns.items()}
    true = kinetostatics.forces(scene, columns["time_s"], bound=False)
    largest = max(np.abs(force).max() for by in true.pins.values() for force in by.values())
    errors = [np.abs(columns["torque_n_m"] - true.torque).max() / np.abs(true.torque).max()]
    for name in columns:
        if name.endswith(("x_n", "y_n")):
            point, body, axis = name.rsplit(".", 2)
            exact = true.pins[point][body][:, "xy".index(axis[0])]
            errors.append(np.abs(columns[name] - exact).max() / largest)
    assert len(errors) >= 3
    return float(max(errors))


def test_a_recipe_runs_without_us(tmp_path: Path) -> None:
    text = recipe("mujoco", FOURBAR)
    for ours in ("crankcheck", "models", "analytic", "sim.", "reports"):
        assert f"import {ours}" not in text
        assert f"from {ours}" not in text
    columns = columns_of(elsewhere(text, tmp_path))
    assert {"C.rocker.x_n", "C.rocker.y_n"} < set(columns)
    assert off(FOURBAR, columns, SETTLED) < 1e-4


WEIGHT = Load("weight", "coupler", "C", Constant(5.0), direction_rad=-0.5 * np.pi)


@pytest.mark.parametrize(("name", "scene", "steps", "settled", "most"), [
    ("mujoco", acted_on(FOURBAR, WEIGHT, ConstantFriction("A", 0.05)), 720, SETTLED, 1e-4),
    ("mujoco", load_scene("slider-crank-excel-210"), 720, SETTLED, 1e-4),
    ("pymunk", FOURBAR, 720, 0, 5e-4),
    ("pymunk", load_scene("slider-crank-excel-350"), 360, 0, 2e-3),  # a rail
    # A groove in a moving guide, a gear, and a body without turns.
    ("pymunk", load_scene("scotch-yoke"), 360, 0, 2e-3),
    ("pymunk", load_scene("slotted-lever"), 360, 0, 2e-3),  # a rail that moves
    ("exudyn", replace(load_scene("shaper"), gravity_m_s2=(0.5, -9.81)), 720, SETTLED, 1e-3),
    ("exudyn", load_scene("slotted-lever"), 720, SETTLED, 1e-3),
])  # fmt: skip
def test_a_recipe_has_the_forces_of_the_reference(
    name: str, scene: Scene, steps: int, settled: int, most: float
) -> None:
    """Those of pymunk from the first step on."""
    program = recipe(name, scene, steps)
    assert "crankcheck" not in program
    columns = columns_of(printed(program))
    assert len(columns["time_s"]) == steps + (name != "pymunk")
    assert off(scene, columns, settled) < most


PULSE, PUSH = (Load("push", "rocker", None, course) for course in (Sine(1.0, 1.0), Constant(1.0)))
SPRING = PinSpring("knee", 1.5, 0.02, -0.3, "B", ("crank", "coupler"))
FREE = replace(FOURBAR, driver=Driver("crank", Released(1.0, 2.0, 1.0)))
REDUNDANT = double_parallelogram("double-parallelogram", source="test")


@pytest.mark.parametrize(("name", "scene", "words"), [
    ("mujoco", acted_on(FOURBAR, PULSE), r"loads.push comes as a control of each step"),
    ("mujoco", load_scene("tangent"), r"tangent: driver comes as a control"),
    ("pymunk", acted_on(FOURBAR, PUSH), r"leaves out loads\.push; remove them"),
    ("pymunk", acted_on(FREE, SPRING), r"leaves out springs\.knee, a driver in free motion"),
    ("pymunk", load_scene("tangent"), "leaves out a driver whose speed is not constant"),
    ("pymunk", REDUNDANT, "redundant links leave the reactions open"),
    ("exudyn", acted_on(FOURBAR, PUSH), "does not cover loads; remove that"),
])  # fmt: skip
def test_what_a_recipe_would_leave_out_is_refused(name: str, scene: Scene, words: str) -> None:
    start = released(scene)[0] if scene.is_free else start_of(scene)
    with pytest.raises(EngineError, match=words):
        force_recipe(name, scene, start, tuned(name), 90.0)
