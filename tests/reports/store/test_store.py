"""What a store takes, keeps and refuses."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow.parquet as pq  # type: ignore[import-untyped]  # ships no stubs
import pytest

from models.errors import CrankcheckError
from models.scene import Scene
from reports.judge.cell import Cell
from reports.plan.key import digest
from reports.store.manifest import Manifest, read_manifest
from reports.store.reader import read_store, stored_costs, stored_keys
from reports.store.schema import NESTED, table
from reports.store.writer import Writer
from reports.sweep.measured import MeasuredCell, measured

TEXT = 'name = "a"\nsize = 1.0\n'


@pytest.fixture(scope="module")
def outcome(fourbar: Scene) -> MeasuredCell:
    cell = Cell(fourbar, "pymunk", "tuned", fourbar.driver.law.period_s / 90, 180, converge=False)
    return measured(cell, keep_run=True)


def names(key: str) -> dict[str, object]:
    return {"key": key, "line": "l", "variant": "v", "scene_digest": "d", "asked": {"a": 1}}


def filled(folder: Path, outcome: MeasuredCell, *keys: str) -> None:
    with Writer(folder, Manifest({"a": TEXT}, ({"command": list(keys)},))) as writer:
        for key in keys:
            writer.cell({**names(key), **outcome.row}, outcome.errors, outcome.trace)


def test_the_last_run_says_what_cells_are_called(tmp_path: Path, outcome: MeasuredCell) -> None:
    with Writer(tmp_path, Manifest({}, ({"lines": {"l1": ["old", "tuned", False]}},))) as writer:
        for key, line in (("k1", "l1"), ("k2", "l2")):
            row = {**names(key), "line": line, "variant": "old", **outcome.row}
            writer.cell(row, outcome.errors, {})
    for lines in ({"l2": ["mid", "tuned", False]}, {"l1": ["new", "as-shipped", True]}):
        with Writer(tmp_path, Manifest({}, ({"lines": lines},))):
            pass
    cells = read_store(tmp_path).cells[["key", "variant", "profile", "gated"]]
    assert cells.to_numpy().tolist() == [  # what was asked for last stands last
        ["k2", "mid", "tuned", False],
        ["k1", "new", "as-shipped", True],
    ]


def test_cells_are_forgotten_part_by_part(tmp_path: Path, outcome: MeasuredCell) -> None:
    filled(tmp_path, outcome, "k1", "k2")
    filled(tmp_path, outcome, "k3")
    with Writer(tmp_path, Manifest()) as writer:
        writer.forget({"k1", "k3", "k9"})
    found = read_store(tmp_path)
    assert list(found.cells.key) == ["k2"]
    assert set(found.errors.key) == {"k2"}
    assert found.trace("k1") == {}
    assert found.trace("k2")


def test_what_is_written_is_read_again(tmp_path: Path, outcome: MeasuredCell) -> None:
    filled(tmp_path, outcome, "k1", "k2")
    found = read_store(tmp_path)
    assert list(found.cells.key) == ["k1", "k2"]
    assert found.cells.place_pure[0] == outcome.row["place_pure"]
    assert json.loads(found.cells.asked[0]) == {"a": 1}
    rows = [{"key": key} | dict(each) for key in ("k1", "k2") for each in outcome.errors]
    wanted = pd.DataFrame(rows).astype({"samples": float})[["key", *NESTED["errors"]]]
    pd.testing.assert_frame_equal(found.errors, wanted, check_exact=True)
    trace = found.trace("k2")
    assert set(trace) == set(outcome.trace)
    for series, values in outcome.trace.items():
        np.testing.assert_array_equal(trace[series], values)
    assert found.trace("k3") == {}
    assert stored_keys(tmp_path, "cells") == {"k1", "k2"}
    assert stored_keys(tmp_path, "timings") == set()
    us = outcome.row["logged_us_per_step"]
    assert stored_costs(tmp_path) == {"k1": us, "k2": us}
    said = {name for row in outcome.errors for name in row}
    assert said - outcome.row.keys() == {*NESTED["errors"]}


def test_a_second_run_adds_and_replaces_nothing(tmp_path: Path, outcome: MeasuredCell) -> None:
    filled(tmp_path, outcome, "k1")
    first = {path: path.read_bytes() for path in tmp_path.glob("*/*.parquet")}
    filled(tmp_path, outcome, "k2")
    assert {path: path.read_bytes() for path in first} == first
    assert list(read_store(tmp_path).cells.key) == ["k1", "k2"]
    assert [run["command"] for run in read_manifest(tmp_path).runs] == [["k1"], ["k2"]]


def test_types_of_columns_do_not_depend_on_what_is_missing() -> None:
    full = {"key": "k", "gated": True, "place_pure": 1, "reason": "x"}
    full |= {"trace": [{"series": "drive", "values": np.ones(2)}], "errors": [{"samples": 3}]}
    empty = dict.fromkeys(full) | {"trace": []}
    assert table([full]).schema == table([empty]).schema


def test_all_parts_have_one_schema(tmp_path: Path, outcome: MeasuredCell) -> None:
    filled(tmp_path, outcome, "k1")
    lost = dict.fromkeys(outcome.row) | {"status": "crashed"}
    with Writer(tmp_path, Manifest()) as writer:
        writer.cell({**names("k2"), **lost}, (), {})
    first, second = [pq.read_schema(path) for path in tmp_path.glob("cells/*.parquet")]
    assert first == second


def test_trajectories_are_kept_beside_the_rows(tmp_path: Path, outcome: MeasuredCell) -> None:
    with Writer(tmp_path, Manifest()) as writer:
        writer.trajectory("k1", outcome.run)
    found = pq.read_table(tmp_path / "trajectories" / "k1.parquet").to_pandas()
    np.testing.assert_array_equal(found.time_s, outcome.run.motion.time_s)
    np.testing.assert_array_equal(found.rocker_theta_rad, outcome.run.motion.links["rocker"].theta)
    np.testing.assert_array_equal(found.C_gap_m, outcome.run.gaps["C"])


def test_a_changed_scene_of_the_same_name_is_refused(tmp_path: Path, outcome: MeasuredCell) -> None:
    name = str(outcome.row["scene"])
    with Writer(tmp_path, Manifest({name: TEXT})) as writer:
        row = {**names("k1"), "scene_digest": digest(TEXT), **outcome.row}
        writer.cell(row, outcome.errors, outcome.trace)
    with pytest.raises(CrankcheckError, match=f"another scene called {name}"):
        Writer(tmp_path, Manifest({name: TEXT.replace("1.0", "2.0")}))
    Writer(tmp_path, Manifest({name: "# the same\n" + TEXT})).__exit__(None, None, None)


def test_what_is_no_store_or_an_empty_one_is_refused(tmp_path: Path) -> None:
    with Writer(tmp_path / "s", Manifest()):
        pass
    with pytest.raises(CrankcheckError, match="a store without cells"):
        read_store(tmp_path / "s")
    path = tmp_path / "home" / "thesis.txt"
    path.parent.mkdir()
    path.write_text("years of work")
    with pytest.raises(CrankcheckError, match="is a file; name a folder"):
        Writer(path, Manifest())
    with pytest.raises(CrankcheckError, match=r"holds thesis\.txt and no manifest"):
        Writer(path.parent, Manifest())
    assert [*path.parent.iterdir()] == [path]
