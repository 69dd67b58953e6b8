"""On a real Dask cluster: a scheduler and two workers, started from the command line."""

from __future__ import annotations

import socket
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pandas as pd
import pytest

from models.errors import CrankcheckError
from reports.store.reader import read_store
from reports.sweep import cluster as clusters
from tests.worlds.command import PYTHON
from tests.worlds.programs import Start, programs

GRID = ("fourbar-lecture-1", "slotted-lever", "--steps-per-turn", "90,180", "--no-timing")
BY_CHANCE = {"wall_s", "logged_us_per_step", "run_on"}


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """The address of a scheduler with two workers."""
    pytest.importorskip("distributed", reason="pip install 'crankcheck[dask]'")
    address = nowhere()
    port = address.rpartition(":")[2]
    folder = tmp_path_factory.mktemp("cluster")
    wait = f"import distributed; distributed.Client({address!r}).wait_for_workers(2, 60)"
    with programs() as start:

        def dask(*arguments: str) -> None:
            command = (PYTHON, "-P", "-m", "dask", *arguments, "--no-dashboard")
            start(*command, output=subprocess.DEVNULL)

        dask("scheduler", "--host", "127.0.0.1", "--port", port)
        for _ in range(2):
            dask("worker", address, "--nthreads", "1", "--local-directory", str(folder))
        subprocess.run([PYTHON, "-W", "ignore", "-c", wait], check=True, timeout=120)
        yield address


def nowhere() -> str:
    """An address at which nobody listens."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return f"tcp://127.0.0.1:{probe.getsockname()[1]}"


def test_a_cluster_gives_the_same_rows_bit_by_bit(
    start: Start, cluster: str, tmp_path: Path
) -> None:
    stores = []
    for name, more in (("here", ()), ("there", ("--dask", cluster))):
        done = start("sweep", *GRID, "-o", tmp_path / name, *more)
        _, err = done.communicate(timeout=300)
        assert done.returncode == 0, err
        assert "Traceback" not in err
        stores.append(read_store(tmp_path / name).cells.set_index("key").sort_index())
    here, there = stores
    assert len(here) == 2 * 8 * 2
    assert set(here.run_on) == {"local"}
    assert set(there.run_on) == {"cluster"}
    names = [name for name in here.columns if name not in BY_CHANCE]
    pd.testing.assert_frame_equal(here[names], there[names], check_exact=True)


def test_no_scheduler_is_said_in_one_line(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(clusters, "ANSWER_S", 0.3)
    with pytest.raises(CrankcheckError, match="no scheduler answers there") as caught:
        clusters.connected(nowhere())
    assert "\n" not in str(caught.value)
    assert capfd.readouterr() == ("", "")
