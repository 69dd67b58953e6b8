"""`--free` of verify and sweep from the command line: verdict, table, files, and every mistake."""

from __future__ import annotations

import json
from pathlib import Path

import pandas as pd
import pytest

from models.errors import CrankcheckError
from models.files import load_scene
from models.scene_text import scene_text
from reports.cli.checking import VerifyRequest
from reports.cli.commands.verify import plan
from reports.store.reader import read_store
from tests.worlds.command_line import crank, crank_alone, flat

SCENE = "fourbar-swing"
SHORT = ["--duration", "0.1", "--jobs", "1", "--profile", "tuned"]


def test_what_is_let_go_is_within_and_has_a_table_of_its_own(tmp_path: Path) -> None:
    result = crank("verify", SCENE, *SHORT, "-o", str(tmp_path))
    assert result.exit_code == 0, result.output
    text = flat(result.output)
    assert "free motion, profile tuned (gated)" in text
    assert "WITHIN TOLERANCE: all 2 cells (1 scene x 2 engines)" in text
    assert "dt 0.001 s over 0.1 s" in text
    cells = pd.read_csv(tmp_path / "verify.csv")
    assert list(cells["drive"]) == ["free", "free"]
    assert (cells["phase_pure"] <= cells["phase_limit_pure"]).all()
    assert list(cells["horizon_1e-1_s"]) == pytest.approx([0.1, 0.1])
    assert not {"drive_pure", "drive_error_rad", "reaction_pure"} & set(cells)
    content = json.loads((tmp_path / "verify.json").read_text())["cells"]
    found = {finding["rule"] for cell in content for finding in cell["findings"]}
    assert {"CC127", "CC128", "CC110", "CC115", "CC117"} <= found
    assert "CC102" not in found
    again = crank("verify", SCENE, *SHORT, "--baseline", str(tmp_path))
    assert again.exit_code == 0, again.output
    assert "NOT WORSE" in again.output


def test_a_limit_that_is_not_kept_ends_with_1() -> None:
    result = crank("verify", SCENE, *SHORT, "--engine", "pymunk", "--tol", "phase=1e-9")
    assert result.exit_code == 1
    assert "CC127 phase: driver crank:" in flat(result.output)
    assert "over the sensitivity" in flat(result.output)


def test_driven_scenes_are_let_go_with_free_and_stay_driven_without() -> None:
    both = plan(VerifyRequest(("fourbar-lecture-1", SCENE), engines=("pymunk",), turns=1.0))
    drives = {(cell.scene.name, cell.drive) for cell in both}
    assert drives == {("fourbar-lecture-1", "prescribed"), (SCENE, "free")}
    cells = plan(VerifyRequest(("fourbar-lecture-1",), engines=("pymunk",), free=True))
    assert {cell.drive for cell in cells} == {"free"}
    law = load_scene("fourbar-lecture-1").driver.law
    assert cells[0].dt_s == 1e-3
    assert abs(cells[0].steps * cells[0].dt_s - 10.0 * law.period_s) < 1e-3


def test_a_scene_without_a_mass_that_moves_is_refused_before_anything_runs(tmp_path: Path) -> None:
    text = scene_text(load_scene(SCENE))
    bare = "\n".join(
        "mass_kg = 0.0" if line.startswith("mass_kg") else line for line in text.splitlines()
    )
    path = tmp_path / "bare.toml"
    path.write_text(bare.replace("inertia_kg_m2", "inertia_kg_m2"))
    with pytest.raises(CrankcheckError):
        plan(VerifyRequest((str(path),)))


def test_a_sweep_of_what_is_let_go_is_kept_shown_and_compared(tmp_path: Path) -> None:
    store, page = tmp_path / "store", tmp_path / "page.html"
    options = ["--free", "--dt", "1e-3,5e-4", "--duration", "0.1", "--profile", "tuned"]
    swept = crank_alone("sweep", SCENE, "-o", str(store), *options, "--no-timing", "--jobs", "1")
    assert swept.exit_code == 0, swept.output
    cells = read_store(store).cells
    assert len(cells) == 4
    assert set(cells["drive"]) == {"free"}
    assert set(cells["dt_s"]) == {1e-3, 5e-4}
    assert cells["precision"].str.contains("1e-3|1e-1|fine|common").all()
    shown = crank("report", str(store), "-o", str(page))
    assert shown.exit_code == 0, shown.output
    assert "Let go" in page.read_text()
    assert crank("diff", str(store), str(store)).exit_code == 0
