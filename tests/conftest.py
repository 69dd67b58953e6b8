"""Fixtures for all tests."""

from __future__ import annotations

from types import ModuleType

import pytest

from tests.worlds.fake import engine


@pytest.fixture(scope="session")
def fake_engine() -> ModuleType:
    """The module `tests.worlds.fake.engine`: an engine whose error is known."""
    return engine


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """The longest test first, as at the end one process would wait for the other."""
    items.sort(key=lambda item: "readme" not in item.nodeid)
