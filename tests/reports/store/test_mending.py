"""Mending that is killed half way: every good cell stays in the store."""

from __future__ import annotations

from pathlib import Path

import pyarrow as pa
import pytest

from reports.store import mending, part
from reports.store.examine import examine
from reports.store.part import open_part, write_part
from reports.store.reader import read_store
from reports.store.writer import Writer
from tests.reports.store.damages import LATER, first
from tests.reports.store.test_damage import same
from tests.worlds.tiers import few


class KilledError(Exception):
    """In place of a signal."""


def repeat_one_cell(folder: Path) -> None:
    """Write one of MuJoCo's two cells, and its times, once more in a later part."""
    key = open_part(first(folder, "cells")).keys[0]
    for table in ("cells", "timings"):
        whole = open_part(first(folder, table))
        rows = whole.file.read()
        write_part(
            folder / table, table, rows.filter(pa.array([k == key for k in whole.keys])), LATER
        )


def killed_at(step: int, monkeypatch: pytest.MonkeyPatch, *calls: tuple[object, str]) -> None:
    """Let some functions be called ``step`` times in all, and no more."""
    done = 0

    def counted(where: object, name: str) -> None:
        call = getattr(where, name)

        def until(*arguments: object, **options: object) -> object:
            nonlocal done
            if done == step:
                raise KilledError
            done += 1
            return call(*arguments, **options)

        monkeypatch.setattr(where, name, until)

    for where, name in calls:
        counted(where, name)


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
