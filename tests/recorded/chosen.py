"""A plugin of pytest: of what is collected, only what a file lists, in its order: tests, and files
and folders of tests."""

import os
from collections.abc import Mapping, Sequence
from pathlib import Path

import pytest

from tests.recorded.recording import ROOT

VARIABLE = "CHOSEN_TESTS"


def write(tests: Sequence[str], path: Path, root: Path = ROOT) -> list[str]:
    """List the tests in a file; what pytest has to be called with: their files, those that the
    checkout still has."""
    path.write_text("\n".join(map(repr, tests)), encoding="utf-8")
    files = dict.fromkeys(name.partition("::")[0] for name in tests)
    return [file for file in files if (root / file).exists()]


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    listed = Path(os.environ[VARIABLE]).read_text(encoding="utf-8").split("\n")
    place = {name: number for number, name in enumerate(listed)}
    found = {item: number for item in items if (number := _place(item, place)) is not None}
    config.hook.pytest_deselected(items=[item for item in items if item not in found])
    items[:] = sorted(found, key=lambda item: found[item])


def _place(item: pytest.Item, place: Mapping[str, int]) -> int | None:
    """The number of a test, or of what it stands in; None where neither is listed."""
    file = Path(item.nodeid.partition("::")[0])
    names = (item.nodeid, *(each.as_posix() for each in (file, *file.parents)))
    return next((place[repr(name)] for name in names if repr(name) in place), None)
