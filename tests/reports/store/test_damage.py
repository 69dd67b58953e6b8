"""A store damaged on purpose: what is said, what is read, and that the same sweep mends it."""

import json
import random
import re
import shutil
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
from reports.requests.diff import DiffRequest
from reports.requests.report import ReportRequest
from reports.requests.verify import VerifyRequest
from reports.store.folder import write_part
from reports.store.manifest import MANIFEST, notice
from reports.store.reader import UNASKED, Stored, examine, read_store
from tests.reports.store.damages import CASES, CUT, QUICK, cases, cut
from tests.worlds.tiers import at_length, slow, slowly

BY_CHANCE = ["wall_s", "logged_us_per_step"]
TIMES = ["us_per_step", "us_per_step_median", "us_per_step_a", "us_per_step_b", "s_per_turn"]
MENDED = {"swapped", "timings file"}
Sweep = Callable[..., int]


def ended(call: Callable[..., int], *arguments: object) -> tuple[int, str]:
    try:
        return call(*arguments), ""
    except CrankcheckError as error:
        return 2, str(error)


def refusal(call: Callable[..., object], *arguments: object) -> str:
    with pytest.raises(CrankcheckError) as caught:
        call(*arguments)
    return str(caught.value)


def differ(old: Path, new: Path) -> int:
    return DiffRequest(old, new).run(paper(), paper())


def paper() -> Console:
    return Console(file=StringIO(), width=100)


def files(folder: Path) -> dict[Path, bytes]:
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


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


