"""`crankcheck solve --forces`: tables, files, notes and figures; what friction takes, and where it
locks. More of what it tells is in `test_told.py`."""

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import crankcheck
from analytic.forces.kinetostatics import forces
from analytic.kinematics import solve_driven
from models.files.assemble import scene_text
from models.files.reading import load_scene, shipped
from models.scene import Scene
from models.scene.loads import CoulombFriction
from tests.analytic.dyads.test_redundant import parallelogram, with_strut
from tests.worlds.command_line import crank, flat, refused, told
from tests.worlds.without_pdf import without_pdf


def written(scene: Scene, folder: Path) -> Path:
    path = folder / f"{scene.name}.toml"
    path.write_text(scene_text(scene), encoding="utf-8")
    return path


def row(output: str, start: str) -> list[float]:
    """The numbers of a row, dashes left out."""
    (words,) = re.findall(rf"^{start} +([-\d. ]+)$", output, flags=re.MULTILINE)
    return [float(each) for each in words.split() if each != "-"]


def test_an_angle_shows_what_newton_has_for_the_block() -> None:
    """m a of the block along its line is the rod's force, and the guide takes the rest."""
    scene = load_scene("slider-crank-offset")
    motion = solve_driven(scene, np.radians([90.0]), np.array([10.0]), np.array([0.0]))
    output = told(f"solve {scene.name} --at-deg 90 --forces")
    x, y, size, direction = row(output, "C block C +rod")
    pull = scene.sliders["C"].mass_kg * motion.sliders["C"].acceleration[0]
    assert x == pytest.approx(pull, rel=1e-6)
    assert size == pytest.approx(np.hypot(x, y), rel=1e-6)
    assert direction == pytest.approx(np.degrees(np.arctan2(y, x)) % 360.0, rel=1e-6)
    assert row(output, "C block +ground")[0] == pytest.approx(-y, rel=1e-6)
    ((torque, power),) = re.findall(r"^crank +(-?[\d.]+) +(-?[\d.]+) *$", output, re.MULTILINE)
    assert float(power) == pytest.approx(10.0 * float(torque), rel=1e-6)


@pytest.mark.parametrize("name", ["shaper", "tangent", "sixbar-watt"])
def test_forces_over_a_turn_fit_the_page_and_tell_the_largest(name: str) -> None:
    lines = told(f"solve {name} --forces").splitlines()
    assert max(len(line.rstrip()) for line in lines) <= 100
    scene = load_scene(name)
    found = forces(scene, np.linspace(0.0, scene.driver.law.period_s, 721))
    largest = found.torque[np.argmax(np.abs(found.torque))]
    (told_of,) = (line.split() for line in lines if line.startswith("driving torque"))
    assert abs(float(told_of[2])) == pytest.approx(abs(largest), rel=1e-5)
    heads = [f"{point} on {list(bodies)[1]}" for point, bodies in found.pins.items()]
    heads += [f"slider {slider}, normal" for slider in found.sliders]
    assert [head for head in heads if not any(head in line for line in lines)] == []


def test_a_file_has_every_force_to_the_last_bit(tmp_path: Path) -> None:
    path, without = tmp_path / "out.csv", tmp_path / "without.csv"
    told("solve shaper --forces -o", path)
    frame = pd.read_csv(path)
    found = forces(load_scene("shaper"), frame["time_s"].to_numpy())
    rod = found.pins["E"]["rod"]
    np.testing.assert_array_equal(frame["torque_n_m"], found.torque)
    np.testing.assert_array_equal(frame[["E_rod_fx_n", "E_rod_fy_n"]], rod)
    np.testing.assert_array_equal(frame["E_rod_f_n"], np.hypot(*rod.T))
    np.testing.assert_array_equal(frame["F_slider_normal_n"], found.sliders["F"].normal)
    np.testing.assert_array_equal(frame["B_slider_moment_n_m"], found.sliders["B"].moment)
    told("solve shaper -o", without)
    plain = pd.read_csv(without)
    assert list(plain) == list(frame)[: len(plain.columns)]  # what has no forces is as it was


def test_couples_that_are_0_in_a_dead_centre_are_as_certain_as_the_forces() -> None:
    """Torque and moments are 0 there, and what rounding leaves is little at the links' arms."""
    output = flat(told("solve slider-crank-central --at-deg 0 --forces"))
    assert re.search(r"Forces certain to \S+e-1\d N, \S+e-1\d N m\.", output)
    assert "dead point" not in output


def test_dead_points_of_a_turn_are_left_out_and_told(tmp_path: Path) -> None:
    scene = written(replace(parallelogram(1), name="flat"), tmp_path)
    output = flat(told("solve --forces", scene))
    assert "Dead point, crank at 0 deg and 180 deg: the driving torque and the" in output


