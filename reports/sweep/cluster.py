"""Error runs of many cells on a Dask cluster, in place of this machine."""

from __future__ import annotations

import threading
from collections.abc import Generator, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING

from models.errors import CrankcheckError
from reports.judge.cell import Cell
from reports.sweep.measured import MeasuredCell, measured
from reports.workers.isolated import Isolated, Limits, Lost
from sim.own_engine.known import spellings, told

if TYPE_CHECKING:
    from distributed import Client

ANSWER_S = 5.0
"""How long a scheduler may take to answer."""
_own = threading.local()


def connected(address: str) -> Client:
    """A cluster, at the address of its scheduler.

    Raises
    ------
    CrankcheckError
        No cluster at the address, one without workers, or no Dask here.
    """
    try:
        from distributed import Client
    except ImportError:
        raise CrankcheckError(
            "--dask: distributed is not installed; pip install 'crankcheck[dask]'"
        ) from None
    try:
        client = Client(address, timeout=ANSWER_S)  # type: ignore[no-untyped-call]  # not annotated
    except (OSError, ValueError) as error:
        raise CrankcheckError(
            f"--dask {address}: no scheduler answers there ({error}); start one with "
            "`dask scheduler` and workers with `dask worker ADDRESS`"
        ) from None
    if not client.scheduler_info()["workers"]:
        raise CrankcheckError(
            f"--dask {address}: no workers; start some with `dask worker {address}`"
        )
    return client


def on_cluster(
    client: Client, cells: Sequence[Cell], limits: Limits, keep_run: bool
) -> Generator[tuple[int, MeasuredCell | Lost]]:
    """As `measured` of every cell, each in a child process of the Dask worker that has it; yields
    index and outcome of each as it ends. The client is closed when this is."""
    from distributed import as_completed

    try:
        there = partial(_there, limits=limits, keep_run=keep_run, own_engines=spellings())
        futures = client.map(there, cells, pure=False)
        indices = {future.key: index for index, future in enumerate(futures)}
        ended = as_completed(futures, with_results=True)  # type: ignore[no-untyped-call]
        del futures  # a cluster keeps a result as long as somebody has its future
        for future, outcome in ended:
            yield indices[future.key], outcome
    finally:
        client.close()  # type: ignore[no-untyped-call]  # not annotated


def _there(
    cell: Cell, limits: Limits, keep_run: bool, own_engines: Mapping[str, str]
) -> MeasuredCell | Lost:
    """One cell in the child process of this thread of a Dask worker."""
    told(own_engines)
    child: Isolated[MeasuredCell] | None = getattr(_own, "child", None)
    if child is not None and child.limits != limits:
        child.close()
        child = None
    if child is None:
        child = _own.child = Isolated(limits)
    return child.call(measured, cell, keep_run)
