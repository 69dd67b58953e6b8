"""Change points that a motion goes through: limits as tight as away from them, rates apart."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from analytic.kinematics import solve
from models.files import load_scene
from models.hard import fourbar, slider_crank, slotted_lever
from models.motion import Crossing, Motion
from models.scene import Scene
from reports.compare.change_points import WINDOW_RAD, conditioning, near
from reports.compare.errors import Errors
from reports.judge.cell import Cell, Checked, check
from reports.judge.rules import judge
from reports.judge.rules.rule import Evidence
from reports.judge.tolerance import Limit, in_passage, limits
from tests.worlds.tiers import few, slowly

LENGTHS = {"parallelogram": (0.1, 0.3, 0.1, 0.3), "kite": (0.1, 0.1, 0.3, 0.3)}
SOURCE = "Grashof's rule, equality"
SCENES = {
    **{name: fourbar(name, *lengths, source=SOURCE) for name, lengths in LENGTHS.items()},
    "isosceles": slider_crank("isosceles", 0.1, 0.1, source="L = R"),
    "through-pivot": slotted_lever("through-pivot", 0.1, 0.1, source="AB = AC"),
}


def ran(scene: Scene, engine: str, steps: int, turns: int = 1, **settings: int) -> Checked:
    dt_s = scene.driver.law.period_s / steps
    return check(Cell(scene, engine, "tuned", dt_s, steps * turns, settings=settings))


def errors_of(found: Checked) -> Errors:
    return found.errors


WAYS = list(product(SCENES, ["mujoco", "pymunk"]))
LONG = ("through-pivot", "pymunk")
"""Its 4000 iterations take a second."""


@pytest.mark.parametrize(
    "steps", [360, slowly(720, reason="a finer step, at which some ring more")]
)
@pytest.mark.parametrize("way", few(WAYS, [way for way in WAYS if way != LONG], "4000 iterations"))
def test_tuned_engines_go_through_change_points_within_the_limits(
    way: tuple[str, str], steps: int
) -> None:
    name, engine = way
    # Where the block is in the lever's pivot its two joints are as good as one: 150 iterations
    # leave so much there that it rings for 30 degrees, and more with a finer step.
    more = {"iterations": 4000} if way == LONG else {}
    found = ran(SCENES[name], engine, steps, turns=3, **more)
    assert found.verdict == "within", found.failures


def test_too_few_iterations_do_not_get_through_the_pivot_of_a_lever() -> None:
    found = ran(SCENES["through-pivot"], "pymunk", 360)
    assert {"CC110", "CC114"} <= {failure.rule for failure in found.failures}


@pytest.mark.parametrize("name", LENGTHS)
def test_limits_are_those_of_the_motion_away_from_the_change_points(name: str) -> None:
    found = ran(SCENES[name], "pymunk", 360)
    errors = errors_of(found)
    # The sine of both is about that of the angle from the change point, on the worse side.
    assert 0.9 * math.sin(WINDOW_RAD) < errors.conditioning < 1.2 * math.sin(WINDOW_RAD)
    assert found.limits["angle"].number < 5.0 * errors.step_rad**2
    assert found.limits["velocity"].number < 0.05 * errors.step_rad / 0.1
    assert found.limits["acceleration"].number < 0.01


def test_a_motion_that_is_singular_and_does_not_go_through_is_as_hard_as_ever() -> None:
    motion = solve(SCENES["parallelogram"], np.linspace(0.0, 0.5, 200))
    driver_rad = motion.links["crank"].theta
    assert conditioning(replace(motion, crossings=()), driver_rad) < 0.05
    other = tuple(replace(crossing, dyad="X") for crossing in motion.crossings)
    assert conditioning(replace(motion, crossings=other), driver_rad) < 0.05


def test_a_motion_within_the_window_is_as_hard_as_where_it_is_farthest_from_its_middle() -> None:
    scene = SCENES["parallelogram"]
    to_flat = (math.pi - math.radians(31.37)) / scene.driver.law.peak_speed_rad_s
    motion = solve(scene, to_flat + np.linspace(-0.01, 0.02, 40))
    driver_rad = motion.links["crank"].theta
    assert conditioning(motion, driver_rad) == pytest.approx(math.sin(0.2), rel=1e-6)


def test_driver_angles_are_near_a_change_point_in_every_turn() -> None:
    angles = np.array([-0.3, 0.0, 0.4, 1.0, math.tau - 0.3, 4.0 * math.pi + 0.2, 7.0])
    found = near((Crossing("C", 0.1),), angles, 0.5)
    assert found.tolist() == [True, True, True, False, True, True, False]
    assert not near((), angles, 0.5).any()


def test_rates_at_change_points_are_rows_of_their_own() -> None:
    errors = errors_of(ran(SCENES["kite"], "mujoco", 360))
    parts = [
        errors.worst("acceleration", "differenced", kind) for kind in ("start", "total", "passage")
    ]
    assert all(parts)
    start, away, passing = (part for part in parts if part is not None)
    assert passing.pure > 0.1 > 1e-3 > away.pure
    assert start.samples + away.samples + passing.samples == 359
    assert 0.25 < passing.samples / 359 < 0.35  # two windows of 1 rad, less what is the start
    degrees = math.degrees(passing.driver_at_maximum_rad) % 180.0
    assert min(degrees, 180.0 - degrees) < 3.0


def test_a_scene_without_change_points_has_no_such_rows_and_the_smallest_sine() -> None:
    scene = load_scene("fourbar-lecture-1")
    errors = errors_of(ran(scene, "pymunk", 360))
    assert {row.kind for row in errors.rows} == {"total", "geometric", "start"}
    assert not errors.starts_in_passage
    motion = solve(scene, np.linspace(0.0, scene.driver.law.period_s, 361))
    assert errors.conditioning == min(float(np.min(s)) for s in motion.conditioning.values())


@pytest.mark.parametrize("start_deg", [3.0, 170.1])
@pytest.mark.parametrize("engine", ["mujoco", "pymunk"])
def test_a_run_may_start_beside_a_change_point(engine: str, start_deg: float) -> None:
    scene = fourbar("kite", *LENGTHS["kite"], source=SOURCE, start_deg=start_deg)
    found = ran(scene, engine, 720)
    assert errors_of(found).starts_in_passage
    assert found.verdict == "within", found.failures


ERRORS = Errors((), (), (), curvature=1.0, conditioning=0.5, step_rad=0.01)


def test_rates_at_change_points_make_good_an_error_of_place_in_one_step() -> None:
    scene = SCENES["kite"]
    for step in (0.01, 0.005):
        errors = replace(ERRORS, step_rad=step)
        found = limits(scene, errors, {})
        place = found["angle"].number
        for name, order in (("velocity", 1), ("acceleration", 2)):
            wide = in_passage(name, found[name], errors)
            assert wide.number == pytest.approx(place / step**order)
            assert "change point" in wide.origin
    given = Limit(1e-3, "--tol")
    assert in_passage("velocity", given, ERRORS) is given


def evidence(found: Checked, part: str, factor: float) -> Evidence:
    """What was found, with the differenced accelerations of a part of the run enlarged."""
    errors = errors_of(found)
    rows = tuple(
        replace(row, maximum=row.maximum * factor)
        if (row.kind, row.source, row.quantity) == (part, "differenced", "acceleration")
        else row
        for row in errors.rows
    )
    return Evidence("ok", "", 1.0, replace(errors, rows=rows), found.limits)


@pytest.mark.parametrize(("part", "factor"), [("total", 1e4), ("passage", 50.0), ("total", np.nan)])
def test_the_rule_sees_what_is_wrong_at_change_points_and_away(part: str, factor: float) -> None:
    found = ran(SCENES["parallelogram"], "mujoco", 360)
    rules = {finding.rule: finding for finding in judge(evidence(found, part, factor))}
    assert rules["CC114"].level == "fail"
    assert ("near a change point" in rules["CC114"].text) is (part == "passage")
    sound = {finding.rule: finding for finding in judge(evidence(found, part, 1.0))}
    assert sound["CC114"].level == "pass"


def test_a_run_that_is_all_near_a_change_point_is_judged_there() -> None:
    scene = fourbar("kite", *LENGTHS["kite"], source=SOURCE, start_deg=-20.0)
    dt_s = scene.driver.law.period_s / 720
    found = check(Cell(scene, "pymunk", "tuned", dt_s, 80, converge=False))
    assert errors_of(found).worst("velocity") is None
    assert {"CC106", "CC107", "CC114"} <= {finding.rule for finding in found.findings}
    assert found.verdict == "within", found.failures


def _crossings(motion: Motion) -> set[str]:
    return {crossing.dyad for crossing in motion.crossings}


@pytest.mark.parametrize("name", SCENES)
def test_the_scenes_go_through_change_points(name: str) -> None:
    assert _crossings(solve(SCENES[name], np.linspace(0.0, 0.7, 50)))
