"""Error runs of many cells at a time, through joblib: here, or on a Dask cluster."""

from __future__ import annotations

import threading
from collections.abc import Generator, Mapping, Sequence
from typing import cast

from joblib import Parallel, delayed, parallel_config  # type: ignore[import-untyped]  # no stubs

from models.errors import CrankcheckError
from reports.plan.grid import Task
from reports.sweep.measured import Outcome, measured
from reports.workers.isolated import Isolated, Limits, Lost
from reports.workers.pool import processors

_own = threading.local()
_all: list[Isolated[Outcome]] = []
Found = tuple[int, Outcome | Lost]
Backend = Mapping[str, object]


def run_all(
    tasks: Sequence[Task], limits: Limits, keep_motion: bool, where: Backend
) -> Generator[Found]:
    """Run every task; yields index and outcome of each, in the order in which they end.

    Each cell runs in a child process of the joblib worker that has it: a joblib worker here is a
    thread that waits for its child, on a cluster a thread of a Dask worker.

    Parameters
    ----------
    where : Backend
        What `backend` gave.
    """
    work = (delayed(_one)(i, task, limits, keep_motion) for i, task in enumerate(tasks))
    try:
        with parallel_config(**where):
            yield from Parallel(return_as="generator_unordered", batch_size=1)(work)
    finally:
        for isolated in _all:
            isolated.close()
        _all.clear()
        if where["backend"] == "dask":
            from distributed import default_client

            default_client().close()  # type: ignore[no-untyped-call]  # not annotated


def backend(jobs: int, dask: str | None) -> Backend:
    """What joblib is told: cells at a time on this machine (0: one per processor), or the
    scheduler of a cluster to use in its place.

    Raises
    ------
    CrankcheckError
        No cluster at the address, one without workers, or no Dask here.
    """
    if dask is None:
        return {"backend": "threading", "n_jobs": jobs or processors()}
    try:
        from distributed import Client
    except ImportError:
        raise CrankcheckError(
            "--dask: distributed is not installed; pip install 'crankcheck[dask]'"
        ) from None
    try:
        client = Client(dask, timeout="5s")  # type: ignore[no-untyped-call]  # not annotated
    except (OSError, ValueError) as error:
        raise CrankcheckError(
            f"--dask {dask}: no scheduler answers there ({error}); start one with `dask scheduler` "
            "and workers with `dask worker ADDRESS`"
        ) from None
    if not client.scheduler_info()["workers"]:
        raise CrankcheckError(f"--dask {dask}: no workers; start some with `dask worker {dask}`")
    return {"backend": "dask", "n_jobs": -1}


def _one(index: int, task: Task, limits: Limits, keep_motion: bool) -> Found:
    """One cell in the child process of this thread."""
    isolated = cast("Isolated[Outcome] | None", getattr(_own, "isolated", None))
    if isolated is not None and isolated.limits != limits:
        isolated.close()
    if isolated is None or isolated.closed:
        isolated = _own.isolated = Isolated(limits)
        _all.append(isolated)
    return index, isolated.call(measured, task.cell, keep_motion)