def test_redundant_links_leave_the_torque_and_say_why(tmp_path: Path) -> None:
    propped = written(replace(with_strut(parallelogram(1), "B0", "B1"), name="propped"), tmp_path)
    with without_pdf():
        told("solve --forces", propped, "--figures", tmp_path)
    output = told("solve --forces", propped)
    assert "driving torque" in output
    assert "Reactions: none, as how redundant links (strut) share the load" in output
    drawn = {path.name for path in tmp_path.iterdir() if path.suffix != ".toml"}
    assert drawn == {"torque.svg", "torque.pdf", "reduced.svg", "reduced.pdf"}


LOCKING = "slider-crank-self-locking"


def test_an_angle_tells_what_friction_takes_of_the_power() -> None:
    output = told(f"solve {LOCKING} --at-deg 60 --forces")
    sliders, powers = output.index("slider, force on"), output.index("power of")
    drive, taken, efficiency = row(output[powers:], "crank")
    force, watts = row(output, "piston block ground")[-2:]
    normal, *_ = row(output[sliders:powers], "piston block +ground")
    assert abs(force) == pytest.approx(0.3 * abs(normal), rel=1e-7)
    assert watts == taken < 0.0
    assert efficiency == pytest.approx(1.0 + taken / drive, rel=1e-6)
    locks = "from 80.5961 to 99.4039 deg and from 260.596 to 279.404 deg: there no finite"
    assert locks in flat(output)


def test_where_it_may_jam_the_numbers_stay_without_a_bound(tmp_path: Path) -> None:
    """The scene that locks itself, with loads that help."""
    scene = load_scene(LOCKING)
    turned = {
        n: replace(k, direction_rad=k.direction_rad + math.pi) for n, k in scene.loads.items()
    }
    helped = written(replace(scene, name="helped", loads=turned), tmp_path)
    output = told("solve --at-deg 90 --forces", helped)
    assert abs(row(output, "piston block ground")[-2]) > 100.0
    said = flat(output)
    assert "Two equilibria here, as the mechanism may jam: these forces, those of less" in said
    assert "It may jam with crank from 80.5961 to 99.4039 deg and from 260.596" in said
    assert "no useful work is done in it, so it has no efficiency." in said


def test_a_cycle_has_an_efficiency_where_it_has_friction(tmp_path: Path) -> None:
    rubbing = {"piston": CoulombFriction("piston", 0.1), "B": CoulombFriction("B", 0.1, 0.02)}
    scene = replace(load_scene(LOCKING), name="rubbing", friction=rubbing)
    path, file = written(scene, tmp_path), tmp_path / "out.csv"
    solution = crankcheck.solve(path, forces=True)
    cycle = solution.efficiency
    assert 0.0 < cycle.cycle < 1.0
    output = flat(told("solve --forces", path))
    assert f"Friction takes {cycle.wasted:.6g} J in a cycle; {cycle.useful:.6g} J of the" in output
    assert f"efficiency {cycle.cycle:.6g}." in output
    told("solve --forces", path, "-o", file)
    frame, friction = pd.read_csv(file), solution.forces.friction
    np.testing.assert_array_equal(frame["piston_slider_friction_n"], friction["piston"])
    np.testing.assert_array_equal(frame["B_friction_n_m"], friction["B"])
    assert crankcheck.solve("shaper").efficiency is None


def test_parts_of_a_motion_are_shown_without_its_power() -> None:
    few = str(crankcheck.solve(LOCKING, [0.01], links="rod", sliders=(), forces=True))
    assert "power of" not in few
    assert "piston block" in few


NEGATIVE = "friction.piston.mu: found -0.1; use a number of at least 0"
LOCKED = "crank at 90 deg | locks itself: friction in piston grows"


@pytest.mark.parametrize(
    ("line", "friction", "words"),
    [
        ("solve FILE --forces", "mu = -0.1", NEGATIVE),
        ("verify FILE --forces", "mu = -0.1", NEGATIVE),
        ("solve FILE --forces --at-deg 90", "mu = 0.3", LOCKED),
    ],
)
def test_a_fault_of_friction_ends_with_2_and_one_message(
    line: str, friction: str, words: str, tmp_path: Path
) -> None:
    text = shipped("forces")[LOCKING].read_text(encoding="utf-8").replace("mu = 0.3", friction)
    (tmp_path / "faulty.toml").write_text(text, encoding="utf-8")
    result = crank(*line.replace("FILE", str(tmp_path / "faulty.toml")).split())
    refused(result, *words.split(" | "))
    assert result.stdout == ""
    assert result.stderr.count("crankcheck:") == 1
