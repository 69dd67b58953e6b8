"""On a Dask cluster: one that is made up, and a real one started from the command line."""

from __future__ import annotations

import re
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pandas as pd
import pytest

from models.errors import CrankcheckError
from models.scene import Scene
from reports.judge.cell import Cell
from reports.store.reader import read_store
from reports.sweep import measured as clusters
from reports.sweep.measured import measured
from reports.workers.isolated import Limits
from tests.worlds.command import COMMAND, PYTHON
from tests.worlds.command_line import crank
from tests.worlds.in_process import Here
from tests.worlds.programs import Start, programs
from tests.worlds.tiers import slow

GRID = ("fourbar-lecture-1", "slotted-lever", "--steps-per-turn", "90,180", "--no-timing")
BY_CHANCE = {"wall_s", "logged_us_per_step", "run_on"}


@dataclass(eq=False)
class Cluster:
    """Does all at once in this thread; results come last first."""

    workers: Sequence[str] = ("one",)
    closed: bool = False

    def scheduler_info(self) -> dict[str, object]:
        return {"workers": self.workers}

    def map(self, function: Callable[[Cell], object], cells: Sequence[Cell], pure: bool) -> object:
        assert not pure
        found = enumerate(map(function, cells))
        return [SimpleNamespace(key=number, result=each) for number, each in found]

    def close(self) -> None:
        self.closed = True


def as_completed(futures: Any, with_results: bool) -> Iterator[tuple[object, object]]:
    assert with_results
    return iter([(each, each.result) for each in reversed(futures)])


def dask(monkeypatch: pytest.MonkeyPatch, cluster: Cluster, error: Exception | None = None) -> None:
    """Whoever asks Dask for a cluster gets this one, or an error."""

    def client(address: str, timeout: float) -> Cluster:
        assert (address, timeout) == ("tcp://there:1", clusters.ANSWER_S)
        if error is not None:
            raise error
        return cluster

    module = SimpleNamespace(Client=client, as_completed=as_completed)
    monkeypatch.setitem(sys.modules, "distributed", module)


def test_outcomes_come_as_they_end_from_a_child_of_each_limit(
    monkeypatch: pytest.MonkeyPatch, fourbar: Scene
) -> None:
    children: list[Child] = []

    class Child(Here[object]):
        def __init__(self, limits: Limits) -> None:
            super().__init__(limits)
            children.append(self)

        def call(self, function: Callable[..., object], *arguments: object) -> object:
            return (function, *arguments)

    cluster = Cluster()
    dask(monkeypatch, cluster)
    monkeypatch.setattr(clusters, "Isolated", Child)
    cells = [Cell(fourbar, "pymunk", "tuned", 0.01, steps) for steps in (20, 30, 40)]
    for limits, keep in ((Limits(7.0), True), (Limits(7.0), False), (Limits(8.0), False)):
        client = clusters.connected("tcp://there:1")
        ended = clusters.on_cluster(client, cells, limits, keep)
        assert [next(ended)] == [(2, (measured, cells[2], keep))]
        assert not cluster.closed
        assert list(ended) == [(n, (measured, cells[n], keep)) for n in (1, 0)]
        assert cluster.closed
        cluster.closed = False
    assert [(child.limits.time_s, child.closed) for child in children] == [(7, True), (8, False)]


def test_no_cluster_is_said_in_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    for cluster, error, words in (
        (Cluster(), OSError("no way"), r"there:1: no scheduler answers there \(no way\); start"),
        (Cluster(workers=()), None, "there:1: no workers; start some with `dask worker tcp:"),
    ):
        dask(monkeypatch, cluster, error)
        with pytest.raises(CrankcheckError, match=f"^--dask tcp://{words}"):
            clusters.connected("tcp://there:1")
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(CrankcheckError, match=r"^--dask: distributed is not installed; pip"):
        clusters.connected("tcp://there:1")


MISSING = {"version": None, "status": "unsupported", "reason": "engine pymunk: not installed"}


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({}, ""),
        ({"version": "0.1"}, "a worker has pymunk 0.1, here it is "),
        ({"crankcheck": "0.1"}, "a worker has crankcheck 0.1, here it is "),
        (MISSING, r"a worker has no pymunk; install pymunk==\d"),
    ],
)
def test_workers_with_other_packages_are_refused(
    change: dict[str, Any], words: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def there(_: object, cells: Sequence[Cell], *__: object) -> Iterator[tuple[int, object]]:
        found = measured(cells[0], False)
        row = {k: change.get(k, v) for k, v in found.row.items()}
        yield 0, replace(found, row=row, crankcheck=change.get("crankcheck", found.crankcheck))

    dask(monkeypatch, Cluster())
    monkeypatch.setattr("reports.sweep.measured.on_cluster", there)
    options = ("--engine", "pymunk", "--profile", "tuned", "--no-timing", "-o", str(tmp_path / "s"))
    done = crank("sweep", GRID[0], "--steps-per-turn", "90", "--dask", "tcp://there:1", *options)
    assert done.exit_code == (2 if words else 0)
    assert re.search(words, " ".join(done.output.split()))
    if not words:
        assert list(read_store(tmp_path / "s").cells.run_on) == ["cluster"]


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    pytest.importorskip("distributed", reason="pip install 'crankcheck[dask]'")
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        address = f"tcp://127.0.0.1:{probe.getsockname()[1]}"
    folder = tmp_path_factory.mktemp("cluster")
    wait = f"import distributed; distributed.Client({address!r}).wait_for_workers(2, 600)"
    worker = ("worker", address, "--nthreads", "1", "--local-directory", str(folder))
    scheduler = ("scheduler", "--host", "127.0.0.1", "--port", address.rpartition(":")[2])
    with programs() as start:
        for each in (scheduler, worker, worker):
            command = (PYTHON, "-P", "-m", "dask", *each, "--no-dashboard")
            start(*command, output=subprocess.DEVNULL)
        subprocess.run([PYTHON, "-W", "ignore", "-c", wait], check=True)
        yield address


@slow("a real scheduler and workers, six processes: `make test` holds our side of it to a fake")
def test_a_cluster_gives_the_very_same_rows(programs: Start, address: str, tmp_path: Path) -> None:
    stores = []
    for name, more in (("here", ()), ("there", ("--dask", address))):
        done = programs(COMMAND, "sweep", *GRID, "-o", tmp_path / name, *more)
        _, err = done.communicate()
        assert done.returncode == 0, err
        assert "Traceback" not in err
        stores.append(read_store(tmp_path / name).cells.set_index("key").sort_index())
    here, there = stores
    assert len(here) == 2 * 8 * 2
    assert ({*here.run_on}, {*there.run_on}) == ({"local"}, {"cluster"})
    names = [name for name in here.columns if name not in BY_CHANCE]
    pd.testing.assert_frame_equal(here[names], there[names], check_exact=True)
