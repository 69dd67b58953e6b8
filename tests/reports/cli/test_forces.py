"""`--forces` of verify, sweep, stability and selftest from the command line."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest

from models.files import scene_texts
from reports.stability.matrix import FILE, Graded, Matrix, read_matrix, to_json
from reports.store.reader import read_store
from sim import registry
from tests.worlds.command_line import crank, crank_alone, flat, refused

SCENE = "fourbar-lecture-1"
ONCE = ["--jobs", "1", "--steps-per-turn", "180", "--turns", "1", "--profile", "tuned"]
FAST = [*ONCE, "--no-convergence"]


def test_verify_has_a_table_of_forces_of_its_own(tmp_path: Path) -> None:
    asked = crank("verify", SCENE, "--engine", "mujoco", *FAST, "--forces", "-o", str(tmp_path))
    plain = crank("verify", SCENE, "--engine", "mujoco", *FAST, "-o", str(tmp_path / "plain"))
    assert (asked.exit_code, plain.exit_code) == (0, 0), asked.output
    assert "forces, profile tuned (gated)" in flat(asked.output)
    assert "F largest reaction, M largest torque" in flat(asked.output)
    assert "forces" not in plain.output
    head = plain.output.splitlines()[:5]
    assert asked.output.splitlines()[:5] == head
    cells, bare = (pd.read_csv(f / "verify.csv") for f in (tmp_path, tmp_path / "plain"))
    assert list(bare) == [name for name in cells if name in set(bare)]
    assert cells["reaction_pure"][0] < 1e-4
    findings = json.loads((tmp_path / "verify.json").read_text())["cells"][0]["findings"]
    assert {"CC120", "CC123", "CC124"} <= {finding["rule"] for finding in findings}


def test_convergence_of_forces_is_told_with_its_floor() -> None:
    result = crank("verify", SCENE, "--engine", "mujoco", *ONCE, "--forces")
    assert "levels off floor" in flat(result.output) or "does not shrink floor" in flat(
        result.output
    )


def test_an_engine_without_forces_is_unsupported_where_it_is_named_and_a_note_else(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    deaf = replace(registry.engine("mujoco"), forces_of="nothing")
    monkeypatch.setattr("sim.mujoco.engine.ENGINE", deaf)
    named = crank("verify", SCENE, "--engine", "mujoco", *FAST, "--forces")
    assert named.exit_code == 2
    assert "mujoco reports no forces; run it without, or another engine" in flat(named.stderr)
    usual = crank("verify", SCENE, *FAST, "--forces")
    assert usual.exit_code == 0, usual.output
    assert "forces: mujoco reports none, and is run without" in flat(usual.stderr)


@pytest.mark.parametrize("verb", ["verify", "sweep"])
def test_a_scene_without_mass_is_refused(verb: str, tmp_path: Path) -> None:
    text = scene_texts([SCENE])[SCENE]
    text = text.replace("{ bar", "{ mass_kg = 0.0, inertia_kg_m2 = 0.0, bar")
    path = tmp_path / "light.toml"
    path.write_text(text)
    folder = [] if verb == "verify" else ["-o", str(tmp_path / "out")]
    result = crank(verb, path, "--engine", "mujoco", "--forces", *folder)
    refused(result, "no link or slider has a mass and nothing loads them")


def test_a_sweep_keeps_forces_beside_cells_without_and_reports_them(tmp_path: Path) -> None:
    folder = str(tmp_path / "out")
    common = ["--profile", "tuned", "--turns", "1", "--no-timing", "--jobs", "1", "-o", folder]
    some = ["sweep", SCENE, "--steps-per-turn", "90,180", *common]
    assert crank_alone(*some, "--engine", "mujoco", "--forces").exit_code == 0
    assert crank_alone(*some, "--engine", "pymunk").exit_code == 0
    cells = read_store(Path(folder)).cells
    known = cells.set_index("engine")["torque_pure"]
    assert known["mujoco"].between(1e-6, 1e-3).all()
    assert known["pymunk"].isna().all()
    again = crank_alone(*some, "--engine", "mujoco", "--forces")
    assert "0 run now" not in again.output or "2 were there" in again.output
    assert crank("report", folder, "-o", str(tmp_path / "page.html")).exit_code == 0
    assert "reactions in pins" in (tmp_path / "page.html").read_text()
    assert crank("diff", folder, folder).exit_code == 0


def test_stability_tells_what_forces_are_off_by_and_grades_as_before() -> None:
    told = ["stability", "heavy-rocker", "--at", "10", "--engine", "mujoco", "--profile", "tuned"]
    asked, plain = crank_alone(*told, "--forces"), crank_alone(*told)
    assert (asked.exit_code, plain.exit_code) == (0, 0)
    more = [line for line in asked.output.splitlines() if line not in plain.output.splitlines()]
    assert len(more) == 1
    assert "error of forces, over the largest: 4" in more[0]


def test_a_matrix_keeps_forces_where_they_are_known(tmp_path: Path) -> None:
    blank = Graded("case", "mujoco", "tuned", 1.0, "1", "ok", "")
    plain = Matrix({}, (), (blank,), ())
    known = Matrix({}, (), (replace(blank, force=1e-4), blank), ())
    assert "force" not in to_json(plain)
    (tmp_path / FILE).write_text(to_json(known))
    first, second = read_matrix(tmp_path).runs
    assert first.force == 1e-4
    assert math.isnan(second.force)


def test_selftest_plants_faults_of_forces_where_it_is_asked() -> None:
    result = crank("selftest", "--fault", "torque-off", "--engine", "mujoco", "--jobs", "1")
    assert result.exit_code == 0, result.output
    assert "1 of 1 fault caught by the named rule" in result.output
    assert "CC123" in result.output
