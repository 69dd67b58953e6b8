"""On a real Dask cluster: a scheduler and two workers, started from the command line."""

from __future__ import annotations

import socket
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import pandas as pd
import pytest

from reports.store.reader import read_store
from tests.worlds.command import PYTHON

GRID = ("fourbar-lecture-1", "slotted-lever", "--steps-per-turn", "90,180", "--no-timing")
BY_CHANCE = {"wall_s", "logged_us_per_step", "run_on"}
Start = Callable[..., "subprocess.Popen[str]"]


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """The address of a scheduler with two workers."""
    pytest.importorskip("distributed", reason="pip install 'crankcheck[dask]'")
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        address = f"tcp://127.0.0.1:{probe.getsockname()[1]}"
    folder = tmp_path_factory.mktemp("cluster")
    scheduler = dask("scheduler", "--host", "127.0.0.1", "--port", address.rpartition(":")[2])
    workers = [
        dask("worker", address, "--nthreads", "1", "--local-directory", str(folder))
        for _ in range(2)
    ]
    wait = f"import distributed; distributed.Client({address!r}).wait_for_workers(2, 60)"
    try:
        subprocess.run([PYTHON, "-W", "ignore", "-c", wait], check=True, timeout=120)
        yield address
    finally:
        for process in (*workers, scheduler):
            process.terminate()
        for process in (*workers, scheduler):
            process.wait(timeout=30)


def dask(*arguments: str) -> subprocess.Popen[bytes]:
    """A part of a cluster, as a user starts it."""
    return subprocess.Popen(
        [PYTHON, "-P", "-m", "dask", *arguments, "--no-dashboard"],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )


def test_a_cluster_gives_the_same_rows_bit_by_bit(
    start: Start, cluster: str, tmp_path: Path
) -> None:
    stores = []
    for name, more in (("here", ()), ("there", ("--dask", cluster))):
        done = start("sweep", *GRID, "-o", tmp_path / name, *more)
        _, err = done.communicate(timeout=120)
        assert done.returncode == 0, err
        assert "Traceback" not in err
        stores.append(read_store(tmp_path / name).cells.set_index("key").sort_index())
    here, there = stores
    assert len(here) == 2 * 8 * 2
    assert set(here.run_on) == {"local"}
    assert set(there.run_on) == {"cluster"}
    names = [name for name in here.columns if name not in BY_CHANCE]
    pd.testing.assert_frame_equal(here[names], there[names], check_exact=True)


def test_no_scheduler_is_said_in_one_line(start: Start, tmp_path: Path) -> None:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        address = f"tcp://127.0.0.1:{probe.getsockname()[1]}"
    done = start("sweep", *GRID, "-o", tmp_path / "x", "--dask", address)
    _, err = done.communicate(timeout=60)
    assert done.returncode == 2
    assert "no scheduler answers there" in err
    assert "Traceback" not in err
