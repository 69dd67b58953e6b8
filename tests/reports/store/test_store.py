"""What a store takes, keeps and refuses; and what is read while a sweep writes to it, or one left
it half written."""

import json
import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq  # type: ignore[import-untyped]  # ships no stubs
import pytest
from filelock import FileLock

from models.errors import CrankcheckError
from models.scene import Scene
from reports.judge.cell import Cell
from reports.plan.grid import digest
from reports.requests.report import ReportRequest
from reports.store import folder as lock
from reports.store import folder as part
from reports.store import writer as mending
from reports.store.folder import TablePart, open_part, write_part
from reports.store.manifest import BUSY, NESTED, Manifest, read_manifest
from reports.store.reader import examine, read_store, stored_costs, stored_keys
from reports.store.writer import Writer
from reports.sweep.measured import MeasuredCell, measured
from tests.reports.store.damages import LATER, cut, first, gone
from tests.reports.store.test_damage import differ, paper, refusal, same
from tests.worlds.tiers import few

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
    with Writer(tmp_path, Manifest()) as writer:
        writer.trajectory("k1", outcome.run)
    found = pq.read_table(tmp_path / "trajectories" / "k1.parquet").to_pandas()
    np.testing.assert_array_equal(found.time_s, outcome.run.motion.time_s)
    np.testing.assert_array_equal(found.rocker_theta_rad, outcome.run.motion.links["rocker"].theta)
    np.testing.assert_array_equal(found.C_gap_m, outcome.run.gaps["C"])


def test_a_second_run_adds_and_parts_are_forgotten(tmp_path: Path, outcome: MeasuredCell) -> None:
    filled(tmp_path, outcome, "k1")
    first = {path: path.read_bytes() for path in tmp_path.glob("*/*.parquet")}
    filled(tmp_path, outcome, "k2")
    assert {path: path.read_bytes() for path in first} == first
    assert list(read_store(tmp_path).cells.key) == ["k1", "k2"]
    assert [run["command"] for run in read_manifest(tmp_path).runs] == [["k1"], ["k2"]]
    filled(tmp_path, outcome, "k3", "k4")
    with Writer(tmp_path, Manifest()) as writer:
        writer.forget({"k1", "k3", "k9"})
    found = read_store(tmp_path)
    assert list(found.cells.key) == ["k2", "k4"]
    assert set(found.errors.key) == {"k2", "k4"}
    assert found.trace("k1") == {}
    assert found.trace("k2")


def test_a_changed_scene_and_no_store_are_refused(tmp_path: Path, outcome: MeasuredCell) -> None:
    name = str(outcome.row["scene"])
    with Writer(tmp_path, Manifest({name: TEXT})) as writer:
        row = {**names("k1"), "scene_digest": digest(TEXT), **outcome.row}
        writer.cell(row, outcome.errors, outcome.trace)
    with pytest.raises(CrankcheckError, match=f"another scene called {name}"):
        Writer(tmp_path, Manifest({name: TEXT.replace("1.0", "2.0")}))
    Writer(tmp_path, Manifest({name: "# the same\n" + TEXT})).__exit__(None, None, None)
    with Writer(tmp_path / "s", Manifest()):
        pass
    with pytest.raises(CrankcheckError, match="a store without cells"):
        read_store(tmp_path / "s")
    (tmp_path / "thesis.txt").write_text("years of work")
    with pytest.raises(CrankcheckError, match="is a file; name a folder"):
        Writer(tmp_path / "thesis.txt", Manifest())


@pytest.fixture
def held(store: Path) -> Iterator[FileLock]:
    with FileLock(store / ".lock", timeout=0) as taken:
        yield taken


def test_cells_that_a_sweep_is_to_write_yet_are_no_damage(
    store: Path, held: FileLock, capsys: pytest.CaptureFixture[str]
) -> None:
    assert read_store(store).notice == []  # all are there
    gone("cells", "timings")(store)
    assert ReportRequest(store, format="md").run(paper(), paper()) == 0
    told = f"crankcheck: {store}: {BUSY}; 2 cells can be read, 2 missing\n"
    assert capsys.readouterr().err == told
    (only := first(store, "cells")).rename(aside := store / only.name)
    assert f"{BUSY}; 0 cells can be read, 4 missing" in refusal(read_store, store)
    aside.rename(only)
    held.release()
    notice = "".join(read_store(store).notice)
    assert ("to repair it" in notice, BUSY in notice) == (True, False)


