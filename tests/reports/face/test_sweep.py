"""`sweep` and `report` of the face: the store and the page of the commands."""

from __future__ import annotations

import shlex
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import crankcheck
from models.files import parse_scene
from reports.store.manifest import read_manifest
from tests.worlds.in_process import in_this_process


@pytest.fixture(scope="module")
def swept(tmp_path_factory: pytest.TempPathFactory) -> crankcheck.Sweep:
    """One scene of a file that is gone, and a shipped one, in two settings each."""
    folder = tmp_path_factory.mktemp("swept") / "my study"
    shipped = crankcheck.load_scene("fourbar-lecture-1")
    own = replace(
        shipped, name="own", driver=replace(shipped.driver, law=shipped.driver.law.turned(1.0))
    )
    with in_this_process():
        return crankcheck.sweep(
            [own, shipped],
            folder,
            engines="mujoco",
            settings={"mujoco.iterations": np.array([50, 100])},
            steps_per_turn=90,
            turns=1,
            timing=False,
            keep_trajectories=True,
            jobs=1,
        )


def test_its_frame_is_a_row_per_cell(swept: crankcheck.Sweep) -> None:
    frame = swept.frame()
    assert len(frame) == swept.cells == swept.done.ran == 4
    assert sorted(set(frame["scene"])) == ["fourbar-lecture-1", "own"]
    assert swept.verdict == "within"
    assert str(swept).startswith("4 cells: 4 run now, 0 were there; 0 timed now\nstored in ")
    assert "4 cells" in swept._repr_html_()


def test_a_scene_without_a_file_is_kept_as_its_text(swept: crankcheck.Sweep) -> None:
    manifest = read_manifest(swept.folder)
    own = parse_scene(manifest.scenes["own"], "own")
    assert own.links == crankcheck.load_scene("fourbar-lecture-1").links
    typed = manifest.runs[0]["command"]
    assert isinstance(typed, list)
    words = shlex.join(typed)
    assert words.startswith("crankcheck sweep -o '")
    assert words.endswith("--engine mujoco --steps-per-turn 90 --turns 1 --set "
                          "mujoco.iterations=50,100")  # fmt: skip


def test_kept_runs_are_logs_to_be_judged(swept: crankcheck.Sweep) -> None:
    frame = swept.frame()
    row = frame[frame["scene"] == "fourbar-lecture-1"].iloc[0]
    path = swept.folder / "trajectories" / f"{row['key']}.parquet"
    assert "C_gap_m" in pd.read_parquet(path).columns
    judged = crankcheck.judge("fourbar-lecture-1", path, step_s=row["dt_s"])
    assert judged.verdict == "within"
    worst = max(judged.errors.worst(name).pure for name in ("angle", "position"))  # type: ignore[union-attr]
    assert worst == pytest.approx(row["place_pure"], rel=1e-12)


def test_a_report_is_a_page_or_text(swept: crankcheck.Sweep, tmp_path: Path) -> None:
    page = crankcheck.report(swept, tmp_path / "page.html")
    assert page.read_text(encoding="utf-8").startswith("<!doctype html>")
    text = crankcheck.report(swept.folder, tmp_path / "text.md")
    assert text.read_text(encoding="utf-8").startswith("#")


@pytest.mark.parametrize("name", ["scenes", "engines", "profiles", "steps_per_turn"])
def test_an_empty_list_is_refused_and_not_taken_for_everything(name: str, tmp_path: Path) -> None:
    scene = {"scenes": "fourbar-lecture-1", "limit_s": 1e-6}
    with pytest.raises(crankcheck.CrankcheckError, match=f"{name}: found nothing in it"):
        crankcheck.sweep(**{**scene, "folder": tmp_path / "out", "jobs": -1, name: []})
    assert not list(tmp_path.iterdir())
