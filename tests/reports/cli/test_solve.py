"""`crankcheck solve` of what is driven: tables, files, families. More of what it tells is in
`test_told.py`."""

import math
import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from rich.console import Console

from analytic.kinematics import solve
from analytic.structure.mobility import analyse
from models.files.reading import load_scene, shipped
from models.scene import Scene
from reports.describe.facts import facts
from reports.requests.solve import SolveRequest
from tests.worlds.command_line import crank, refused, told
from tests.worlds.tiers import few

PISTON = "slider-crank-by-piston"
FOURBAR = shipped()["fourbar-lecture-1"].read_text(encoding="utf-8")


def test_a_four_bar_driven_at_its_rocker_is_called_that(fourbar: Scene) -> None:
    def scene(driver: float, rocker: float) -> Scene:
        links = dict(fourbar.links)
        for name, tip, length in (("crank", "B", driver), ("rocker", "C", rocker)):
            bar = links[name]
            (held,) = (point for point in bar.points if point != tip)
            links[name] = replace(bar, points={held: (0.0, 0.0), tip: (length, 0.0)})
        return replace(fourbar, links=links)

    for lengths, said in (((0.2, 0.1), "crank-rocker driven at its rocker (s + l"),
                          ((0.1, 0.2), "crank-rocker (s + l")):  # fmt: skip
        assert facts(scene(*lengths), analyse(fourbar))[0].startswith(said)


SOME = ["fourbar-lecture-1", "slider-crank-offset", "shaper", "scotch-yoke", "tangent", "whitworth"]


@pytest.mark.parametrize("name", few(shipped(), SOME, "the other scenes are of the same joints"))
def test_every_shipped_scene_is_solved_and_drawn_as_a_table(name: str) -> None:
    said = told(f"solve {name}")
    assert "mobility 1" in said
    assert "nan" not in said.lower().split()
    assert max(len(line.rstrip()) for line in said.splitlines()) <= 100


READERS = {
    ".csv": pd.read_csv,
    ".parquet": pd.read_parquet,
    ".xlsx": lambda path: pd.read_excel(path, sheet_name="motion"),
}


@pytest.mark.parametrize("ending", READERS)
def test_a_motion_written_to_a_file_is_read_back_to_the_last_bit(
    tmp_path: Path, ending: str
) -> None:
    path = tmp_path / f"out{ending}"
    told("solve slider-crank-offset --turns 2 --steps-per-turn 40 -o", path)
    frame = READERS[ending](path)
    scene = load_scene("slider-crank-offset")
    motion = solve(scene, frame["time_s"].to_numpy())
    assert len(frame) == 81
    np.testing.assert_array_equal(frame["rod_omega_rad_s"], motion.links["rod"].omega)
    np.testing.assert_array_equal(frame["C_ax_m_s2"], motion.points["C"].acceleration[:, 0])
    np.testing.assert_array_equal(frame["C_slider_speed_m_s"], motion.sliders["C"].speed)
    assert frame["time_s"].iloc[-1] == pytest.approx(2 * scene.driver.law.period_s)
    if ending == ".xlsx":  # says where its numbers come from
        assert scene.source in pd.read_excel(path, sheet_name="source")["value"].tolist()


def test_a_workbook_holds_a_name_that_a_workbook_can_not_hold(
    tmp_path: Path, fourbar: Scene
) -> None:
    path = tmp_path / "out.xlsx"
    ringing = replace(fourbar, source="bell \x07")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("reports.requests.solve.load_scene", lambda _: ringing)
        SolveRequest(fourbar.name, output=path).run(Console(), Console())
    assert "bell \ufffd" in pd.read_excel(path, sheet_name="source")["value"].tolist()


@pytest.mark.parametrize(
    ("angle", "way", "sense"), [("0", (), 1.0), ("20", (), 1.0), ("20", ("--clockwise",), -1.0)]
)
def test_a_swinging_driver_is_taken_on_its_way_up_or_back(
    angle: str, way: Sequence[str], sense: float
) -> None:
    """It oscillates by 40 degrees at 10 rad/s, and is drawn back to its centre."""
    lever = links(told(f"solve tangent --at-deg {angle}", *way))["lever"]
    theta = math.radians(float(angle))
    speed = sense * 10.0 * math.sqrt(math.radians(40.0) ** 2 - theta**2)
    assert float(lever[3]) == pytest.approx(speed, rel=1e-7)
    assert float(lever[4]) == pytest.approx(-100.0 * theta, rel=1e-7, abs=0.0)


