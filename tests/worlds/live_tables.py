"""Mechanisms by the inputs of their sheets, and sheets held to the reference."""

import io
import math
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import openpyxl
import pytest

from analytic.kinematics import solve
from models.files.reading import load_scene
from models.motion import Motion
from models.scene import Link, Scene
from reports.lectures.drawing.workbook.formulas import FormulaTable
from reports.lectures.drawing.workbook.live_workbook import formulas_of, live_workbook

ROWS, STEP_DEG = 13, 27.5
KINDS = ("fourbar-lecture-1", "slider-crank-offset", "slotted-lever")
Columns = Mapping[str, np.ndarray]


@cache
def live(name: str) -> tuple[Scene, FormulaTable]:
    scene = load_scene(name)
    table = formulas_of(scene, ROWS, STEP_DEG)
    assert table is not None
    return scene, table


def inputs_of(table: FormulaTable) -> dict[str, float]:
    return {each.name: each.value for each in table.inputs}


def scene_of(kind: str, inputs: Mapping[str, float]) -> Scene:
    """The shipped scene of a kind with numbers of its sheet, put in by hand."""
    scene = load_scene(kind)
    law = replace(
        scene.driver.law, speed_rad_s=inputs["omega"], start_rad=math.radians(inputs["start_deg"])
    )
    scene = replace(scene, driver=replace(scene.driver, law=law))
    return {"BC": _four_bar, "L": _slider_crank, "rho0": _slotted_lever}[
        next(name for name in ("BC", "L", "rho0") if name in inputs)
    ](scene, inputs)


def _four_bar(scene: Scene, given: Mapping[str, float]) -> Scene:
    direction = math.radians(given["AD_deg"])
    far = given["AD"] * math.cos(direction), given["AD"] * math.sin(direction)
    links = {
        **_bar(scene, "crank", "AB", given["AB"]),
        **_bar(scene, "coupler", "BC", given["BC"]),
        **_bar(scene, "rocker", "DC", given["CD"]),
    }
    ground = {"A": (0.0, 0.0), "D": far}
    return replace(scene, links=links, ground=ground, branch={"C": int(given["branch"])})


def _slider_crank(scene: Scene, given: Mapping[str, float]) -> Scene:
    links = {**_bar(scene, "crank", "AB", given["R"]), **_bar(scene, "rod", "BC", given["L"])}
    angle = math.radians(given["line_deg"])
    through = _turned(given["X0"], given["e"], angle)
    slider = replace(scene.sliders["C"], through_m=through, direction_rad=angle)
    branch = {"C": int(given["branch"])}
    return replace(scene, links=links, sliders={"C": slider}, branch=branch)


def _slotted_lever(scene: Scene, given: Mapping[str, float]) -> Scene:
    links = {**_bar(scene, "crank", "AB", given["R"]), "lever": scene.links["lever"]}
    slider = replace(scene.sliders["B"], through_m=(given["rho0"], given["o"]))
    ground = {"A": (0.0, 0.0), "C": (given["ACx"], given["ACy"])}
    branch = {"B": int(given["branch"])}
    return replace(scene, links=links, sliders={"B": slider}, ground=ground, branch=branch)


def _bar(scene: Scene, name: str, pins: str, length: float) -> dict[str, Link]:
    points = {pins[0]: (0.0, 0.0), pins[1]: (length, 0.0)}
    return {name: replace(scene.links[name], points=points)}


def _turned(x: float, y: float, angle: float) -> tuple[float, float]:
    c, s = math.cos(angle), math.sin(angle)
    return c * x - s * y, s * x + c * y


def held_to_the_reference(
    columns: Columns, scene: Scene, told: str = "", *, turned: bool = False
) -> None:
    """Every output of the columns is the reference's to 1e-12 of its size, or of 1; where frames of
    links are ``turned`` against the lines of sheets, angles but for that."""
    motion = solve(scene, np.asarray(columns["time"], float), bound=False)
    for name, exact in _outputs(columns, motion):
        scale = max(1.0, float(np.abs(exact).max()))
        found = np.asarray(columns[name], float)
        if name.startswith("theta"):  # angles count from any turn
            apart = found[0] - exact[0]
            found = found - (apart if turned else math.tau * round(apart / math.tau))
        assert found == pytest.approx(exact, abs=1e-12 * scale), f"{name} {told}"


def _outputs(columns: Columns, motion: Motion) -> list[tuple[str, np.ndarray]]:
    if "omega_bc" in columns:
        names = {"bc": "coupler", "dc": "rocker"}
        return [
            (f"{kind}_{key}", getattr(motion.links[link], kind))
            for key, link in names.items()
            for kind in ("theta", "omega", "alpha")
        ]
    (slider,) = motion.sliders.values()
    rates = ("s", slider.displacement), ("X_rate", slider.speed), ("X_gain", slider.acceleration)
    if "X" in columns:
        rod = motion.links["rod"]
        return [*rates, ("omega_rod", rod.omega), ("alpha_rod", rod.alpha)]
    lever = motion.links["lever"]
    return [
        ("s", slider.displacement), ("slide", slider.speed), ("gain", slider.acceleration),
        ("theta", lever.theta), ("omega3", lever.omega), ("alpha3", lever.alpha),
    ]  # fmt: skip


def write_changed(table: FormulaTable, inputs: Mapping[str, float], file: Path) -> None:
    """The workbook of a table with other inputs in its cells, as a user would put them there."""
    book = openpyxl.load_workbook(io.BytesIO(live_workbook(table, {})))
    for row in book["inputs"].iter_rows(min_row=2, max_row=1 + len(table.inputs)):
        row[1].value = inputs[row[0].value]
    book.save(file)
