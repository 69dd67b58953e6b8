"""Fixtures for all tests."""

import functools
import gc
from collections.abc import Iterator
from types import ModuleType

import pytest
import typer.testing

from tests.worlds.fake import engine
from tests.worlds.programs import Start, hear_signals
from tests.worlds.programs import programs as started

OBJECTS_BETWEEN_COLLECTIONS = 100_000
"""Of the collector's first generation, not the 700 of Python: imports and oracles of fifty digits
make objects by the million and hardly a cycle, and collecting took a tenth of all time."""


def pytest_configure() -> None:
    gc.set_threshold(OBJECTS_BETWEEN_COLLECTIONS)
    hear_signals()
    # A runner builds all commands anew for each line that it is given, which takes 10 ms; the
    # commands hold nothing of what they were called with.
    typer.testing._get_command = functools.cache(typer.testing._get_command)


@pytest.fixture
def programs() -> Iterator[Start]:
    with started() as start:
        yield start


@pytest.fixture(scope="session")
def fake_engine() -> ModuleType:
    """The module `tests.worlds.fake.engine`: an engine whose error is known."""
    return engine


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """The longest tests first, as at the end one process would wait for the other."""
    items.sort(key=lambda item: "readme" not in item.nodeid)


def pytest_collection_finish() -> None:
    """What is there now stays: to look through it at every collection takes a tenth of the time."""
    gc.collect()
    gc.freeze()


def pytest_unconfigure() -> None:
    """Let everything go at the end: an engine's package prints what it finds left over."""
    gc.unfreeze()
