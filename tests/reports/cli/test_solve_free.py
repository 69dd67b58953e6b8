"""`crankcheck solve` and `view` of a scene that is let go: tables, files, figures, a page.
More of what it tells is in `test_told.py`."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from PIL import Image

from analytic.free.release import release
from models.files import load_scene
from tests.worlds.command_line import crank, flat, refused, told
from tests.worlds.let_go import EVERYTHING
from tests.worlds.without_pdf import without_pdf

SHORT = "solve fourbar-swing --duration 0.5"


def test_the_free_motion_is_told_with_its_energy_and_how_sure_it_is() -> None:
    output = told(f"{SHORT} --steps 4")
    said = flat(output)
    assert "mobility 1; driver crank, let go at rest at 0 deg, for 10 s; groups" in said
    assert re.search(r"the angle of crank is off by at most \d.\de-\d\d rad at 0.5 s\.", said)
    assert re.search(r"Sensitivity [\d.]+: what the start is changed by", said)
    start, end = (
        next(line.split() for line in output.splitlines() if line.startswith(head))
        for head in ("    0  ", "  0.5  ")
    )
    kinetic, potential, work = map(float, end[4:7])
    assert kinetic + potential == pytest.approx(float(start[5]), rel=1e-6)
    assert work == 0.0


def test_instants_on_the_way_are_told(tmp_path: Path) -> None:
    path = tmp_path / "everything.toml"
    path.write_text(EVERYTHING, encoding="utf-8")
    said = flat(told("solve --duration 0.3 --steps 2", path))
    assert re.search(r"What acts is not smooth at \d+ instants: 0.1, .*0.25.* s\.", said)


def test_a_file_has_the_motion_the_energies_and_the_sensitivity(tmp_path: Path) -> None:
    path = tmp_path / "swing.csv"
    told(SHORT, "-o", path)
    frame = pd.read_csv(path)
    assert len(frame) == 1001
    free = release(load_scene("fourbar-swing"), 0.5)
    time_s = np.linspace(0.0, 0.5, 1001)
    motion = free.at(time_s)
    for column, values in {
        "time_s": time_s,
        "rocker_theta_rad": motion.links["rocker"].theta,
        "C_y_m": motion.points["C"].position[:, 1],
        "kinetic_j": free.energy(time_s).kinetic,
        "sensitivity": free.sensitivity(time_s),
    }.items():
        assert np.array_equal(frame[column], values), column
    assert {"potential_j", "work_j", "error_rad"} <= set(frame)


def test_figures_and_a_page_are_written(tmp_path: Path) -> None:
    page, folder = tmp_path / "page.html", tmp_path / "figures"
    with without_pdf():
        told(SHORT, "--figures", folder, "-o", page)
    names = {each.name for each in folder.iterdir()}
    assert names == {f"{n}.{k}" for n in ("over-time", "energy", "phase") for k in ("svg", "pdf")}
    text = page.read_text(encoding="utf-8")
    assert "free motion over 0.5 s" in text
    assert text.count("data:image/svg+xml;base64,") == 3
    assert "Sensitivity" in text


def test_a_picture_shows_it_moving(tmp_path: Path) -> None:
    path = tmp_path / "pulse.png"
    assert "fourbar-pulse in free motion" in flat(told("view fourbar-pulse -o", path))
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
    result = crank("solve", path, "--duration", "0.3")
    refused(result, said)
    assert result.stderr.startswith("crankcheck: ")
