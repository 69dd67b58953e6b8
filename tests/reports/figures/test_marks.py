"""Curves are told apart without colour."""

from __future__ import annotations

import itertools

import pytest
from matplotlib.colors import to_rgb
from matplotlib.lines import Line2D

from reports.figures.error_parts import LOOKS
from reports.figures.marks import COLOURS, marks
from reports.results.lines import lines
from reports.results.looks import label
from reports.results.overview import Report
from tests.reports.results.made import cell, stored


def brightness(colour: str) -> float:
    red, green, blue = to_rgb(colour)
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


@pytest.mark.parametrize("number", [1, 4, 13, 30])
def test_no_two_variants_share_marker_and_dashes(number: int) -> None:
    rows = [
        cell("a", f"v{i}", 90, 1e-3, 1.0, engine=engine)
        for engine in ("mujoco", "pymunk", "third")
        for i in range(number)
    ]
    found = marks(lines(stored(rows)))
    assert len(found) == 3 * number
    assert len({(mark.marker, mark.dashes) for mark in found.values()}) == 3 * number
    for mark in found.values():
        Line2D([], [], **mark.style)  # matplotlib knows the marker and takes the dashes


def test_engines_differ_in_filling_and_in_dashes(report: Report) -> None:
    found = marks(report.lines)
    for of in (lambda mark: mark.filled, lambda mark: mark.dashes):
        mujoco = {of(mark) for (engine, *_), mark in found.items() if engine == "mujoco"}
        pymunk = {of(mark) for (engine, *_), mark in found.items() if engine == "pymunk"}
        assert len(mujoco) == len(pymunk) == 1
        assert mujoco != pymunk


def test_variants_of_an_engine_are_a_scale_of_brightness_that_prints() -> None:
    for hue in COLOURS:
        bright = [brightness(colour) for colour in hue]
        assert all(b - a > 0.08 for a, b in itertools.pairwise(bright))
        assert bright[-1] < 0.72  # on white paper


def test_the_parts_of_an_error_differ_in_dashes_or_are_much_brighter() -> None:
    dashes = [look.get("dashes") for _, look in LOOKS.values()]
    assert len(set(dashes) - {None}) == len(LOOKS) - 2
    total, rest = LOOKS["total"][1], LOOKS["discretisation"][1]
    assert brightness(total["color"]) - brightness(rest["color"]) > 0.5
    assert total["linewidth"] > 2.0


def test_a_drive_that_is_not_the_usual_one_is_named() -> None:
    assert label(("mujoco", "tuned", "servo")) != label(("mujoco", "tuned", "prescribed"))
