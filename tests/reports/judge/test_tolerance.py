"""Tolerances: defaults that follow step and scene, overrides, and mistakes in them."""

from __future__ import annotations

from dataclasses import replace

import pytest

from models.errors import CrankcheckError
from models.scene import Scene
from reports.compare.errors import Errors
from reports.judge.tolerance import DEFAULTS, check_names, limits, parse

ERRORS = Errors((), (), (), curvature=1.0, conditioning=0.8, step_rad=0.01)


def test_every_tolerance_has_a_reason() -> None:
    assert all(len(tolerance.reason) > 20 for tolerance in DEFAULTS.values())


def test_place_and_rates_shrink_with_the_square_of_the_step(fourbar: Scene) -> None:
    coarse, fine = (limits(fourbar, replace(ERRORS, step_rad=h), {}) for h in (0.02, 0.01))
    for name in ("angle", "displacement", "position", "gap", "velocity"):
        assert coarse[name].number / fine[name].number == pytest.approx(4.0, rel=0.02)
    assert coarse["drive"].number == pytest.approx(fine["drive"].number)


def test_a_badly_conditioned_scene_gets_wider_angles_and_no_wider_gap(fourbar: Scene) -> None:
    near = limits(fourbar, replace(ERRORS, conditioning=0.1), {})
    far = limits(fourbar, replace(ERRORS, conditioning=1.0), {})
    assert near["angle"].number == pytest.approx(10 * far["angle"].number, rel=1e-3)
    assert near["gap"].number == far["gap"].number


def test_places_have_room_for_what_closing_the_pins_sets_off(fourbar: Scene) -> None:
    """Where bodies turn fast about a centre that is far from their pins, beyond the curvature."""
    slow, fast = (limits(fourbar, replace(ERRORS, worst_jolt=jolt), {}) for jolt in (0.4, 3.0))
    for name in ("angle", "displacement", "position", "gap"):
        assert fast[name].number == pytest.approx(2.0 * 3.0 * ERRORS.step_rad**2, rel=1e-4)
        assert slow[name].number < fast[name].number / 4
    for name in ("velocity", "acceleration"):
        assert fast[name].number == slow[name].number


def test_near_a_singular_position_no_default_grows_beyond_what_is_plainly_wrong(
    fourbar: Scene,
) -> None:
    found = limits(fourbar, replace(ERRORS, conditioning=1e-9, curvature=1e9), {})
    assert found["angle"].number == found["position"].number == pytest.approx(2e-2)
    assert found["velocity"].number == pytest.approx(5e-2)
    assert found["acceleration-differenced"].number == pytest.approx(0.5, rel=1e-3)
    assert all(limit.number < 1.0 for limit in found.values())


def test_no_default_falls_below_what_rounding_does(fourbar: Scene) -> None:
    tiny = limits(fourbar, replace(ERRORS, step_rad=1e-7), {})
    assert tiny["velocity"].number >= 1e-3 * 1e-7  # the share of an acceleration, over a step
    assert tiny["angle"].number >= 1e-11
    assert tiny["acceleration-differenced"].number >= 1e-11 / 1e-14


def test_the_command_line_beats_the_scene_and_the_scene_beats_the_default(fourbar: Scene) -> None:
    scene = replace(fourbar, tolerance={"angle": 1e-3, "gap": 2e-3})
    found = limits(scene, ERRORS, {"angle": 5e-5})
    assert (found["angle"].number, found["angle"].origin) == (5e-5, "--tol")
    assert (found["gap"].number, found["gap"].origin) == (2e-3, "scene")
    assert found["position"].origin == "default"


def test_tolerances_are_read_one_by_one_or_with_commas() -> None:
    assert parse(["angle=1e-4", "gap=1e-6, velocity-differenced = 0.5"]) == {
        "angle": 1e-4,
        "gap": 1e-6,
        "velocity-differenced": 0.5,
    }


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("angle", ["--tol 'angle'", "no `=`", "angle=1e-4"]),
        ("", ["no `=`"]),
        ("angle=", ["not a number above 0"]),
        ("angle=small", ["'small' is not a number above 0"]),
        ("angle=0", ["not a number above 0"]),
        ("angle=-1e-4", ["not a number above 0"]),
        ("angle=nan", ["not a number above 0"]),
        ("angle=inf", ["not a number above 0"]),
        ("angel=1e-4", ["'angel' is no quantity", "did you mean angle"]),
        ("zzz=1", ["use one of drive, angle"]),
    ],
)
def test_a_tolerance_that_does_not_parse_says_where_what_and_how(
    text: str, parts: list[str]
) -> None:
    with pytest.raises(CrankcheckError) as caught:
        parse([text])
    assert all(part in str(caught.value) for part in parts), str(caught.value)


def test_a_scene_with_a_tolerance_for_nothing_is_refused(fourbar: Scene) -> None:
    with pytest.raises(CrankcheckError, match=r"\[tolerance\] positon.*did you mean position"):
        check_names(replace(fourbar, tolerance={"positon": 1.0}))