def links(output: str) -> dict[str, list[str]]:
    """The rows of the table of links, by name."""
    rows = (line.split() for line in output.split("link ")[-1].split("point")[0].splitlines())
    return {row[0]: row for row in rows if len(row) == 5 and row[0] != "x"}


def test_a_crank_may_be_asked_for_turning_clockwise() -> None:
    """Velocities are turned round, accelerations are not."""
    line = "solve fourbar-lecture-1 --at-deg 30"
    forth, back = links(told(line)), links(told(f"{line} --clockwise"))
    assert list(forth) == list(back) == ["crank", "coupler", "rocker"]
    for one, other in zip(forth.values(), back.values(), strict=True):
        assert float(other[3]) == -float(one[3])
        assert (other[2], other[4]) == (one[2], one[4])


def test_a_crank_of_steady_acceleration_has_the_speed_of_the_angle(tmp_path: Path) -> None:
    path = tmp_path / "faster.toml"
    law = 'law = "accelerating"\nspeed_rad_s = 10.0\nacceleration_rad_s2 = 5.0'
    path.write_text(FOURBAR.replace("speed_rad_s = 10.0", law), encoding="utf-8")
    output = told("solve --at-deg 180", path)
    assert "driver crank, 10 rad/s and 5 rad/s^2 from 90 deg" in output
    row = links(output)["crank"]
    assert float(row[3]) == pytest.approx(math.sqrt(100.0 + 2 * 5.0 * math.pi / 2), rel=1e-7)
    assert float(row[4]) == 5.0
    wrong = crank("solve", path, "--at-deg", "80")
    refused(wrong, "never comes there; it comes to the same driver angle at 440 deg")


def test_without_a_whole_cycle_there_is_no_stroke(tmp_path: Path) -> None:
    text = shipped()["fourbar-double-rocker"].read_text(encoding="utf-8")
    path = tmp_path / "turns.toml"
    path.write_text(re.sub(r"law = (.+\n)+", "speed_rad_s = 10.0\n", text), encoding="utf-8")
    output = told("solve --at-deg 40 --along C:30", path)
    assert "\nC along 30 deg: no stroke: the driver goes through no whole cycle, or" in output


def test_the_coriolis_component_is_shown_of_blocks_on_moving_guides() -> None:
    output = told("solve shaper --at-deg 30")
    lever = float(links(output)["lever"][3])
    sliders = output.split("Coriolis")[-1].splitlines()
    found = {row[0]: row for row in map(str.split, sliders) if len(row) == 5}
    assert float(found["F"][4]) == 0.0
    assert float(found["B"][4]) == pytest.approx(2.0 * lever * float(found["B"][2]), rel=1e-7)
    assert "Coriolis" not in told("solve slider-crank-central --at-deg 30")


def test_two_links_that_stand_still_are_solved_and_called_nothing(tmp_path: Path) -> None:
    path = tmp_path / "still.toml"
    path.write_text(FOURBAR.replace('bar = ["B", "C"]', 'bar = ["A", "C"]'), encoding="utf-8")
    output = told("solve --at-deg 90", path)
    assert "groups in solving order: RRR" in output
    assert "rocker (s + l" not in output


def test_positions_are_numbered_along_what_is_driven(tmp_path: Path) -> None:
    sheet = tmp_path / "sheet.svg"
    assert f"12 positions of {PISTON}" in told(f"positions {PISTON} -o", sheet)
    assert "locus-B" in sheet.read_text(encoding="utf-8")


def test_what_a_slider_drives_is_logged_in_newtons(tmp_path: Path) -> None:
    told(f"solve {PISTON} --forces -o", tmp_path / "log.csv")
    heads = (tmp_path / "log.csv").read_text(encoding="utf-8").partition("\n")[0].split(",")
    assert "drive_force_n" in heads
    assert "torque_n_m" not in heads


BEGINS = {".xlsx": b"PK", ".html": b"<!doctype html>", ".svg": b"<?xml", ".pdf": b"%PDF"}


@pytest.mark.parametrize("ending", BEGINS)
def test_the_ending_says_what_is_written_of_a_family(ending: str, tmp_path: Path) -> None:
    file = tmp_path / f"family{ending}"
    line = "solve slotted-lever --family R=0.1,0.12 --steps-per-turn 8 --turns 1.5 -o"
    assert told(line, file).strip() == f"{file}: 2 members of slotted-lever, 13 rows"
    assert file.read_bytes().startswith(BEGINS[ending])
