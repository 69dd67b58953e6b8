"""Slider-cranks whose rod is hardly longer than the crank."""

from __future__ import annotations

from models.hard import slider_crank
from reports.stability.case import Case, Trial
from reports.stability.catalogue.change_points import four_turns, through

SOURCE = 'Paper "Phan tich dong hoc co cau tay quay con truot bang phan mem Excel"; carried on to 1'


def _short_rod(excess: float) -> Trial:
    return Trial(slider_crank("short-rod", 0.1, 0.1 * (1.0 + excess), source="L/R runs to 1"))


def _isosceles(steps: float) -> Trial:
    return four_turns(slider_crank("isosceles", 0.1, 0.1, source="L = R"), steps)


CASES = (
    Case(
        name="short-rod",
        title="Rod hardly longer than the crank",
        source=SOURCE,
        truth="closed form; the rod swings past 90 deg faster and faster",
        expected="stays on its branch",
        parameter="L/R - 1",
        values=(0.25, 0.1, 0.05, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6),
        trial=_short_rod,
    ),
    through(
        name="isosceles",
        title="Isosceles slider-crank, stroke 4R",
        source="L = R: the change point of the slider-crank",
        truth="the pin runs through the crank's pivot, x = 2 R cos(theta), by smooth continuation",
        expected="goes on smoothly through the pivot",
        trial=_isosceles,
    ),
)
