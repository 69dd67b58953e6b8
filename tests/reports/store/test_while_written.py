"""A store that is read while a sweep writes to it, or that one left half written."""

from __future__ import annotations

import shutil
import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import pyarrow as pa
import pytest
from filelock import FileLock

from reports.cli.commands import report
from reports.store import lock, mending, part
from reports.store.damage import BUSY
from reports.store.examine import examine
from reports.store.part import Part, open_part, write_part
from reports.store.reader import read_store
from reports.store.writer import Writer
from tests.reports.store.damages import LATER, cut, first, gone
from tests.reports.store.test_damage import differ, paper, refusal, same
from tests.worlds.tiers import few


@pytest.fixture
def held(store: Path) -> Iterator[FileLock]:
    """The lock of the store, as a sweep holds it."""
    with FileLock(store / ".lock", timeout=0) as taken:
        yield taken


def test_cells_that_a_sweep_is_to_write_yet_are_no_damage(
    store: Path, held: FileLock, capsys: pytest.CaptureFixture[str]
) -> None:
    gone("cells", "timings")(store)
    assert report.run_report(store, None, "md", paper()) == 0
    told = f"crankcheck: {store}: {BUSY}; 2 cells can be read, 2 missing\n"
    assert capsys.readouterr().err == told
    assert held.is_locked
    held.release()
    notice = "".join(read_store(store).notice)
    assert ("what mends it" in notice, BUSY in notice) == (True, False)


def test_a_comparison_with_a_running_sweep_waits_for_its_cells(
    store: Path, whole: Path, held: FileLock
) -> None:
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
    assert "what mends it" in "".join(lines)


def test_a_part_that_a_sweep_replaces_meanwhile_is_read_where_it_is_now(
    store: Path, held: FileLock, monkeypatch: pytest.MonkeyPatch
) -> None:
    replaced = []

    def opened(path: Path) -> Part:
        if not replaced:  # as where a cell that a limit ended is to be run again
            replaced.append(path)
            open_part(path).write_again([False, True])
            path.unlink()
        return open_part(path)

    monkeypatch.setattr("reports.store.folder.open_part", opened)
    found = read_store(store)
    assert len(found.cells) == 3
    assert [each.what for each in found.damage] == [BUSY]


def test_a_whole_store_is_read_without_a_word_and_one_without_a_cell_is_said_to_be_written(
    store: Path, held: FileLock
) -> None:
    assert read_store(store).notice == []
    shutil.rmtree(store / "cells")
    (store / "cells").mkdir()
    assert f"{BUSY}; 0 cells can be read, 4 missing" in refusal(read_store, store)


def test_a_sweep_that_begins_or_ends_meanwhile_is_seen(
    store: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    gone("cells")(store)
    for busy in ([True], [False, True]):
        seen = iter(busy)
        monkeypatch.setattr("reports.store.reader.is_written", lambda _, seen=seen: next(seen))
        assert [each.what for each in read_store(store).damage] == [BUSY]


@pytest.mark.parametrize("there", ["none", "a folder", "refused"])
def test_a_lock_that_can_not_be_tried_hinders_no_reader(
    there: str, store: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    gone("cells")(store)
    (store / ".lock").unlink(missing_ok=True)
    if there == "a folder":
        (store / ".lock").mkdir()
    elif there == "refused":  # chmod does not keep root out
        (store / ".lock").touch()

        def refused(*_: object, **__: object) -> None:
            raise PermissionError(13, "Permission denied")

        monkeypatch.setattr(lock.FileLock, "acquire", refused)
    before = sorted(store.rglob("*"))
    assert "was one stopped?; 2 cells missing" in "".join(read_store(store).notice)
    assert sorted(store.rglob("*")) == before


def test_a_reader_takes_the_lock_from_no_sweep_that_starts(
    store: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
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


@pytest.mark.parametrize("step", few(range(4), {1, 2}, "before the first and after the last"))
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


@pytest.mark.parametrize("step", range(2))
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
