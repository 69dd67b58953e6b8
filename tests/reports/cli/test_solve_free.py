"""`crankcheck solve` and `view` of a scene that is let go: tables, files, figures, a page."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from PIL import Image

from analytic.free.release import release
from models.files import load_scene
from tests.worlds.command_line import crank, flat, refused
from tests.worlds.let_go import EVERYTHING
from tests.worlds.without_pdf import without_pdf

SHORT = ("solve", "fourbar-swing", "--duration", "0.5")


def test_the_free_motion_is_told_with_its_energy_and_how_sure_it_is() -> None:
    result = crank(*SHORT, "--steps", "4")
    assert result.exit_code == 0
    said = flat(result.output)
    assert "mobility 1; driver crank, let go at rest at 0 deg, for 10 s; groups" in said
    assert re.search(r"the angle of crank is off by at most \d.\de-\d\d rad at 0.5 s\.", said)
    assert re.search(r"Sensitivity [\d.]+: what the start is changed by", said)
    start, end = (
        next(line.split() for line in result.output.splitlines() if line.startswith(head))
        for head in ("    0  ", "  0.5  ")
    )
    kinetic, potential, work = map(float, end[4:7])
    assert kinetic + potential == pytest.approx(float(start[5]), rel=1e-6)
    assert work == 0.0


def test_limits_and_instants_on_the_way_are_told(tmp_path: Path) -> None:
    result = crank("solve", "fourbar-double-rocker-swing", "--duration", "0.5", "--steps", "2")
    said = flat(result.output)
    assert "Limits in which driver turns back: -92.866 deg at 0.415855 s (C)." in said
    path = tmp_path / "everything.toml"
    path.write_text(EVERYTHING, encoding="utf-8")
    said = " ".join(crank("solve", str(path), "--duration", "0.3", "--steps", "2").output.split())
    assert re.search(r"What acts is not smooth at \d+ instants: 0.1, .*0.25.* s\.", said)


def test_a_file_has_the_motion_the_energies_and_the_sensitivity(tmp_path: Path) -> None:
    path = tmp_path / "swing.csv"
    assert crank(*SHORT, "-o", str(path)).exit_code == 0
    frame = pd.read_csv(path)
    assert len(frame) == 1001
    free = release(load_scene("fourbar-swing"), 0.5)
    time_s = np.linspace(0.0, 0.5, 1001)
    assert np.array_equal(frame["time_s"], time_s)
    motion, energy = free.at(time_s), free.energy(time_s)
    assert np.array_equal(frame["rocker_theta_rad"], motion.links["rocker"].theta)
    assert np.array_equal(frame["C_y_m"], motion.points["C"].position[:, 1])
    assert np.array_equal(frame["kinetic_j"], energy.kinetic)
    assert np.array_equal(frame["sensitivity"], free.sensitivity(time_s))
    assert {"potential_j", "work_j", "error_rad"} <= set(frame)


def test_figures_and_a_page_are_written(tmp_path: Path) -> None:
    page, folder = tmp_path / "page.html", tmp_path / "figures"
    with without_pdf():
        result = crank(*SHORT, "--figures", folder, "-o", page)
    assert result.exit_code == 0
    names = {each.name for each in folder.iterdir()}
    assert names == {f"{n}.{k}" for n in ("over-time", "energy", "phase") for k in ("svg", "pdf")}
    text = page.read_text(encoding="utf-8")
    assert "free motion over 0.5 s" in text
    assert text.count("data:image/svg+xml;base64,") == 3
    assert "Sensitivity" in text


def test_a_picture_shows_it_moving(tmp_path: Path) -> None:
    path = tmp_path / "pulse.png"
    result = crank("view", "fourbar-pulse", "-o", str(path))
    assert result.exit_code == 0
    assert "fourbar-pulse in free motion" in flat(result.output)
    with Image.open(path) as picture:
        assert picture.size[0] > 1000


SHORT_OF = {
    "motor": ("at_rad_s = [-40.0, 60.0]", "at_rad_s = [-1.0, 2.5]", "loads.motor: over the omega"),
    "start": ("rates_rad_s = { crank = 2.0 }", "rates_rad_s = { rod = 2.0 }", "rod"),
}


@pytest.mark.parametrize("fault", SHORT_OF)
def test_what_shows_on_the_way_is_one_message(fault: str, tmp_path: Path) -> None:
    old, new, said = SHORT_OF[fault]
    assert old in EVERYTHING
    path = tmp_path / "scene.toml"
    path.write_text(EVERYTHING.replace(old, new), encoding="utf-8")
    result = crank("solve", str(path), "--duration", "0.3")
    refused(result, said)
    assert result.stderr.startswith("crankcheck: ")


def test_of_several_freedoms_the_mobility_is_told() -> None:
    result = crank("solve", "double-pendulum", "--duration", "0.1", "--steps", "2")
    assert result.exit_code == 0
    said = flat(result.output)
    assert "mobility 2; driver upper, let go at rest at -50 deg" in said
    assert "every link's angle is off by at most" in said
