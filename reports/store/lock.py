"""The lock of a store: one sweep at a time writes to it, and a reader can see whether one does.

To see it is to take the lock for a moment, so each side has patience: a sweep waits longer for it
than any reader holds it, and a reader longer than another reader does.
"""

from __future__ import annotations

import os
from pathlib import Path

from filelock import FileLock, Timeout

from models.errors import CrankcheckError
from reports.store.schema import LOCK

SWEEP_S, READER_S = 0.5, 0.05
"""How long each side tries; a reader holds the lock for less than a millisecond."""
POLL_S = 0.01


def locked(folder: Path) -> FileLock:
    """The lock of a store, taken for a sweep into a folder that is there.

    Raises
    ------
    CrankcheckError
        Another sweep has it, or it is no file that can be locked.
    """
    lock = FileLock(folder / LOCK, timeout=SWEEP_S)
    try:
        lock.acquire(poll_interval=POLL_S)
    except Timeout:
        raise CrankcheckError(
            f"-o {folder}: another sweep writes there now; wait for it, or choose another"
        ) from None
    except OSError as error:
        raise CrankcheckError(
            f"-o {folder}: {LOCK} can not be locked: {error.strerror or error}; remove it, or "
            "choose another place"
        ) from None
    return lock


def is_written(folder: Path) -> bool:
    """Whether a sweep writes to a store now; not where its lock can not be tried, as without the
    right to write there. Makes no file."""
    if not os.path.lexists(folder / LOCK):
        return False
    lock = FileLock(folder / LOCK, timeout=READER_S)
    try:
        lock.acquire(poll_interval=POLL_S)
    except Timeout:
        return True
    except OSError:
        return False
    lock.release()
    return False
