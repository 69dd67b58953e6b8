"""A store damaged on purpose: what is said, what is read, and that the same sweep mends it."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from io import StringIO
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from rich.console import Console

from models.errors import CrankcheckError
from reports.cli.changes import DiffRequest
from reports.cli.checking import VerifyRequest
from reports.cli.commands import diff, report, verify
from reports.store.damage import notice
from reports.store.examine import UNASKED, examine
from reports.store.manifest import MANIFEST
from reports.store.part import write_part
from reports.store.reader import Stored, read_store
from tests.reports.store.damages import CASES, QUICK, cases, cut, first

BY_CHANCE = ["wall_s", "logged_us_per_step"]
TIMES = ["us_per_step", "us_per_step_median", "us_per_step_a", "us_per_step_b", "s_per_turn"]
MENDED = {"swapped", "twice", "cut timings", "no manifest", "pipe", "whole part", "timings file"}
Sweep = Callable[..., int]


def ended(call: Callable[..., int], *arguments: object) -> tuple[int, str]:
    """The exit code of a command, and the message of one that was refused."""
    try:
        return call(*arguments), ""
    except CrankcheckError as error:
        return 2, str(error)


def paper() -> Console:
    return Console(file=StringIO(), width=100)


def same(found: Stored, wanted: Stored, *but: str) -> None:
    """The same cells with errors and traces, bit by bit but for what chance decides, and ``but``
    for some columns."""
    left, right = (
        one.cells.set_index("key")
        .sort_index()
        .drop(columns=[*BY_CHANCE, *TIMES, *but, "made"], errors="ignore")
        for one in (found, wanted)
    )
    pd.testing.assert_frame_equal(left, right, check_exact=True, check_like=True)
    order = ["key", "quantity", "body_kind", "body", "source", "kind"]
    errors = (one.errors.sort_values(order).reset_index(drop=True) for one in (found, wanted))
    pd.testing.assert_frame_equal(*errors, check_exact=True)
    for key in left.index:
        assert set(found.trace(key)) == set(wanted.trace(key)) != set()
        for series, values in wanted.trace(key).items():
            np.testing.assert_array_equal(found.trace(key)[series], values)


@pytest.mark.parametrize("name", CASES)
def test_what_can_be_read_is_reported_and_the_rest_is_named(
    name: str, store: Path, whole: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    case = CASES[name]
    case.change(store)
    code, message = ended(report.run_report, store, None, "md", paper())
    told = capsys.readouterr().err if case.cells else message
    assert (code, case.words in told) == (0 if case.cells else 2, True), told
    named = [line.partition(": ")[0] for line in told.splitlines()]
    assert len(named) == len(set(named)), "each damaged thing is named once"
    assert ("what mends it: crankcheck sweep" in told) == (case.cure == "sweep")
    assert ("make it anew: crankcheck sweep" in told) == (case.cure == "anew")
    if not case.cells:
        return
    assert f"{case.cells} cells can be read" in told
    found, wanted = read_store(store).cells, read_store(whole).cells
    assert len(found) == case.cells
    columns = ["scene", "variant", "profile", "gated", "version", "settings", "place_pure"]
    pd.testing.assert_frame_equal(
        found.set_index("key").sort_index()[columns],
        wanted.set_index("key").loc[sorted(found.key), columns],
        check_exact=True,
    )


@pytest.mark.parametrize("name", cases())
def test_no_gate_is_passed_on_cells_that_are_lost(name: str, store: Path, whole: Path) -> None:
    case = CASES[name]
    case.change(store)
    for old, new in ((store, whole), (whole, store)):
        code, message = ended(diff.run_diff, DiffRequest(old, new), paper())
        assert code == case.gate, message
        if case.cells and case.gate:
            assert "2 cells of" in message
            assert "may be among what is missing there" in message
            assert "mujoco tuned" in message


@pytest.mark.parametrize("name", cases(MENDED, "sweep"))
def test_the_same_sweep_mends_it_and_throws_nothing_away(
    name: str, store: Path, whole: Path, swept: Sweep, capsys: pytest.CaptureFixture[str]
) -> None:
    CASES[name].change(store)
    aside = {store / each.path for each in examine(store).damage if each.aside}
    kept = [path.read_bytes() for path in aside if path.is_file()]
    assert swept(store) == 0
    told = capsys.readouterr().err
    assert ("moved to" in told) == (store / "damaged").exists()
    found = read_store(store)
    assert found.damage == ()
    assert not found.cells.us_per_step.isna().any()
    same(found, read_store(whole))
    moved = [path.read_bytes() for path in (store / "damaged").glob("*") if path.is_file()]
    assert all(each in moved for each in kept)
    text = (store / MANIFEST).read_bytes()
    assert swept(store) == 0
    assert capsys.readouterr().err == ""
    assert (store / MANIFEST).read_bytes() == text


@pytest.mark.parametrize("name", cases(QUICK, "nothing"))
def test_what_is_not_damaged_is_left_alone(
    name: str, store: Path, swept: Sweep, capsys: pytest.CaptureFixture[str]
) -> None:
    CASES[name].change(store)
    before = {path: path.read_bytes() for path in store.rglob("*") if path.is_file()}
    assert swept(store) == 0
    assert {path: path.read_bytes() for path in store.rglob("*") if path.is_file()} == before
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("name", cases(QUICK, "anew"))
def test_another_format_is_refused_in_a_line_and_not_written_to(
    name: str, store: Path, swept: Sweep
) -> None:
    CASES[name].change(store)
    before = {path: path.read_bytes() for path in store.rglob("*") if path.is_file()}
    code, message = ended(swept, store)
    assert code == 2
    assert "\n" not in message
    assert "which reads format 2; move it away, and make it anew: crankcheck sweep" in message
    assert {path: path.read_bytes() for path in store.rglob("*") if path.is_file()} == before


def test_an_unreadable_file_is_damaged_too(
    store: Path, whole: Path, swept: Sweep, monkeypatch: pytest.MonkeyPatch
) -> None:
    locked, opened = first(store, "cells"), os.open

    def refused(path: Path, *rest: int) -> int:  # chmod does not keep root out
        if path == locked:
            raise PermissionError(13, "Permission denied", str(path))
        return opened(path, *rest)

    monkeypatch.setattr(os, "open", refused)
    found = read_store(store)
    assert len(found.cells) == 2
    assert "can not be read: Permission denied; 2 cells missing" in "\n".join(found.notice)
    assert swept(store) == 0
    same(read_store(store), read_store(whole))


def test_the_page_says_it_too(store: Path, tmp_path: Path) -> None:
    cut("cells")(store)
    path = tmp_path / "page.html"
    assert report.run_report(store, path, "html", paper()) == 0
    assert "cut short; 2 cells missing" in path.read_text(encoding="utf-8")


def test_a_baseline_that_lost_cells_passes_those_it_has(
    store: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cut("cells")(store)  # of MuJoCo

    def run(*engines: str) -> tuple[int, str]:
        asked = VerifyRequest(
            ["fourbar-lecture-1"], engines, ["tuned"], steps_per_turn=180.0, converge=False,
            jobs=1, baseline=store,
        )  # fmt: skip
        return ended(verify.verify, asked, paper(), paper())

    assert run("pymunk") == (0, "")
    assert "cut short; 2 cells missing" in capsys.readouterr().err
    code, message = run("pymunk", "mujoco")
    assert code == 2
    assert "1 cell of what was asked for, such as fourbar-lecture-1, mujoco tuned" in message


def test_both_runs_may_have_lost_the_same_cell(store: Path) -> None:
    cut("cells")(store)
    code, message = ended(diff.run_diff, DiffRequest(store, store), paper())
    assert (code, "has lost too" in message) == (2, True)


def test_a_lost_manifest_is_made_again_and_no_whole_cell_is_run_again(
    store: Path, swept: Sweep, whole: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (store / MANIFEST).unlink()
    parts = {path: path.read_bytes() for path in store.glob("*/*.parquet")}
    assert swept(store, "pymunk") == 0
    found = read_store(store)
    assert set(found.cells.engine) == {"pymunk"}
    assert found.manifest.scenes == read_store(whole).manifest.scenes
    assert UNASKED in "".join(found.notice)  # of MuJoCo
    code, message = ended(diff.run_diff, DiffRequest(whole, store), paper())
    assert (code, "may be among what is missing there" in message) == (2, True)
    assert swept(store) == 0
    same(read_store(store), read_store(whole))
    assert read_store(store).notice == []
    assert {path: path.read_bytes() for path in store.glob("*/*.parquet")} == parts
    assert len(read_store(store).manifest.runs) == 2


def test_a_lost_manifest_does_not_let_another_scene_in(store: Path, swept: Sweep) -> None:
    (store / MANIFEST).unlink()
    for path in (store / "cells").iterdir():
        rows = pq.ParquetFile(path).read()
        at = rows.column_names.index("scene_digest")
        other = pa.array(["another"] * rows.num_rows)
        path.unlink()
        write_part(store / "cells", "cells", rows.set_column(at, "scene_digest", other), 1)
    code, message = ended(swept, store)
    assert (code, "another scene called fourbar-lecture-1" in message) == (2, True)


def test_cells_that_nobody_asks_for_again_stay_lost_and_pass_no_gate(
    store: Path, whole: Path, swept: Sweep, capsys: pytest.CaptureFixture[str]
) -> None:
    cut("cells")(store)  # of MuJoCo
    assert swept(store, "pymunk") == 0
    assert "cut short; 2 cells missing" in capsys.readouterr().err
    assert "2 cells can be read, 2 missing" in read_store(store).notice[0]
    code, message = ended(diff.run_diff, DiffRequest(whole, store), paper())
    assert (code, "may be among what is missing there" in message) == (2, True)


def test_what_was_moved_before_is_not_overwritten(store: Path, swept: Sweep) -> None:
    for text in ("one", "two", "three"):
        (store / MANIFEST).write_text(text)
        assert swept(store) == 0
    found = {path.name: path.read_text() for path in (store / "damaged").iterdir()}
    assert found == {"manifest.json": "one", "manifest-2.json": "two", "manifest-3.json": "three"}


def test_a_finished_sweep_adds_no_run_and_one_that_adds_something_does(
    swept: Sweep, tmp_path: Path
) -> None:
    def runs() -> int:
        return len(json.loads((tmp_path / "s" / MANIFEST).read_text())["runs"])

    for asked, count in (
        (("90", False), 1),
        (("90", False), 1),  # nothing new
        (("90", True), 2),  # times
        (("90", True), 2),
        (("90,180", True), 3),  # another step
        (("90", True), 3),
    ):
        steps, timing = asked
        assert swept(tmp_path / "s", "pymunk", steps=steps, timing=timing) == 0
        assert runs() == count, asked


@pytest.mark.parametrize(
    "files",
    [
        ["thesis.txt"],
        ["manifest.json"],
        ["cells/biology.txt"],
        ["cells/part-00000-of-spark.parquet", "manifest.json"],
        [".lock", "damaged/old.txt"],
    ],
)
def test_a_folder_that_is_no_store_is_refused_untouched(
    files: list[str], tmp_path: Path, swept: Sweep
) -> None:
    home = tmp_path / "home"
    for name in files:
        path = home / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text('{"name": "my app"}')
    before = sorted(home.rglob("*"))
    code, message = ended(swept, home)
    assert (code, "so it is no store of a sweep" in message) == (2, True)
    assert sorted(home.rglob("*")) == before
    with pytest.raises(CrankcheckError, match="no store of a sweep there"):
        read_store(home)


def test_a_sweep_killed_at_its_very_start_goes_on(tmp_path: Path, swept: Sweep) -> None:
    (tmp_path / "s" / "cells").mkdir(parents=True)
    (tmp_path / "s" / ".lock").touch()
    assert swept(tmp_path / "s", "pymunk", steps="90") == 0


def test_what_a_killed_sweep_was_writing_is_no_damage_and_goes_with_the_next(
    store: Path, swept: Sweep, capsys: pytest.CaptureFixture[str]
) -> None:
    half = [store / f".{MANIFEST}.1.tmp", store / "cells" / ".cells-1.parquet.1.tmp"]
    for path in half:
        path.write_bytes(b"half")
    assert read_store(store).notice == []
    assert swept(store) == 0
    assert capsys.readouterr().err == ""
    assert not any(path.exists() for path in half)


def test_a_lock_that_can_not_be_taken_is_said(store: Path, swept: Sweep) -> None:
    (store / ".lock").unlink(missing_ok=True)
    (store / ".lock").mkdir()
    code, message = ended(swept, store)
    assert (code, ".lock can not be locked" in message) == (2, True)


def test_a_name_can_not_speak_to_the_terminal(store: Path) -> None:
    (store / "\x1b[2Jgone\n.txt").write_text("x")
    assert "  \\x1b[2Jgone\\n.txt: not of the store; left alone" in read_store(store).notice


def test_a_notice_is_no_longer_than_one_reads(store: Path) -> None:
    cut("cells")(store)
    many = read_store(store).damage * 100
    assert len(notice(store, many, 2, ())) <= 25
    assert notice(store, (), 4, ()) == []
