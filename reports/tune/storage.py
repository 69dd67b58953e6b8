"""A search kept in a file, so that it can go on later: an Optuna study in SQLite, made sure to be
the one that is asked for."""

from __future__ import annotations

import contextlib
import json
import sqlite3
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

import optuna
from filelock import FileLock, Timeout
from optuna.exceptions import StorageInternalError
from optuna.storages import BaseStorage, InMemoryStorage, RDBStorage
from optuna.study import Study
from optuna.trial import TrialState
from sqlalchemy import URL
from sqlalchemy.exc import SQLAlchemyError

from models.errors import CrankcheckError, cut
from reports.output.write import check_file

NAME = "crankcheck tune"
ASKED = "asked"
ENDINGS = (".db", ".sqlite", ".sqlite3")
MAGIC = b"SQLite format 3\0"
Asked = Mapping[str, object]


def check_storage(path: Path) -> None:
    """Refuse a file that no search can be kept in, before anything runs. Raises CrankcheckError."""
    check_file(path, "-o", ENDINGS)
    if not path.exists():
        return
    if not path.is_file():  # a pipe would be waited for
        raise CrankcheckError(f"-o {path}: no plain file; name a new file")
    if path.stat().st_size == 0:
        return
    names = _names(path)
    if names is None:
        raise CrankcheckError(f"-o {path}: holds something else; name a new file")
    if names not in ([], [NAME]):
        raise CrankcheckError(
            f"-o {path}: an Optuna file with the study {names[0]!r}, which is not of crankcheck "
            "tune; name a new file"
        )


def _names(path: Path) -> list[str] | None:
    """The studies in a file of Optuna; None for any other."""
    try:
        with path.open("rb") as file:
            if file.read(len(MAGIC)) != MAGIC:
                return None
        with contextlib.closing(sqlite3.connect(path)) as base:
            tables = {row[0] for row in base.execute("SELECT name FROM sqlite_master")}
            if not tables:
                return []
            if "studies" not in tables:
                return None
            return [row[0] for row in base.execute("SELECT study_name FROM studies")]
    except (OSError, sqlite3.Error):
        return None


@contextmanager
def study_in(path: Path | None, asked: Asked) -> Iterator[Study]:
    """The study of a file, new or to be gone on with; in memory for None.

    Trials that were cut short are marked as failed: they count for nothing.

    Raises
    ------
    CrankcheckError
        The file holds a search for something else, another search writes to it now, or it can not
        be written.
    """
    optuna.logging.set_verbosity(optuna.logging.ERROR)
    optuna.logging.disable_default_handler()
    try:
        with _locked(path):
            yield _opened(path, asked)
    except (StorageInternalError, SQLAlchemyError) as error:
        why = " ".join(str(error.__cause__ or error).split())[:200]
        raise CrankcheckError(f"-o {path}: {why}; name another file") from None


@contextmanager
def _locked(path: Path | None) -> Iterator[None]:
    """The block is done by one search at a time. The file of the lock stays: removed, it would let
    one search lock the old file, one a new. Raises CrankcheckError."""
    if path is None:
        yield
        return
    lock = FileLock(path.with_name(f".{path.name}.lock"), timeout=0)
    try:
        lock.acquire()
    except Timeout:
        raise CrankcheckError(
            f"-o {path}: another search writes there now; wait for it, or choose another"
        ) from None
    except OSError as error:
        raise CrankcheckError(
            f"-o {path}: {lock.lock_file} can not be locked: {error.strerror or error}; remove it, "
            "or choose another place"
        ) from None
    try:
        yield
    finally:
        lock.release()


def _opened(path: Path | None, asked: Asked) -> Study:
    """The study, with what it is for written down or compared."""
    try:
        storage = _storage(path)
    except RuntimeError as error:  # of another version of Optuna
        raise CrankcheckError(f"-o {path}: {error}; name another file") from None
    study = optuna.create_study(
        storage=storage, study_name=NAME, load_if_exists=True, direction="minimize"
    )
    earlier = study.user_attrs.get(ASKED)
    if earlier is None:
        study.set_user_attr(ASKED, dict(asked))
    elif path is not None:
        _refuse_other(path, earlier, json.loads(json.dumps(asked)))
    for trial in study.get_trials(deepcopy=False, states=(TrialState.RUNNING,)):
        study.tell(trial.number, state=TrialState.FAIL)
    return study


def _storage(path: Path | None) -> BaseStorage:
    if path is None:
        return InMemoryStorage()
    url = URL.create("sqlite", database=str(path.resolve()))
    return RDBStorage(url.render_as_string(hide_password=False))


def _refuse_other(path: Path, earlier: Asked, asked: Asked) -> None:
    """Refuse to go on with a search for something else, and say what differs."""
    for name in asked:
        if earlier.get(name) != asked[name]:
            was, now = _short(earlier.get(name)), _short(asked[name])
            raise CrankcheckError(
                f"-o {path}: holds a search with {name} {was}; asked was {name} {now}: name "
                f"another file, or ask as before"
            )


def _short(value: object) -> str:
    """A value of a request in a line."""
    return cut(value if isinstance(value, str) else json.dumps(value))
