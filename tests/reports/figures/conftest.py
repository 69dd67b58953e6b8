"""What figures are drawn of, and all of a store in a folder."""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path

import pytest
from rich.console import Console

from reports.cli.commands.figures import run_figures
from reports.results.overview import Report
from reports.store.reader import read_store


@pytest.fixture(scope="session")
def report(store: Path) -> Report:
    return Report(read_store(store))


@pytest.fixture(scope="session")
def as_svg(tmp_path_factory: pytest.TempPathFactory) -> Callable[[Path], Path]:
    """Draws all of a store, as SVG alone: fonts of a PDF take twice the time of all else."""

    def drawn(store: Path) -> Path:
        folder = tmp_path_factory.mktemp("drawn") / "figs"
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr("reports.cli.commands.figures.FORMATS", ("svg",))
            assert run_figures(store, folder, Console(file=io.StringIO())) == 0
        return folder

    return drawn
