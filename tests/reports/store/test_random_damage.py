"""Bytes changed, cut and overwritten at random: no traceback, and no other number unsaid."""

from __future__ import annotations

import random
import shutil
from io import StringIO
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

from models.errors import CrankcheckError
from models.regular import UnreadableError
from reports.cli.commands.report import run_report
from reports.store.manifest import MANIFEST
from reports.store.part import open_part
from reports.store.reader import Stored, read_store
from tests.reports.store.damages import first
from tests.worlds.tiers import at_length, slowly

SEED = 20261121
MORE = "a kind of damage at a place of a file that few draws come to"


def spoil(raw: bytes, rng: random.Random) -> bytes:
    """The bytes with one bit turned over, some bytes changed, a piece zeroed, cut, or put in."""
    made = bytearray(raw)
    at = rng.randrange(len(raw))
    kind = rng.choice(["bit", "bytes", "zeros", "cut", "more", "without"])
    if kind == "bit":
        made[at] ^= 1 << rng.randrange(8)
    elif kind == "bytes":
        for _ in range(rng.randrange(1, 20)):
            made[rng.randrange(len(raw))] = rng.randrange(256)
    elif kind == "zeros":
        made[at : at + 64] = bytes(len(made[at : at + 64]))
    elif kind == "cut":
        del made[at:]
    elif kind == "more":
        made[at:at] = rng.randbytes(rng.randrange(1, 50))
    else:
        del made[at : at + rng.randrange(1, 50)]
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


@pytest.mark.parametrize("count", [20, slowly(120, reason=MORE), at_length(2000, reason=MORE)])
def test_no_number_changes_without_a_word(count: int, whole: Path, tmp_path: Path) -> None:
    rng = random.Random(SEED)
    wanted = read_store(whole)
    names = sorted(
        path.relative_to(whole)
        for path in whole.rglob("*")
        if path.is_file() and path.stat().st_size
    )
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
                assert run_report(copy, None, "md", Console(file=StringIO())) == 0
        except CrankcheckError:
            assert name == Path(MANIFEST), "one damaged part of two leaves cells to read"
            unread += 1
        (copy / name).write_bytes(raw)
    assert said + unread > 0.8 * count


def test_a_bit_turned_over_anywhere_in_a_part_is_seen(whole: Path, tmp_path: Path) -> None:
    part = first(whole, "timings")
    raw, path = bytearray(part.read_bytes()), tmp_path / part.name
    for at in (*range(0, len(raw), 1 + len(raw) // 500), *range(-40, 0)):
        raw[at] ^= 1 << at % 8
        path.write_bytes(raw)
        with pytest.raises(UnreadableError):
            open_part(path)
        raw[at] ^= 1 << at % 8
    path.write_bytes(raw)
    assert len(open_part(path).keys) == 2