def test_a_running_sweep_is_not_compared_yet(store: Path, whole: Path, held: FileLock) -> None:
    gone("cells")(store)
    for old, new in ((store, whole), (whole, store)):
        message = refusal(differ, old, new)
        for words in ("2 cells of", f"{BUSY}; 2 cells missing", "let its sweep end first"):
            assert words in message
    assert differ(store, store) == 0
    cut("timings")(store)  # and what is damaged is told too
    head, *lines = read_store(store).notice
    assert BUSY in head
    assert "cut short; its times are lost" in "".join(lines)
    assert "to repair it" in "".join(lines)


def test_a_part_that_a_sweep_replaces_meanwhile_is_read_where_it_is_now(
    store: Path, held: FileLock, monkeypatch: pytest.MonkeyPatch
) -> None:
    replaced = []

    def opened(path: Path) -> TablePart:
        if not replaced:  # as where a cell that a limit ended is to be run again
            replaced.append(path)
            open_part(path).write_again([False, True])
            path.unlink()
        return open_part(path)

    monkeypatch.setattr("reports.store.folder.open_part", opened)
    found = read_store(store)
    assert len(found.cells) == 3
    assert [each.what for each in found.damage] == [BUSY]


def test_a_sweep_that_comes_or_goes_is_seen(store: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    gone("cells")(store)
    for busy in ([True], [False, True]):
        seen = iter(busy)
        monkeypatch.setattr("reports.store.folder.is_written", lambda _, seen=seen: next(seen))
        assert [each.what for each in read_store(store).damage] == [BUSY]


@pytest.mark.parametrize("there", ["none", "a folder"])
def test_a_lock_that_can_not_be_tried_hinders_no_reader(there: str, store: Path) -> None:
    gone("cells")(store)
    (store / ".lock").unlink(missing_ok=True)
    if there == "a folder":
        (store / ".lock").mkdir()
    before = sorted(store.rglob("*"))
    assert "was one stopped?; 2 cells missing" in "".join(read_store(store).notice)
    assert sorted(store.rglob("*")) == before


def test_a_reader_takes_the_lock_of_no_sweep(store: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert lock.READER_S < lock.SWEEP_S
    monkeypatch.setattr(lock, "SWEEP_S", 600.0)  # a busy machine may be late with a timer
    reader = FileLock(store / ".lock", thread_local=False)
    reader.acquire()
    threading.Timer(0.1, reader.release).start()
    with lock.locked(store):
        assert not reader.is_locked
        assert lock.is_written(store)
    assert not lock.is_written(store)


class KilledError(Exception):
    """In place of a signal."""


def repeat_one_cell(folder: Path) -> None:
    """Write one of MuJoCo's two cells, and its times, once more in a later part."""
    key = open_part(first(folder, "cells")).keys[0]
    for table in ("cells", "timings"):
        whole = open_part(first(folder, table))
        rows = whole.file.read().filter(pa.array([k == key for k in whole.keys]))
        write_part(folder / table, table, rows, LATER)


def killed_at(step: int, monkeypatch: pytest.MonkeyPatch, *calls: tuple[object, str]) -> None:
    """Let some functions be called ``step`` times in all, and no more."""
    left = [None] * step

    def counted(call: Callable[..., object]) -> Callable[..., object]:
        def until(*arguments: object, **options: object) -> object:
            if not left:
                raise KilledError
            left.pop()
            return call(*arguments, **options)

        return until

    for where, name in calls:
        monkeypatch.setattr(where, name, counted(getattr(where, name)))


@pytest.mark.parametrize("step", few(range(4), {2}, "between others"))
def test_mending_that_is_killed_loses_no_cell(
    step: int, store: Path, whole: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    repeat_one_cell(store)
    killed_at(step, monkeypatch, (part, "write"), (mending, "_set_aside"))
    with pytest.raises(KilledError):
        mending.mend(store, examine(store))
    monkeypatch.undo()
    same(read_store(store), read_store(whole))  # with all errors and traces
    mending.mend(store, examine(store))
    assert examine(store).damage == ()
    same(read_store(store), read_store(whole))


@pytest.mark.parametrize("step", few(range(2), {1}, "before the first"))
def test_a_sweep_killed_while_it_takes_out_a_cell_loses_no_other(
    step: int, store: Path, whole: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    wanted = read_store(whole)
    key = wanted.cells.key[0]
    with Writer(store, wanted.manifest) as writer:
        killed_at(step, monkeypatch, (part, "write"), (Path, "unlink"))
        with pytest.raises(KilledError):
            writer.forget({key})
        monkeypatch.undo()
    same(read_store(store), wanted)
    with Writer(store, wanted.manifest) as writer:
        writer.forget({key})
    found = read_store(store)
    assert set(found.cells.key) == set(wanted.cells.key) - {key}
    assert "rows that another part has too" not in "".join(found.notice)
