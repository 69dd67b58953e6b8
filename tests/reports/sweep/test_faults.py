"""An engine that crashes, hangs or fills memory costs its own cell alone."""

from __future__ import annotations

from collections.abc import Callable
from io import StringIO
from pathlib import Path
from typing import TypeVar

import pytest
from rich.console import Console

from reports.cli.commands.sweep import sweep
from reports.cli.measuring import SweepRequest
from reports.judge.cell import Cell
from reports.store.reader import read_store
from reports.workers.isolated import Isolated, Lost
from tests.worlds.command import shadows
from tests.worlds.in_process import Here

EXPECTED = {
    "none": ("ok", ""),
    "abort": ("crashed", "the engine ended its process (signal SIGABRT)"),
    "hang": ("timeout", "no end within 1 s"),
    "fill": ("crashed", "out of memory: a cell has 2 GB"),
    "leave": ("crashed", "the engine ended its process (exit code 5)"),
    "throw": ("crashed", "RuntimeError: no luck"),
}
LIMIT_S = 600.0
Answer = TypeVar("Answer")


def swept(
    folder: Path,
    *faults: str,
    engine: str = "bad",
    limit_s: float = LIMIT_S,
    timing: bool = False,
    again: bool = False,
) -> str:
    """The output of a sweep of an engine, the bad one over some faults, with one child."""
    output = StringIO()
    request = SweepRequest(
        folder,
        scenes=["fourbar-lecture-1"],
        engines=[engine],
        profiles=["tuned"],
        steps_per_turn="90",
        settings=[f"bad.fault={','.join(faults)}"] * bool(faults),
        jobs=1,
        limit_s=limit_s,
        timing=timing,
        again=again,
    )
    assert sweep(request, Console(file=output, width=100), Console(file=StringIO())) == 0
    return output.getvalue()


@pytest.mark.usefixtures("_bad_engine")
def test_every_fault_is_a_row_with_its_reason(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "store"
    monkeypatch.setattr("reports.sweep.running.Isolated", Here)  # of timing
    monkeypatch.setattr("reports.sweep.measured.REPEAT_S", 1e-3)
    swept(folder, *(fault for fault in EXPECTED if fault != "hang"), timing=True)
    told = swept(folder, "hang", limit_s=1.0)  # where no other cell has to be done in that time
    cells = read_store(folder).cells
    assert len(cells) == len(EXPECTED)
    cells["fault"] = cells.variant.str.removeprefix("tuned, fault=")
    rows = cells[["fault", "status", "reason"]].itertuples(index=False)
    assert {fault: (status, reason) for fault, status, reason in rows} == EXPECTED
    assert set(cells.fault[cells.us_per_step.notna()]) == {"none"}
    assert "1 timeout, such as" in told


def test_what_stands_in_the_working_folder_is_not_imported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mine = shadows(tmp_path / "mine")
    (mine / "queue.py").write_text("raise SystemExit('mine')")
    monkeypatch.chdir(mine)
    swept(Path("store"), engine="pymunk")
    assert set(read_store(mine / "store").cells.status) == {"ok"}


class Watched(Isolated[Answer]):
    """Works in this process, where a slow engine takes five seconds of no clock."""

    def call(self, function: Callable[..., Answer], *arguments: object) -> Answer | Lost:
        cell = arguments[0]
        assert isinstance(cell, Cell)
        if cell.settings["fault"] == "slow" and self.limits.time_s < 5.0:
            return Lost("timeout", f"no end within {self.limits.time_s:g} s")
        return function(*arguments)


@pytest.mark.usefixtures("_bad_engine")
def test_a_wider_limit_runs_again_what_was_ended(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("reports.workers.scheduler.Isolated", Watched)
    folder = tmp_path / "store"

    def ran(limit_s: float, *faults: str, again: bool = False) -> str:
        faults = faults or ("none", "slow")
        return swept(folder, *faults, limit_s=limit_s, again=again).splitlines()[0]

    assert ran(3.0).startswith("2 cells: 2 run now, 0 were there")
    assert set(read_store(folder).cells.status) == {"ok", "timeout"}
    assert ran(3.0).startswith("2 cells: 0 run now, 2 were there")
    assert ran(2.0).startswith("2 cells: 0 run now, 2 were there")
    assert ran(2.0, again=True).startswith("2 cells: 1 run now, 1 were there")
    ran(600.0, "none")  # a wider limit, and the cell that was ended is not asked for
    assert len(read_store(folder).cells) == 2
    assert ran(300.0).startswith("2 cells: 1 run now, 1 were there")
    assert list(read_store(folder).cells.status) == ["ok", "ok"]
