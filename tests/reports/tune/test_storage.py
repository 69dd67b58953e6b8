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


def test_a_study_is_gone_on_with_where_all_is_as_before(tmp_path: Path) -> None:
    path = tmp_path / "kept.db"
    check_storage(path)
    with study_in(path, ASKED) as study:
        study.add_trial(optuna.create_trial(value=1.0))
    check_storage(path)
    with study_in(path, ASKED) as study:
        assert len(study.trials) == 1
    assert sorted(each.name for each in tmp_path.iterdir()) == [".kept.db.lock", "kept.db"]


def test_another_search_is_refused_and_what_differs_is_named(tmp_path: Path) -> None:
    path = tmp_path / "kept.db"
    with study_in(path, ASKED):
        pass
    for name, value, words in (
        ("target", 1e-4, "holds a search with target 1e-06; asked was target 0.0001"),
        ("engine", "pymunk", "holds a search with engine mujoco; asked was engine pymunk"),
        ("profile", {"iterations": 3}, 'with profile {"iterations": 2}; asked was profile {"it'),
    ):
        with pytest.raises(CrankcheckError, match=words), study_in(path, {**ASKED, name: value}):
            pass


@pytest.mark.parametrize(
    "name",
    few(
        ("a b.db", "100%.db", "what?.db", "a#b.sqlite", "é.db"),
        {"100%.db", "what?.db"},
        "two kinds of quoting show it",
    ),
)
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


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (notes, "holds something else; name a new file"),
        (shop, "holds something else; name a new file"),
        (os.mkfifo, "no plain file; name a new file"),  # and it is not waited for
    ],
)
def test_something_else_is_refused_and_left_alone(
    make: Callable[[Path], None], words: str, tmp_path: Path
) -> None:
    path = tmp_path / "kept.db"
    make(path)
    before = path.read_bytes() if path.is_file() else None
    with pytest.raises(CrankcheckError, match=words):
        check_storage(path)
    assert (path.read_bytes() if path.is_file() else None) == before


def test_a_study_of_somebody_else_is_refused_by_its_name(tmp_path: Path) -> None:
    path = tmp_path / "theirs.db"
    optuna.create_study(storage=f"sqlite:///{path}", study_name="theirs")
    with pytest.raises(CrankcheckError, match="Optuna file with the study 'theirs'"):
        check_storage(path)


def test_an_empty_file_is_taken(tmp_path: Path) -> None:
    path = tmp_path / "new.db"
    path.touch()
    check_storage(path)
    with study_in(path, ASKED) as study:
        assert study.trials == []


def test_a_file_of_another_ending_is_refused(tmp_path: Path) -> None:
    with pytest.raises(CrankcheckError, match=r"found '\.txt'; use \.db"):
        check_storage(tmp_path / "kept.txt")


def test_two_searches_can_not_write_to_one_file(tmp_path: Path) -> None:
    path = tmp_path / "kept.db"
    with (
        study_in(path, ASKED),
        pytest.raises(CrankcheckError, match="another search writes there now"),
        study_in(path, ASKED),
    ):
        pass


@pytest.mark.skipif(sys.platform == "win32", reason="no file that is open is removed there")
def test_a_search_that_comes_as_another_ends_locks_out_a_third(tmp_path: Path) -> None:
    """The second has opened the file of the lock while the first held it; the third comes late."""
    import fcntl

    path = tmp_path / "kept.db"
    with study_in(path, ASKED):
        second = (tmp_path / ".kept.db.lock").open("ab")
    with second:
        fcntl.flock(second, fcntl.LOCK_EX | fcntl.LOCK_NB)
        with (
            pytest.raises(CrankcheckError, match="another search writes there now"),
            study_in(path, ASKED),
        ):
            pass


def test_a_file_that_can_no_more_be_written_is_told_without_a_traceback(tmp_path: Path) -> None:
    path = tmp_path / "kept.db"

    def broken() -> None:
        with study_in(path, ASKED) as study, contextlib.closing(sqlite3.connect(path)) as base:
            base.execute("DROP TABLE trials")
            base.commit()
            study.ask()

    with pytest.raises(CrankcheckError, match=r"-o .*kept\.db: .*name another file"):
        broken()