@pytest.mark.parametrize("name", cases())
def test_what_can_be_read_is_reported_and_the_rest_is_named(
    name: str, store: Path, whole: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    case = CASES[name]
    case.change(store)
    code, message = ended(ReportRequest(store, format="md").run, paper(), paper())
    told = capsys.readouterr().err if case.cells else message
    assert (code, case.words in told) == (0 if case.cells else 2, True), told
    named = [line.partition(": ")[0] for line in told.splitlines()]
    assert len(named) == len(set(named)), "each damaged thing is named once"
    assert ("to repair it: crankcheck sweep" in told) == (case.cure == "sweep")
    assert ("make it again: crankcheck sweep" in told) == (case.cure == "anew")
    if not case.cells:
        return
    assert f"{case.cells} cells can be read" in told
    found, wanted = read_store(store).cells, read_store(whole).cells
    assert len(found) == case.cells
    columns = ["scene", "variant", "profile", "gated", "version", "settings", "place_pure"]
    left, right = (
        each.set_index("key").loc[sorted(found.key), columns] for each in (found, wanted)
    )
    pd.testing.assert_frame_equal(left, right, check_exact=True)


@pytest.mark.parametrize("name", cases({"cut", "twice", "other store", "cut manifest", "newer"}))
def test_no_gate_is_passed_on_cells_that_are_lost(name: str, store: Path, whole: Path) -> None:
    case = CASES[name]
    case.change(store)
    for old, new in ((store, whole), (whole, store)):
        code, message = ended(differ, old, new)
        assert code == case.gate, message
        if case.cells and case.gate:
            assert "2 cells of" in message
            assert "may be among the missing cells there" in message
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
    assert not found.cells.us_per_step.isna().any()
    same(found, read_store(whole))
    moved = [path.read_bytes() for path in (store / "damaged").glob("*") if path.is_file()]
    assert all(each in moved for each in kept)
    text = (store / MANIFEST).read_bytes()
    assert swept(store) == 0
    assert capsys.readouterr().err == ""
    assert (store / MANIFEST).read_bytes() == text


@pytest.mark.parametrize("name", cases(QUICK, "nothing", "anew"))
def test_what_is_not_damaged_or_of_another_format_is_left_alone(
    name: str, store: Path, swept: Sweep, capsys: pytest.CaptureFixture[str]
) -> None:
    CASES[name].change(store)
    before = files(store)
    if CASES[name].cure == "nothing":
        assert swept(store) == 0
    else:
        anew = "which reads format 2; move it away, and make it again: crankcheck sweep"
        assert re.fullmatch(f".*{anew}.*", refusal(swept, store))  # one line
    assert files(store) == before
    assert capsys.readouterr().err == ""


def test_a_cut_baseline_passes_what_it_has(store: Path, capsys: pytest.CaptureFixture[str]) -> None:
    cut("cells")(store)  # of MuJoCo
    assert "lost too" in refusal(differ, store, store)

    def run(*engines: str) -> tuple[int, str]:
        alone = {"steps_per_turn": 180.0, "converge": False, "jobs": 1, "baseline": store}
        asked = VerifyRequest(["fourbar-lecture-1"], engines, ["tuned"], **alone)
        return ended(asked.run, paper(), paper())

    assert run("pymunk") == (0, "")
    assert CUT in capsys.readouterr().err
    code, message = run("pymunk", "mujoco")
    assert code == 2
    assert "1 cell of the request, such as fourbar-lecture-1, mujoco tuned" in message


def test_a_lost_manifest_is_remade_for_its_scenes(store: Path, swept: Sweep, whole: Path) -> None:
    (store / MANIFEST).unlink()
    parts = {path: path.read_bytes() for path in store.glob("*/*.parquet")}
    assert swept(store, "pymunk") == 0
    found = read_store(store)
    assert set(found.cells.engine) == {"pymunk"}
    assert found.manifest.scenes == read_store(whole).manifest.scenes
    assert UNASKED in "".join(found.notice)  # of MuJoCo
    assert "may be among the missing cells there" in refusal(differ, whole, store)
    assert swept(store) == 0
    same(read_store(store), read_store(whole))
    assert read_store(store).notice == []
    assert {path: path.read_bytes() for path in store.glob("*/*.parquet")} == parts
    assert len(read_store(store).manifest.runs) == 2
    (store / MANIFEST).unlink()
    for path in (store / "cells").iterdir():
        rows = pq.ParquetFile(path).read()
        at = rows.column_names.index("scene_digest")
        other = pa.array(["another"] * rows.num_rows)
        path.unlink()
        write_part(store / "cells", "cells", rows.set_column(at, "scene_digest", other), 1)
    assert "another scene called fourbar-lecture-1" in refusal(swept, store)


@slow("three sweeps over damage; one is mended above")
def test_what_was_moved_before_is_not_overwritten_and_what_was_half_written_is_no_damage(
    store: Path, swept: Sweep, capsys: pytest.CaptureFixture[str]
) -> None:
    for text in ("one", "two", "three"):
        (store / MANIFEST).write_text(text)
        assert swept(store) == 0
    found = {path.name: path.read_text() for path in (store / "damaged").iterdir()}
    assert found == {"manifest.json": "one", "manifest-2.json": "two", "manifest-3.json": "three"}
    capsys.readouterr()
    half = [store / f".{MANIFEST}.1.tmp", store / "cells" / ".cells-1.parquet.1.tmp"]
    for path in half:
        path.write_bytes(b"half")
    assert read_store(store).notice == []
    assert swept(store) == 0
    assert capsys.readouterr().err == ""
    assert not any(path.exists() for path in half)


def test_a_finished_sweep_adds_no_run_and_one_with_more_does(swept: Sweep, tmp_path: Path) -> None:
    def runs() -> int:
        return len(json.loads((tmp_path / "s" / MANIFEST).read_text())["runs"])

    (tmp_path / "s" / "cells").mkdir(parents=True)  # as where one was killed at its very start
    (tmp_path / "s" / ".lock").touch()
    for steps, timing, count, what in (
        *(("90", False, 1, "cells"), ("90", False, 1, "nothing new"), ("90", True, 2, "times")),
        *(("90", True, 2, "nothing"), ("90,180", True, 3, "another step"), ("90", True, 3, "none")),
    ):
        assert swept(tmp_path / "s", "pymunk", steps=steps, timing=timing) == 0
        assert runs() == count, what


@pytest.mark.parametrize(
    "names",
    ["thesis.txt", MANIFEST, f"cells/part-of-spark.parquet {MANIFEST}", ".lock damaged/old.txt"],
)
def test_what_is_no_store_is_refused_untouched(names: str, tmp_path: Path, swept: Sweep) -> None:
    home = tmp_path / "home"
    for name in names.split():
        (home / name).parent.mkdir(parents=True, exist_ok=True)
        (home / name).write_text('{"name": "my app"}')
    before = sorted(home.rglob("*"))
    assert "so it is not the store of a sweep" in refusal(swept, home)
    assert sorted(home.rglob("*")) == before
    assert "no store of a sweep there" in refusal(read_store, home)


def test_a_lock_that_can_not_be_taken_is_said(store: Path, swept: Sweep) -> None:
    (store / ".lock").unlink(missing_ok=True)
    (store / ".lock").mkdir()
    assert ".lock can not be locked" in refusal(swept, store)


def test_a_notice_is_short_and_no_name_in_it_speaks_to_the_terminal(store: Path) -> None:
    (store / "\x1b[2Jgone\n.txt").write_text("x")
    cut("cells")(store)
    found = read_store(store)
    assert "  \\x1b[2Jgone\\n.txt: not of the store; left alone" in found.notice
    assert len(notice(store, found.damage * 100, 2, ())) <= 25
    assert notice(store, (), 4, ()) == []


SEED = 20261121
MORE = "a kind of damage at a place of a file that few draws come to"


def spoil(raw: bytes, rng: random.Random) -> bytes:
    """The bytes with one bit turned over, a piece zeroed, cut, or put in."""
    made, at = bytearray(raw), rng.randrange(len(raw))
    kind = rng.choice(["bit", "zeros", "cut", "more"])
    if kind == "bit":
        made[at] ^= 1 << rng.randrange(8)
    elif kind == "zeros":
        made[at : at + 64] = bytes(len(made[at : at + 64]))
    elif kind == "cut":
        del made[at:]
    else:
        made[at:at] = rng.randbytes(rng.randrange(1, 50))
    return bytes(made)


def differs(found: Stored, wanted: Stored) -> bool:
    """Whether anything is read that is not as it was written."""
    same = (
        found.cells.equals(wanted.cells)
        and found.errors.equals(wanted.errors)
        and found.manifest == wanted.manifest
        and found._traces.keys() == wanted._traces.keys()
    )
    return not same or any(
        not np.array_equal(found.trace(key)[name], values, equal_nan=True)
        for key, series in wanted._traces.items()
        for name, values in series.items()
    )


@pytest.mark.parametrize("count", [12, slowly(120, reason=MORE), at_length(2000, reason=MORE)])
def test_no_number_changes_without_a_word(count: int, whole: Path, tmp_path: Path) -> None:
    rng = random.Random(SEED)
    wanted = read_store(whole)
    names = sorted(path.relative_to(whole) for path, raw in files(whole).items() if raw)
    said = unread = 0
    copy = shutil.copytree(whole, tmp_path / "s")
    for number in range(count):
        name = rng.choice(names)
        raw = (whole / name).read_bytes()
        (copy / name).write_bytes(spoil(raw, rng))
        try:
            found = read_store(copy)
            said += bool(found.damage)
            assert found.damage or not differs(found, wanted), (SEED, number, name)
            known = wanted.cells[wanted.cells.key.isin(found.cells.key)]
            columns = ["scene", "engine", "version", "dt_s", "status", "place_pure", "settings"]
            assert found.cells[columns].equals(known[columns].reset_index(drop=True)), number
            if number % 10 == 0:
                assert ReportRequest(copy, format="md").run(paper(), paper()) == 0
        except CrankcheckError:
            assert name == Path(MANIFEST), "one damaged part of two leaves cells to read"
            unread += 1
        (copy / name).write_bytes(raw)
    assert said + unread > 0.8 * count
