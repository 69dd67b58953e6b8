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
from models.motion import Crossing
from models.scene import Scene
from reports.compare.change_points import WINDOW_RAD, conditioning, near
from reports.compare.errors import Errors
from reports.judge.cell import Checked, check
from reports.judge.rules import judge
from reports.judge.rules.rule import Finding
from reports.judge.tolerance import Limit, in_passage, limits
from tests.worlds.tiers import few, slowly
from tests.worlds.turns import of_turns


def grashof(name: str, *lengths: float, **given: float) -> Scene:
    return fourbar(name, *lengths, source="Grashof's rule, equality", **given)


KITE = (0.1, 0.1, 0.3, 0.3)
SCENES = {
    "parallelogram": grashof("parallelogram", 0.1, 0.3, 0.1, 0.3),
    "kite": grashof("kite", *KITE),
    "isosceles": slider_crank("isosceles", 0.1, 0.1, source="L = R"),
    "through-pivot": slotted_lever("through-pivot", 0.1, 0.1, source="AB = AC"),
}


def ran(scene: Scene, engine: str, steps: int, turns: int = 1, **settings: int) -> Checked:
    return check(of_turns(scene, engine, steps, turns, converge=True, settings=settings))


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
    assert solve(SCENES[name], np.linspace(0.0, 0.7, 50)).crossings
    # Where the block is in the lever's pivot its two joints are as good as one: 150 iterations
    # leave so much there that it rings for 30 degrees, and more with a finer step.
    more = {"iterations": 4000} if way == LONG else {}
    found = ran(SCENES[name], engine, steps, turns=3, **more)
    assert found.verdict == "within", found.failures


def test_too_few_iterations_do_not_get_through_the_pivot_of_a_lever() -> None:
    found = ran(SCENES["through-pivot"], "pymunk", 360)
    assert {"CC110", "CC114"} <= {failure.rule for failure in found.failures}


@pytest.mark.parametrize("name", ["parallelogram", "kite"])
def test_limits_are_those_of_the_motion_away_from_the_change_points(name: str) -> None:
    found = ran(SCENES[name], "pymunk", 360)
    # The sine of both is about that of the angle from the change point, on the worse side.
    assert 0.9 * math.sin(WINDOW_RAD) < found.errors.conditioning < 1.2 * math.sin(WINDOW_RAD)
    assert found.limits["angle"].number < 5.0 * found.errors.step_rad**2
    assert found.limits["velocity"].number < 0.05 * found.errors.step_rad / 0.1
    assert found.limits["acceleration"].number < 0.01


def test_a_motion_that_is_singular_and_does_not_go_through_is_as_hard_as_ever() -> None:
    motion = solve(SCENES["parallelogram"], np.linspace(0.0, 0.5, 200))
    other = tuple(replace(crossing, dyad="X") for crossing in motion.crossings)
    for crossings in ((), other):
        found = replace(motion, crossings=crossings)
        assert conditioning(found, motion.links["crank"].theta) < 0.05


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
    errors = ran(SCENES["kite"], "mujoco", 360).errors
    start, away, passing = (
        errors.worst("acceleration", "differenced", kind) for kind in ("start", "total", "passage")
    )
    assert passing.pure > 0.1 > 1e-3 > away.pure
    assert start.samples + away.samples + passing.samples == 359
    assert 0.25 < passing.samples / 359 < 0.35  # two windows of 1 rad, less what is the start
    degrees = math.degrees(passing.driver_at_maximum_rad) % 180.0
    assert min(degrees, 180.0 - degrees) < 3.0


def test_a_scene_without_change_points_has_no_such_rows_and_the_smallest_sine() -> None:
    scene = load_scene("fourbar-lecture-1")
    errors = ran(scene, "pymunk", 360).errors
    assert {row.kind for row in errors.rows} == {"total", "geometric", "start"}
    assert not errors.starts_in_passage
    motion = solve(scene, np.linspace(0.0, scene.driver.law.period_s, 361))
    assert errors.conditioning == min(float(np.min(s)) for s in motion.conditioning.values())


@pytest.mark.parametrize("start_deg", [3.0, 170.1])
@pytest.mark.parametrize("engine", ["mujoco", "pymunk"])
def test_a_run_may_start_beside_a_change_point(engine: str, start_deg: float) -> None:
    found = ran(grashof("kite", *KITE, start_deg=start_deg), engine, 720)
    assert found.errors.starts_in_passage
    assert found.verdict == "within", found.failures


def test_rates_at_change_points_make_good_an_error_of_place_in_one_step() -> None:
    for step in (0.01, 0.005):
        errors = Errors((), (), (), curvature=1.0, conditioning=0.5, step_rad=step)
        found = limits(SCENES["kite"], errors, {})
        for name, order in (("velocity", 1), ("acceleration", 2)):
            wide = in_passage(name, found[name], errors)
            assert wide.number == pytest.approx(found["angle"].number / step**order)
            assert "change point" in wide.origin
        given = Limit(1e-3, "--tol")
        assert in_passage("velocity", given, errors) is given


@pytest.mark.parametrize(("part", "factor"), [("total", 1e4), ("passage", 50.0), ("total", np.nan)])
def test_the_rule_sees_what_is_wrong_at_change_points_and_away(part: str, factor: float) -> None:
    found = ran(SCENES["parallelogram"], "mujoco", 360)

    def told(factor: float) -> Finding:
        """With the differenced accelerations of that part of the run enlarged."""
        rows = tuple(
            replace(row, maximum=row.maximum * factor)
            if (row.kind, row.source, row.quantity) == (part, "differenced", "acceleration")
            else row
            for row in found.errors.rows
        )
        other = replace(found, errors=replace(found.errors, rows=rows), convergence=None)
        return next(finding for finding in judge(other) if finding.rule == "CC114")

    assert told(factor).level == "fail"
    assert ("near a change point" in told(factor).text) is (part == "passage")
    assert told(1.0).level == "pass"


def test_a_run_that_is_all_near_a_change_point_is_judged_there() -> None:
    scene = grashof("kite", *KITE, start_deg=-20.0)
    found = check(replace(of_turns(scene, "pymunk", 720), steps=80))
    assert found.errors.worst("velocity") is None
    assert {"CC106", "CC107", "CC114"} <= {finding.rule for finding in found.findings}
    assert found.verdict == "within", found.failures
