"""`crankcheck solve` and `view` of a scene that is free, or has elastic links: tables, files,
figures, a page. More of what they tell is in `test_told.py`."""

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from analytic.elastic.discretisation import REFERENCE
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.free.release import release
from analytic.kinematics import solve
from models.files.reading import load_scene
from tests.worlds.command_line import crank, flat, refused, told
from tests.worlds.let_go import EVERYTHING
from tests.worlds.tiers import slow
from tests.worlds.without_pdf import without_pdf

SWING = "solve fourbar-swing --duration 0.5"


def test_instants_on_the_way_are_told(tmp_path: Path) -> None:
    path = tmp_path / "everything.toml"
    path.write_text(EVERYTHING, encoding="utf-8")
    said = flat(told("solve --duration 0.3 --steps 2", path))
    assert re.search(r"Loads are not smooth at \d+ instants: 0.1, .*0.25.* s\.", said)


def test_a_file_has_the_motion_the_energies_and_the_sensitivity(tmp_path: Path) -> None:
    path = tmp_path / "swing.csv"
    told(SWING, "-o", path)
    frame = pd.read_csv(path)
    assert len(frame) == 1001
    free, time_s = release(load_scene("fourbar-swing"), 0.5), np.linspace(0.0, 0.5, 1001)
    assert np.array_equal(frame["time_s"], time_s)
    assert np.array_equal(frame["rocker_theta_rad"], free.at(time_s).links["rocker"].theta)
    assert np.array_equal(frame["kinetic_j"], free.energy(time_s).kinetic)
    assert np.array_equal(frame["sensitivity"], free.sensitivity(time_s))
    assert {"C_y_m", "potential_j", "work_j", "error_rad"} <= set(frame)


@slow("a second; figures are written of elastic links below, pages in tests/reports/page")
def test_figures_and_a_page_are_written(tmp_path: Path) -> None:
    page, folder = tmp_path / "page.html", tmp_path / "figures"
    with without_pdf():
        told(f"{SWING} --forces", "--figures", folder, "-o", page)
    names, drawn = {each.name for each in folder.iterdir()}, "over-time energy phase reactions"
    assert names == {f"{n}.{k}" for n in drawn.split() for k in ("svg", "pdf")}
    text = page.read_text(encoding="utf-8")
    assert "free motion over 0.5 s" in text
    assert text.count("data:image/svg+xml;base64,") == 4
    assert "Over the motion, closely sampled" in text
    assert "driving torque" not in text
    assert "Sensitivity" in text


@slow("a second; pictures and films are drawn in test_export.py, pages in tests/reports/page")
def test_a_picture_is_told_of(tmp_path: Path) -> None:
    said = told("view fourbar-pulse -o", tmp_path / "pulse.png")
    assert "fourbar-pulse in free motion" in flat(said)


def test_what_shows_on_the_way_is_one_message(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    old, new = "at_rad_s = [-40.0, 60.0]", "at_rad_s = [-1.0, 2.5]"
    path.write_text(EVERYTHING.replace(old, new), encoding="utf-8")
    result = crank("solve", path, "--duration", "0.3")
    refused(result, "loads.motor: over the omega")
    assert result.stderr.startswith("crankcheck: ")


NAME = "fourbar-elastic"
BENDS = f"solve {NAME}"


@slow("half a second; the linear theory is asked for in tests/reports/requests")
def test_the_linear_theory_says_what_it_leaves_out() -> None:
    """ELASTIC: 1.28 % of the largest deflection at a frequency ratio of 10.5."""
    said = flat(told(f"{BENDS} --linear --modes 1 --steps-per-turn 2"))
    assert "by 1 sine across each, without the shortening of bent links (linear" in said
    (percent,) = re.findall(r"changes deflections by (\S+) % of the largest", said)
    assert float(percent) == pytest.approx(1.28, abs=0.05)


def test_a_file_has_both_motions_to_the_last_bit_and_figures_are_written(tmp_path: Path) -> None:
    scene, path = load_scene(NAME), tmp_path / "out.csv"
    motion = DrivenElasticMotion(
        scene, scene.driver.law.period_s, REFERENCE, "periodic", stiffened=True
    )
    folder = tmp_path / "figures"
    with without_pdf():
        told(f"{BENDS} --steps-per-turn 9 --forces --figures", folder, "-o", path)
    frame = pd.read_csv(path)
    time_s = frame["time_s"].to_numpy()
    whole, rigid = motion.at(time_s), solve(motion.scene, time_s, bound=False)
    coupler, links = whole.elastic["coupler"], whole.links
    for column, values, atol in (
        ("coupler_deflection_m", coupler.middle, 1e-15),
        ("coupler_extension_m", coupler.extension, 1e-15),
        ("rocker_theta_rad", links["rocker"].theta, 1e-13),
        ("rocker_theta_rigid_rad", rigid.links["rocker"].theta, 0.0),
        ("torque_n_m", whole.forces.torque, 1e-11),
    ):
        np.testing.assert_allclose(frame[column], values, rtol=0, atol=atol, err_msg=column)
    assert "torque_rigid_n_m" in frame
    names = {each.name for each in folder.iterdir()}
    every = ("deflection", "extension", "torque", "angles", "positions")
    assert names == {f"{n}.{k}" for n in every for k in ("svg", "pdf")}
    assert "magnified 50 times" in (folder / "positions.svg").read_text(encoding="utf-8")


PULSE = "solve fourbar-elastic-pulse --modes 1 --duration 0.02"
"""The begin of the pulse, on one sine."""


def test_what_is_let_go_keeps_its_energy(tmp_path: Path) -> None:
    path = tmp_path / "out.csv"
    told(PULSE, "-o", path)
    frame = pd.read_csv(path)
    assert len(frame) == 1001
    energy = frame["kinetic_j"] + frame["potential_j"] - frame["work_j"]
    assert np.max(np.abs(energy - energy[0])) < 1e-9 * frame["kinetic_j"].max()
    apart = frame["crank_theta_rad"] - frame["crank_theta_rigid_rad"]
    assert 0.0 < np.max(np.abs(apart)) < 1e-2
    said = flat(told(PULSE.replace("0.02", "0.01"), "--steps", 2))
    assert "driver crank, released at rest at 90 deg, for 5 s" in said
    assert "Uncertainty, from the next finer description: deflections " in said
