"""`crankcheck solve --forces` and `view --forces`: tables, files, notes, figures, and mistakes."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from analytic.forces.kinetostatics import forces
from analytic.kinematics import solve_driven
from models.files import load_scene
from models.scene import Scene
from models.scene_text import scene_text
from tests.analytic.dyads.test_redundant import parallelogram, with_strut
from tests.worlds.command_line import crank, flat
from tests.worlds.without_pdf import without_pdf


def written(scene: Scene, folder: Path) -> str:
    """The path of a scene as a file."""
    path = folder / f"{scene.name}.toml"
    path.write_text(scene_text(scene), encoding="utf-8")
    return str(path)


def test_an_angle_shows_what_newton_has_for_the_block() -> None:
    """m a of the block along its line is the rod's force, and the guide takes the rest."""
    scene = load_scene("slider-crank-offset")
    motion = solve_driven(scene, np.radians([90.0]), np.array([10.0]), np.array([0.0]))
    output = crank("solve", scene.name, "--at-deg", "90", "--forces").output

    def row(start: str) -> list[float]:
        (words,) = re.findall(rf"^{start} +([-\d. ]+)$", output, flags=re.MULTILINE)
        return [float(each) for each in words.split()]

    x, y, size, direction = row("C block C +rod")
    pull = scene.sliders["C"].mass_kg * motion.sliders["C"].acceleration[0]
    assert x == pytest.approx(pull, rel=1e-6)
    assert size == pytest.approx(np.hypot(x, y), rel=1e-6)
    assert direction == pytest.approx(np.degrees(np.arctan2(y, x)) % 360.0, rel=1e-6)
    assert row("C block +ground")[0] == pytest.approx(-y, rel=1e-6)
    (drive,) = re.findall(r"^crank +(-?[\d.]+) +(-?[\d.]+) *$", output, flags=re.MULTILINE)
    assert float(drive[1]) == pytest.approx(10.0 * float(drive[0]), rel=1e-6)


@pytest.mark.parametrize("name", ["shaper", "tangent", "sixbar-watt"])
def test_forces_over_a_turn_fit_the_page_and_tell_the_largest(name: str) -> None:
    result = crank("solve", name, "--forces")
    assert result.exit_code == 0
    assert max(len(line.rstrip()) for line in result.output.splitlines()) <= 100
    scene = load_scene(name)
    found = forces(scene, np.linspace(0.0, scene.driver.law.period_s, 721))
    largest = found.torque[np.argmax(np.abs(found.torque))]
    (row,) = (x.split() for x in result.output.splitlines() if x.startswith("driving torque"))
    assert abs(float(row[2])) == pytest.approx(abs(largest), rel=1e-5)
    for point, bodies in found.pins.items():
        assert f"{point} on {list(bodies)[1]}" in result.output
    for slider in found.sliders:
        assert f"slider {slider}, normal" in result.output


def test_a_file_has_every_force_to_the_last_bit(tmp_path: Path) -> None:
    path = tmp_path / "out.csv"
    assert crank("solve", "shaper", "--forces", "-o", str(path)).exit_code == 0
    frame = pd.read_csv(path)
    found = forces(load_scene("shaper"), frame["time_s"].to_numpy())
    rod = found.pins["E"]["rod"]
    np.testing.assert_array_equal(frame["torque_n_m"], found.torque)
    np.testing.assert_array_equal(frame[["E_rod_fx_n", "E_rod_fy_n"]], rod)
    np.testing.assert_array_equal(frame["E_rod_f_n"], np.hypot(*rod.T))
    np.testing.assert_array_equal(frame["F_slider_normal_n"], found.sliders["F"].normal)
    np.testing.assert_array_equal(frame["B_slider_moment_n_m"], found.sliders["B"].moment)
    without = tmp_path / "without.csv"
    crank("solve", "shaper", "-o", str(without))
    plain = pd.read_csv(without)
    assert list(plain) == list(frame)[: len(plain.columns)]  # what has no forces is as it was


def test_couples_that_are_0_in_a_dead_centre_are_as_certain_as_the_forces() -> None:
    """Torque and moments are 0 there, and what rounding leaves is little at the links' arms."""
    output = flat(crank("solve", "slider-crank-central", "--at-deg", "0", "--forces").output)
    assert re.search(r"Forces certain to \S+e-1\d N, \S+e-1\d N m\.", output)
    assert "dead point" not in output


def test_dead_points_of_a_turn_are_left_out_and_told(tmp_path: Path) -> None:
    scene = written(replace(parallelogram(1), name="flat"), tmp_path)
    output = flat(crank("solve", scene, "--forces").output)
    assert "Dead point, crank at 0 deg and 180 deg: the driving torque and the" in output


def test_redundant_links_leave_the_torque_and_say_why(tmp_path: Path) -> None:
    propped = replace(with_strut(parallelogram(1), "B0", "B1"), name="propped")
    with without_pdf():
        result = crank("solve", written(propped, tmp_path), "--forces", "--figures", tmp_path)
    assert result.exit_code == 0
    output = crank("solve", written(propped, tmp_path), "--forces").output
    assert "driving torque" in output
    assert "Reactions: none, as how redundant links (strut) share the load" in output
    drawn = {path.name for path in tmp_path.iterdir() if path.suffix != ".toml"}
    assert drawn == {"torque.svg", "torque.pdf", "reduced.svg", "reduced.pdf"}
