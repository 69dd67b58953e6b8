"""Fixtures for all tests."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import pytest


@pytest.fixture(scope="session")
def fake_engine() -> ModuleType:
    """The module `tests/worlds/fake_engine.py`: an engine whose error is known."""
    name = "crankcheck_fake_engine"
    if name not in sys.modules:
        path = Path(__file__).parent / "worlds" / "fake_engine.py"
        spec = importlib.util.spec_from_file_location(name, path)
        assert spec is not None
        assert spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        sys.modules[name] = module
        spec.loader.exec_module(module)
    return sys.modules[name]


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """The longest test first, as at the end one process would wait for the other."""
    items.sort(key=lambda item: "readme" not in item.nodeid)
