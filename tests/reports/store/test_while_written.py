"""A store that is read while a sweep writes to it."""

from __future__ import annotations

import shutil
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from filelock import FileLock

from models.errors import CrankcheckError
from reports.cli.changes import DiffRequest
from reports.cli.commands import diff, report
from reports.store import lock
from reports.store.damage import BUSY
from reports.store.part import Part, open_part
from reports.store.reader import read_store
from tests.reports.store.damages import cut, gone
from tests.reports.store.test_damage import ended, paper


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
    told = capsys.readouterr().err.splitlines()
    assert told == [f"crankcheck: {store}: {BUSY}; 2 cells can be read, 2 missing"]
    assert held.is_locked
    held.release()
    assert "what mends it" in "".join(read_store(store).notice)
    assert BUSY not in "".join(read_store(store).notice)


def test_a_comparison_with_a_running_sweep_waits_for_its_cells(
    store: Path, whole: Path, held: FileLock
) -> None:
    gone("cells")(store)
    for old, new in ((store, whole), (whole, store)):
        code, message = ended(diff.run_diff, DiffRequest(old, new), paper())
        assert code == 2
        assert "2 cells of" in message
        assert f"{BUSY}; 2 cells missing" in message
        assert "let its sweep end first" in message
    assert ended(diff.run_diff, DiffRequest(store, store), paper()) == (0, "")


def test_what_is_damaged_is_told_while_a_sweep_writes_too(store: Path, held: FileLock) -> None:
    gone("cells")(store)
    cut("timings")(store)
    lines = read_store(store).notice
    assert BUSY in lines[0]
    assert "cut short; its times are lost" in "\n".join(lines)
    assert "what mends it" in "\n".join(lines)


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


def test_a_sweep_without_a_cell_yet_is_said_to_run(store: Path, held: FileLock) -> None:
    shutil.rmtree(store / "cells")
    (store / "cells").mkdir()
    with pytest.raises(CrankcheckError, match=f"{BUSY}; 0 cells can be read, 4 missing"):
        read_store(store)


def test_a_whole_store_is_read_without_a_word_while_a_sweep_writes(
    store: Path, held: FileLock
) -> None:
    assert read_store(store).notice == []


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
