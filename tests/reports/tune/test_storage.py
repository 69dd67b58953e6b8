"""The file that a search is kept in: only the one that is asked for is gone on with."""

from __future__ import annotations

import contextlib
import os
import sqlite3
import sys
from collections.abc import Callable
from pathlib import Path

import optuna
import pytest

from models.errors import CrankcheckError
from reports.tune.storage import check_storage, study_in
from tests.worlds.tiers import few

ASKED = {"engine": "mujoco", "target": 1e-6, "profile": {"iterations": 2}}


def test_a_study_is_gone_on_with_where_all_is_as_before(path: Path) -> None:
    check_storage(path)
    with study_in(path, ASKED) as study:
        study.add_trial(optuna.create_trial(value=1.0))
    check_storage(path)
    with study_in(path, ASKED) as study:
        assert len(study.trials) == 1
    assert sorted(each.name for each in path.parent.iterdir()) == [".kept.db.lock", "kept.db"]


def test_another_search_is_refused_and_what_differs_is_named(path: Path) -> None:
    with study_in(path, ASKED):
        pass
    for name, value, words in (
        ("target", 1e-4, "holds a search with target 1e-06; asked was target 0.0001"),
        ("engine", "pymunk", "holds a search with engine mujoco; asked was engine pymunk"),
        ("profile", {"iterations": 3}, 'with profile {"iterations": 2}; asked was profile {"it'),
    ):
        with pytest.raises(CrankcheckError, match=words), study_in(path, {**ASKED, name: value}):
            pass


NAMES = ("a b.db", "100%.db", "what?.db", "a#b.sqlite", "é.db")


@pytest.mark.parametrize("name", few(NAMES, {"100%.db", "what?.db"}, "two kinds of quoting"))
def test_any_name_of_a_file_is_that_of_the_file(tmp_path: Path, name: str) -> None:
    with study_in(tmp_path / name, ASKED):
        pass
    assert sorted(each.name for each in tmp_path.iterdir()) == [f".{name}.lock", name]


def notes(path: Path) -> None:
    path.write_text("my notes", encoding="utf-8")


def shop(path: Path) -> None:
    """A database of something else."""
    with contextlib.closing(sqlite3.connect(path)) as base:
        base.execute("CREATE TABLE orders (number INTEGER)")
        base.commit()


def theirs(path: Path) -> None:
    optuna.create_study(storage=f"sqlite:///{path}", study_name="theirs")


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (notes, "holds something else; name a new file"),
        (shop, "holds something else; name a new file"),
        (theirs, "Optuna file with the study 'theirs'"),
        (os.mkfifo, "no plain file; name a new file"),  # and it is not waited for
    ],
)
def test_something_else_is_refused_and_left_alone(
    make: Callable[[Path], None], words: str, path: Path
) -> None:
    make(path)
    before = path.read_bytes() if path.is_file() else None
    with pytest.raises(CrankcheckError, match=words):
        check_storage(path)
    assert (path.read_bytes() if path.is_file() else None) == before


def test_an_empty_file_is_taken_and_one_of_another_ending_is_not(path: Path) -> None:
    path.touch()
    check_storage(path)
    with study_in(path, ASKED) as study:
        assert study.trials == []
    with pytest.raises(CrankcheckError, match=r"found '\.txt'; use \.db"):
        check_storage(path.with_suffix(".txt"))


def test_two_searches_can_not_write_to_one_file(path: Path) -> None:
    writes = "another search writes there now"
    with study_in(path, ASKED), pytest.raises(CrankcheckError, match=writes):
        study_in(path, ASKED).__enter__()


@pytest.mark.skipif(sys.platform == "win32", reason="no file that is open is removed there")
def test_a_search_that_comes_as_another_ends_locks_out_a_third(path: Path) -> None:
    """The second has opened the file of the lock while the first held it; the third comes late."""
    import fcntl

    with study_in(path, ASKED):
        second = path.with_name(".kept.db.lock").open("ab")
    with second:
        fcntl.flock(second, fcntl.LOCK_EX | fcntl.LOCK_NB)
        writes = "another search writes there now"
        with pytest.raises(CrankcheckError, match=writes), study_in(path, ASKED):
            pass


def test_a_file_that_can_no_more_be_written_is_told_without_a_traceback(path: Path) -> None:

    def broken() -> None:
        with study_in(path, ASKED) as study, contextlib.closing(sqlite3.connect(path)) as base:
            base.execute("DROP TABLE trials")
            base.commit()
            study.ask()

    with pytest.raises(CrankcheckError, match=r"-o .*kept\.db: .*name another file"):
        broken()
