"""A small real store, made once, whose copies are damaged; and sweeps without processes apart."""

import shutil
from collections.abc import Callable
from io import StringIO
from pathlib import Path

import pytest
from rich.console import Console

from reports.requests.sweep import SweepRequest
from tests.worlds.in_process import in_this_process

Sweep = Callable[..., int]


@pytest.fixture(scope="session")
def swept() -> Sweep:
    """Sweeps two steps of both engines, or of one, into a folder."""
    nowhere = Console(file=StringIO())

    def run(folder: Path, *engines: str, steps: str = "90,180", timing: bool = True) -> int:
        cells = {"engines": engines, "profiles": ["tuned"], "steps_per_turn": steps}
        asked = SweepRequest(folder, ["fourbar-lecture-1"], jobs=1, timing=timing, **cells)
        with in_this_process() as patch:
            # A part for each sweep, however busy the machine is.
            patch.setattr("reports.store.writer.EVERY_S", 600.0)
            return asked.run(nowhere, nowhere)

    return run


@pytest.fixture(scope="session")
def whole(swept: Sweep, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A store of four cells in two parts: MuJoCo's first, then pymunk's. Not to be changed."""
    folder = tmp_path_factory.mktemp("whole") / "store"
    assert swept(folder, "mujoco") == swept(folder) == 0
    return folder


@pytest.fixture
def store(whole: Path, tmp_path: Path) -> Path:
    return shutil.copytree(whole, tmp_path / "store")
