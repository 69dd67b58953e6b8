"""What figures are drawn of."""

from __future__ import annotations

from pathlib import Path

import pytest

from reports.results.overview import Report
from reports.store.reader import read_store


@pytest.fixture(scope="session")
def report(store: Path) -> Report:
    return Report(read_store(store))
