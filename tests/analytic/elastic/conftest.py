"""Truths of elastic links are found once."""

from collections.abc import Iterator

import pytest

from tests.worlds.kept_elastic import kept_motions


@pytest.fixture(scope="module", autouse=True)
def kept() -> Iterator[None]:
    with kept_motions():
        yield
