"""The figures of a store of free runs: the truth, the runs over it, and no turns."""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

from models.errors import CrankcheckError
from reports.cli.commands.figures import run_figures
from reports.figures.free.phase import _over_one_turn
from reports.figures.free_runs.free_run import free_runs
from reports.results.overview import Report
from reports.store.reader import read_store
from tests.reports.figures.test_files import texts
from tests.worlds.free_store import SCENE

EACH = ("convergence", "mechanism", "let-go", "energy", "phase")
LABELS = {
    "let-go": ("angle of crank [deg]", "speed [rad/s]", "error of angle / G [rad]", "time [s]"),
    "energy": ("change of energy / largest kinetic energy", "drift", "means over windows"),
    "phase": ("angular velocity [rad/s]", "truth, integrated", "pymunk as-shipped"),
    "convergence": ("time step", "4 ms", "2 ms", "largest error / sensitivity"),
    "mechanism": ("integrated", "x [m]"),
}


@pytest.fixture(scope="module")
def drawn(free_store: Path, as_svg: Callable[[Path], Path]) -> Path:
    return as_svg(free_store)


def test_what_was_let_go_has_its_own_figures_and_none_over_turns(drawn: Path) -> None:
    assert {path.stem for path in drawn.glob("*.svg")} == {f"{n}-{SCENE}" for n in EACH}


@pytest.mark.parametrize("name", LABELS)
def test_a_free_figure_says_what_it_shows(drawn: Path, name: str) -> None:
    found = texts(drawn / f"{name}-{SCENE}.svg").replace("\n", " ")
    for label in (*LABELS[name], "mujoco"):
        assert label in found or (name, label) == ("mechanism", "mujoco")
    assert "steps per turn" not in found


def test_a_figure_of_free_runs_is_refused_of_a_driven_store(store: Path, tmp_path: Path) -> None:
    with pytest.raises(CrankcheckError, match="of what was let go"):
        run_figures(store, tmp_path / "out", Console(file=io.StringIO()), only=("let-go",))


def test_a_portrait_goes_through_its_samples_and_smoothly_between(free_store: Path) -> None:
    shown = free_runs(Report(read_store(free_store)), SCENE)
    run = shown.runs[0]
    angle, speed = run.portrait()
    np.testing.assert_allclose(angle[::8], run.angle, rtol=0, atol=1e-12)
    np.testing.assert_allclose(speed[::8], run.trace["omega"], rtol=0, atol=1e-9)
    near = np.interp(np.linspace(0, shown.time_s[-1], angle.size), shown.time_s, shown.angle)
    assert np.max(np.abs(angle - near)) < 1e-2


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_phase_diagram_over_one_turn_goes_on_at_the_other_side(way: float) -> None:
    degrees = way * np.array([300.0, 340.0, 420.0, 500.0])
    within, speed = _over_one_turn(degrees, np.array([1.0, 2.0, 6.0, 7.0]))
    (cut,) = np.flatnonzero(np.isnan(within))
    assert (within[cut - 1], within[cut + 1]) == ((360.0, 0.0) if way > 0.0 else (0.0, 360.0))
    assert speed[cut - 1] == speed[cut + 1] == pytest.approx(3.0)
    assert np.isnan(speed[cut])
    assert within.size == 7
