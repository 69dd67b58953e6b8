"""Mending that is killed half way: every good cell stays in the store."""

from __future__ import annotations

from pathlib import Path

import pytest

from reports.store import mending
from reports.store.examine import examine
from reports.store.part import open_part, part_bytes
from reports.store.reader import read_store
from tests.reports.store.damages import LATER, first
from tests.reports.store.test_damage import same


class KilledError(Exception):
    """In place of a signal."""


def repeat_one_cell(folder: Path) -> None:
    """Write one of MuJoCo's two cells once more, as a later part with its errors and traces."""
    key = open_part(first(folder, "cells"), "cells").keys[0]
    for table in ("cells", "errors", "traces", "timings"):
        content = open_part(first(folder, table), table).content
        mask = [each == key for each in content.column("key").to_pylist()]
        (folder / table / LATER).write_bytes(part_bytes(content.filter(mask)))


@pytest.mark.parametrize("step", range(8))
def test_mending_that_is_killed_loses_no_cell(
    step: int, store: Path, whole: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    repeat_one_cell(store)
    done = 0

    def killed_at(name: str) -> None:
        call = getattr(mending, name)

        def until(*arguments: object) -> object:
            nonlocal done
            if done == step:
                raise KilledError
            done += 1
            return call(*arguments)

        monkeypatch.setattr(mending, name, until)

    killed_at("write")
    killed_at("_set_aside")
    with pytest.raises(KilledError):
        mending.mend(store, examine(store))
    monkeypatch.undo()
    same(read_store(store), read_store(whole))  # with all errors and traces
    mending.mend(store, examine(store))
    found = examine(store)
    assert (found.damage, found.bare) == ((), frozenset())
    same(read_store(store), read_store(whole))
