"""A quantity more is one entry: it is compared, judged and shown, and nothing else changes."""

import json
import math
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from models.files.reading import load_scene
from reports.judge.cell import check
from reports.judge.rows import cell_frame, error_frame
from tests.worlds.turns import of_turns

ROOT = Path(__file__).parents[3]
Told = dict[str, Any]


@pytest.fixture(scope="module")
def told() -> Told:
    """What came of some cells with the quantity of `tests.worlds.one_more_quantity`: an engine that
    reports it, one that does not, a scene that has none of it, and a limit that is too narrow."""
    program = [sys.executable, "-m", "tests.worlds.one_more_quantity"]
    done = subprocess.run(program, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    found: Told = json.loads(done.stdout)
    return found


def test_it_is_compared_with_its_unit_and_scale_at_the_start_and_after(told: Told) -> None:
    rows = [row for row in told["errors"] if row["quantity"] == "pull"]
    scene = load_scene("fourbar-lecture-1")
    newton = 2.0 * scene.longest_m * scene.driver.law.peak_speed_rad_s**2
    assert {(row["scene"], row["engine"]) for row in rows} == {("fourbar-lecture-1", "mujoco")}
    assert [row["kind"] for row in rows[:2]] == ["start", "total"]
    assert {(row["unit"], row["body_kind"], row["body"]) for row in rows} == {("N", "point", "C")}
    assert all(row["maximum_pure"] == row["maximum"] / newton for row in rows)
    assert rows[1]["maximum"] > 0.0


def test_its_rule_judges_it_and_fails_where_its_limit_is_too_narrow(told: Told) -> None:
    own = [[f for f in one if f["rule"] == "CC901"] for one in told["findings"]]
    levels = [[finding["level"] for finding in each] for each in own]
    assert levels == [["pass"], [], [], [], ["fail"]]
    assert own[-1][0]["text"].endswith("limit 1e-09 G (--tol)")
    assert own[-1][0]["cure"].startswith("Shorten the step.")
    order = [finding["rule"] for finding in told["findings"][0]]
    assert order[order.index("CC901") - 1 : order.index("CC901") + 2] == ["CC114", "CC901", "CC109"]


def test_it_has_its_columns_in_frames_store_and_tables_if_it_is_reported(told: Told) -> None:
    (first, silent), (known, unknown) = told["cells"][:2], told["not_reported"][:2]
    assert "pull of point C" in unknown
    assert not any("pull" in text for text in known)
    assert first["pull_pure"] < first["pull_limit_pure"]
    assert first["pull_error_N"] > 0.0
    assert math.isnan(silent["pull_error_N"])
    assert {told["types"][f"pull_{end}"] for end in ("pure", "limit_pure", "error_N")} == {"double"}
    heads = next(line for line in told["table"].splitlines() if "veloc." in line)
    assert heads.split()[3:6] == ["veloc.", "accel.", "pull"]
    assert "CC901 pull: point C: " in told["table"]
    assert told["page"]["pull_pure"] == ["pull at C", "G"]
    assert told["tune"]["pull_pure"] == "pull / G"
    assert "pull" in told["diff"]
    followed, heads_of_history = told["history"]
    assert followed == {"unit": "of G", "stored": ["pull"], "tolerance": "pull", "rate": True}
    assert heads_of_history["pull\n/ G"] == ["pull"]


def test_all_else_is_as_it_was(told: Told) -> None:
    checked = [
        check(of_turns(scene, engine))
        for scene in ("fourbar-lecture-1", "slider-crank-offset")
        for engine in ("mujoco", "pymunk")
    ]
    cells = cell_frame(checked).to_dict("records")
    less = [{k: v for k, v in row.items() if "pull" not in k} for row in told["cells"][:4]]
    assert json.dumps(less) == json.dumps(cells)
    rows = [row for row in told["errors"] if row["quantity"] != "pull"]
    errors = error_frame(checked).to_dict("records")
    assert json.dumps(rows[: len(errors)]) == json.dumps(errors)
