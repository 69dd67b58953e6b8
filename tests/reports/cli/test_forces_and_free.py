"""`--forces` and `--free` of verify, sweep, stability and selftest from the command line."""

import json
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest

from models.files.reading import load_scene
from reports.requests.verify import VerifyRequest, plan
from reports.store.reader import read_store
from sim import registry
from tests.worlds.command_line import crank, crank_alone, flat, refused, told

SCENE, SWING = "fourbar-lecture-1", "fourbar-swing"
ONCE = f"verify {SCENE} --jobs 1 --steps-per-turn 180 --turns 1 --profile tuned"
MUJOCO = f"{ONCE} --no-convergence --engine mujoco"
FREE = f"verify {SWING} --duration 0.1 --jobs 1 --profile tuned"


def swept(line: str, store: Path) -> str:
    result = crank_alone("sweep", *line.split(), "--no-timing", "--jobs", "1", "-o", store)
    assert result.exit_code == 0, result.output
    return result.output


def test_verify_has_a_table_of_forces_of_its_own(tmp_path: Path) -> None:
    asked = told(f"{MUJOCO} --forces -o", tmp_path)
    plain = told(f"{MUJOCO} -o", tmp_path / "plain")
    assert "forces, profile tuned (gated)" in flat(asked)
    assert "F largest reaction, M largest torque" in flat(asked)
    assert "forces" not in plain
    assert asked.splitlines()[:5] == plain.splitlines()[:5]
    cells, bare = (pd.read_csv(f / "verify.csv") for f in (tmp_path, tmp_path / "plain"))
    assert list(bare) == [name for name in cells if name in set(bare)]
    assert cells["reaction_pure"][0] < 1e-4
    findings = json.loads((tmp_path / "verify.json").read_text())["cells"][0]["findings"]
    assert {"CC120", "CC123", "CC124"} <= {finding["rule"] for finding in findings}


def test_an_engine_without_forces_fails_if_named_or_notes(monkeypatch: pytest.MonkeyPatch) -> None:
    deaf = replace(registry.engine("mujoco"), forces_of="nothing")
    monkeypatch.setattr("sim.mujoco.engine.ENGINE", deaf)
    lines = (f"{MUJOCO} --forces", f"{ONCE} --no-convergence --forces")
    named, usual = (crank(*line.split()) for line in lines)
    refused(named, "mujoco reports no forces; run it without, or another engine")
    assert usual.exit_code == 0, usual.output
    assert "forces: mujoco reports none, and runs without" in flat(usual.stderr)


def test_a_sweep_keeps_forces_beside_cells_without_and_reports_them(tmp_path: Path) -> None:
    some = f"{SCENE} --steps-per-turn 90,180 --profile tuned --turns 1 --engine"
    swept(f"{some} mujoco --forces", tmp_path)
    swept(f"{some} pymunk", tmp_path)
    told("report", tmp_path, "-o", tmp_path / "page.html")
    told("diff", tmp_path, tmp_path)
    known = read_store(tmp_path).cells.set_index("engine")["torque_pure"]
    assert known["mujoco"].between(1e-6, 1e-3).all()
    assert known["pymunk"].isna().all()
    assert "reactions in pins" in (tmp_path / "page.html").read_text()
    assert "2 were there" in swept(f"{some} mujoco --forces", tmp_path)


def test_stability_tells_what_forces_are_off_by_and_grades_as_before() -> None:
    options = ("--at", "10", "--engine", "mujoco", "--profile", "tuned")
    asked, plain = (crank_alone("stability", "heavy-rocker", *options, *more)
                    for more in (["--forces"], []))  # fmt: skip
    assert (asked.exit_code, plain.exit_code) == (0, 0)
    more = [line for line in asked.output.splitlines() if line not in plain.output.splitlines()]
    assert len(more) == 1
    assert "error of forces, over the largest: 4" in more[0]


def test_what_is_let_go_is_within_and_has_a_table_of_its_own(tmp_path: Path) -> None:
    text = flat(told(f"{FREE} -o", tmp_path))
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
    assert "NOT WORSE" in told(f"{FREE} --baseline", tmp_path)


def test_driven_scenes_are_let_go_with_free_and_stay_driven_without() -> None:
    both = plan(VerifyRequest((SCENE, SWING), engines=("pymunk",), turns=1.0))
    drives = {(cell.scene.name, cell.drive) for cell in both}
    assert drives == {(SCENE, "prescribed"), (SWING, "free")}
    cells = plan(VerifyRequest((SCENE,), engines=("pymunk",), free=True))
    assert {cell.drive for cell in cells} == {"free"}
    assert cells[0].dt_s == 1e-3
    period_s = load_scene(SCENE).driver.law.period_s
    assert abs(cells[0].steps * cells[0].dt_s - 10.0 * period_s) < 1e-3
