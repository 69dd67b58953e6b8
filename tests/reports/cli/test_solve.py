"""`crankcheck solve` of what is driven: tables, files, families; with `--forces` notes and figures,
and what friction takes. More of what it tells is in `test_told.py`."""

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import crankcheck
from analytic.forces.kinetostatics import forces
from analytic.kinematics import solve
from analytic.structure.mobility import analyse
from models.files.assemble import scene_text
from models.files.reading import load_scene, shipped
from models.scene import Scene
from models.scene.loads import CoulombFriction
from reports.describe.facts import facts
from tests.analytic.dyads.test_redundant import parallelogram, with_strut
from tests.worlds.command_line import crank, flat, refused, told
from tests.worlds.tiers import slowly
from tests.worlds.without_pdf import without_pdf


def test_a_four_bar_driven_at_its_rocker_is_called_that(fourbar: Scene) -> None:
    links = dict(fourbar.links)
    for name, held, tip, length in (("crank", "A", "B", 0.2), ("rocker", "D", "C", 0.1)):
        links[name] = replace(links[name], points={held: (0.0, 0.0), tip: (length, 0.0)})
    (said, *_) = facts(replace(fourbar, links=links), analyse(fourbar))
    assert said.startswith("crank-rocker driven at its rocker (s + l")


def test_a_motion_written_to_a_file_is_read_back_to_the_last_bit(tmp_path: Path) -> None:
    path = tmp_path / "out.xlsx"
    told("solve slider-crank-offset --turns 2 --steps-per-turn 40 -o", path)
    frame = pd.read_excel(path, sheet_name="motion")
    scene = load_scene("slider-crank-offset")
    motion = solve(scene, frame["time_s"].to_numpy())
    assert len(frame) == 81
    np.testing.assert_array_equal(frame["rod_omega_rad_s"], motion.links["rod"].omega)
    np.testing.assert_array_equal(frame["C_ax_m_s2"], motion.points["C"].acceleration[:, 0])
    np.testing.assert_array_equal(frame["C_slider_speed_m_s"], motion.sliders["C"].speed)
    assert frame["time_s"].iloc[-1] == pytest.approx(2 * scene.driver.law.period_s)
    assert scene.source in pd.read_excel(path, sheet_name="source")["value"].tolist()


def test_a_crank_of_steady_acceleration_has_the_speed_of_the_angle(tmp_path: Path) -> None:
    path = tmp_path / "faster.toml"
    law = 'law = "accelerating"\nspeed_rad_s = 10.0\nacceleration_rad_s2 = 5.0'
    text = shipped()["fourbar-lecture-1"].read_text(encoding="utf-8")
    path.write_text(text.replace("speed_rad_s = 10.0", law), encoding="utf-8")
    output = told("solve --at-deg 180", path)
    assert "driver crank, 10 rad/s and 5 rad/s^2 from 90 deg" in output
    speed = math.sqrt(100.0 + 2 * 5.0 * math.pi / 2)
    assert f"crank 180.00000 3.1415927 {speed:.8g} 5.0000000" in flat(output)
    wrong = crank("solve", path, "--at-deg", "80")
    refused(wrong, "never gets there; it reaches the same driver angle at 440 deg")


def test_without_a_whole_cycle_there_is_no_stroke(tmp_path: Path) -> None:
    text = shipped()["fourbar-double-rocker"].read_text(encoding="utf-8")
    path = tmp_path / "turns.toml"
    path.write_text(re.sub(r"law = (.+\n)+", "speed_rad_s = 10.0\n", text), encoding="utf-8")
    output = told("solve --at-deg 40 --along C:30", path)
    assert "\nC along 30 deg: no stroke: the driver goes through no whole cycle, or" in output


def test_what_a_slider_drives_is_numbered_along_it_and_logged_in_newtons(tmp_path: Path) -> None:
    name, sheet = "slider-crank-by-piston", tmp_path / "sheet.svg"
    assert f"12 positions of {name}" in told(f"positions {name} -o", sheet)
    assert "locus-B" in sheet.read_text(encoding="utf-8")
    told(f"solve {name} --forces -o", tmp_path / "log.csv")
    heads = (tmp_path / "log.csv").read_text(encoding="utf-8").partition("\n")[0].split(",")
    assert "drive_force_n" in heads
    assert "torque_n_m" not in heads


@pytest.mark.parametrize(
    ("ending", "begins"),
    [
        (".xlsx", b"PK"),
        (".html", b"<!doctype html>"),
        (".svg", b"<?xml"),
        slowly(".pdf", b"%PDF", reason="half a second: drawn as the one before"),
    ],
)
def test_an_ending_says_how_a_family_is_written(ending: str, begins: bytes, tmp_path: Path) -> None:
    file = tmp_path / f"family{ending}"
    line = "solve slotted-lever --family R=0.1,0.12 --steps-per-turn 8 --turns 1.5 -o"
    assert told(line, file).strip() == f"{file}: 2 members of slotted-lever, 13 rows"
    assert file.read_bytes().startswith(begins)


def written(scene: Scene, folder: Path) -> Path:
    path = folder / f"{scene.name}.toml"
    path.write_text(scene_text(scene), encoding="utf-8")
    return path


def row(output: str, start: str) -> list[float]:
    """The numbers of a row, dashes left out."""
    (words,) = re.findall(rf"^{start} +([-\d. ]+)$", output, flags=re.MULTILINE)
    return [float(each) for each in words.split() if each != "-"]


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
    assert "Two equilibria here, as the mechanism may jam: these forces are those of less" in said
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
