"""An engine that crashes, hangs or fills memory costs its own cell alone."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

import pytest

from reports.store.reader import read_store
from reports.workers.isolated import Isolated, Limits, Lost
from tests.worlds.command import shadows

EXPECTED = {
    "none": ("ok", ""),
    "abort": ("crashed", "the engine ended its process (signal SIGABRT)"),
    "hang": ("timeout", "no end within 15 s"),
    "fill": ("crashed", "out of memory: a cell has 2 GB"),
    "leave": ("crashed", "the engine ended its process (exit code 5)"),
    "throw": ("crashed", "RuntimeError: no luck"),
}


def test_every_fault_is_a_row_with_its_reason(
    start: Callable[..., object], bad_engine: dict[str, str], tmp_path: Path
) -> None:
    folder = tmp_path / "store"
    faults = f"bad.fault={','.join(EXPECTED)}"
    options = ("--engine", "bad", "--set", faults, "--steps-per-turn", "90,180", "--limit-s", 15)
    done = start("sweep", "fourbar-lecture-1", "-o", folder, *options, more=bad_engine)
    out, err = done.communicate(timeout=120)
    assert done.returncode == 0, err
    cells = read_store(folder).cells
    assert len(cells) == 2 * len(EXPECTED)
    cells["fault"] = cells.variant.str.removeprefix("tuned, fault=")
    rows = cells[["fault", "status", "reason"]].itertuples(index=False)
    assert {fault: (status, reason) for fault, status, reason in rows} == EXPECTED
    assert set(cells.fault[cells.us_per_step.notna()]) == {"none"}
    assert "2 timeout, such as" in out


def test_a_child_that_keeps_memory_is_replaced() -> None:
    isolated: Isolated[int] = Isolated(Limits(20.0, 0.4))
    try:
        pids = {isolated.call(hold, 60_000_000) for _ in range(6)}
        assert not any(isinstance(pid, Lost) for pid in pids)
        assert len(pids) > 1
    finally:
        isolated.close()


def test_the_time_limit_is_for_each_job() -> None:
    isolated: Isolated[None] = Isolated(Limits(3.0, 2.0))
    try:
        assert isolated.call(time.sleep, 60.0) == Lost("timeout", "no end within 3 s")
        assert isolated.call(time.sleep, 2.0) is None
        assert isolated.call(time.sleep, 2.0) is None
    finally:
        isolated.close()


def test_a_limit_that_ends_with_the_job_does_not_end_the_next() -> None:
    isolated: Isolated[None] = Isolated(Limits(0.3, 2.0))
    try:
        for _ in range(12):  # answer and limit come together
            isolated.call(time.sleep, 0.2995)
            assert isolated.call(time.sleep, 0.0) is None
    finally:
        isolated.close()


def test_what_stands_in_the_working_folder_is_not_imported(
    start: Callable[..., object], tmp_path: Path
) -> None:
    mine = shadows(tmp_path / "mine")
    (mine / "queue.py").write_text("raise SystemExit('mine')")
    options = ("--engine", "pymunk", "--steps-per-turn", "90", "--no-timing")
    done = start("sweep", "fourbar-lecture-1", "-o", "store", *options, cwd=mine)
    _, err = done.communicate(timeout=60)
    assert done.returncode == 0, err
    assert set(read_store(mine / "store").cells.status) == {"ok"}


def test_a_wider_limit_runs_again_what_was_ended(
    start: Callable[..., object], bad_engine: dict[str, str], tmp_path: Path
) -> None:
    folder = tmp_path / "store"
    faults = ("--engine", "bad", "--set", "bad.fault=none,slow", "--steps-per-turn", "90")
    grid = ("sweep", "fourbar-lecture-1", "-o", folder, "--no-timing", *faults)

    def ran(*more: object) -> str:
        out, err = start(*grid, *more, more=bad_engine).communicate(timeout=120)
        assert not err.startswith("crankcheck"), err
        return str(out.splitlines()[0])

    assert ran("--limit-s", 3).startswith("2 cells: 2 run now, 0 were there")
    assert set(read_store(folder).cells.status) == {"ok", "timeout"}
    assert ran("--limit-s", 3).startswith("2 cells: 0 run now, 2 were there")
    assert ran("--limit-s", 2).startswith("2 cells: 0 run now, 2 were there")
    assert ran("--limit-s", 2, "--again").startswith("2 cells: 1 run now, 1 were there")
    fewer = tuple("bad.fault=none" if part == faults[3] else part for part in faults)
    other = start(
        "sweep", "fourbar-lecture-1", "-o", folder, "--no-timing", *fewer, more=bad_engine
    )
    other.communicate(timeout=120)  # a wider limit, and the cell that was ended is not asked for
    assert other.returncode == 0
    assert len(read_store(folder).cells) == 2
    assert ran("--limit-s", 30).startswith("2 cells: 1 run now, 1 were there")
    assert list(read_store(folder).cells.status) == ["ok", "ok"]


def test_a_closed_one_starts_nothing() -> None:
    isolated: Isolated[None] = Isolated(Limits())
    isolated.close()
    assert isolated.call(time.sleep, 0.0) == Lost("crashed", "the sweep was ended")


_held: list[bytearray] = []


def hold(size: int) -> int:
    """Keep some memory, and tell in which process."""
    import os

    _held.append(bytearray(size))
    return os.getpid()


@pytest.fixture(autouse=True)
def importable(monkeypatch: pytest.MonkeyPatch) -> None:
    """The child imports this file's functions by the name that pytest gave it."""
    monkeypatch.syspath_prepend(Path(__file__).parents[3])
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parents[3]))
