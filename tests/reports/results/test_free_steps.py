"""What is let go is measured over a second, so that scenes stand side by side at the same step."""

from __future__ import annotations

from dataclasses import replace

import pytest

from models.files import load_scene
from reports.judge.cell import Cell
from reports.results.fits.line import fit_line
from reports.results.fits.words import words
from reports.sweep.measured import timed


def cell(name: str, dt_s: float = 1e-3) -> Cell:
    return Cell(load_scene(name), "mujoco", "tuned", dt_s, 500, drive="free")


def test_cells_of_one_step_have_as_many_in_a_second_however_long_they_last() -> None:
    swing, pulse = cell("fourbar-swing"), cell("fourbar-pulse")
    assert swing.steps_per_turn == pulse.steps_per_turn == pytest.approx(1000.0)
    assert replace(swing, steps=250).turns == pytest.approx(0.25)


def test_a_mechanism_of_several_freedoms_is_timed() -> None:
    assert min(timed(cell("double-pendulum"), 10.0)) > 0.0


def test_a_fit_of_free_motion_speaks_of_seconds() -> None:
    fit = fit_line([4e-3, 2e-3, 1e-3], [1e9, 1e-3, 1e-4], statuses=["diverged", "ok", "ok"])
    assert "steps per second" in words(fit, "rad", 1.0, "second")
