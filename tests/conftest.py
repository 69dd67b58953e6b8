"""Fixtures for all tests."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from types import ModuleType

import pytest

from tests.worlds.fake import engine
from tests.worlds.programs import Start, hear_signals
from tests.worlds.programs import programs as started


def pytest_configure() -> None:
    hear_signals()


@pytest.fixture
def programs() -> Iterator[Start]:
    """Starts programs, which end with the test."""
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
