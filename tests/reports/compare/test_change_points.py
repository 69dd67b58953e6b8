"""A run that goes over to the other assembly of its loop is named, and never passes; change points
that a motion goes through have limits as tight as away from them, and rates apart."""

import itertools
import math
from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from analytic.kinematics import solve
from analytic.structure.mobility import analyse
from models.errors import ReachError
from models.files.reading import load_scene, parse_scene, shipped
from models.motion import Crossing
from models.scene import Scene
from models.scene.hard import fourbar, slider_crank, slotted_lever
from reports.compare.branch import departure
from reports.compare.compare import Truth
from reports.compare.hardness import WINDOW_RAD, conditioning, near
from reports.judge.cell import Checked, check
from reports.judge.rules import judge
from reports.judge.rules.rule import Finding
from sim.run import run
from tests.worlds.tiers import few, slowly
from tests.worlds.turns import of_turns


def edited(name: str, *changes: tuple[str, str]) -> Scene:
    text = shipped()[name].read_text(encoding="utf-8")
    for old, new in changes:
        assert text.count(old) == 1
        text = text.replace(old, new)
    return parse_scene(text, "edited")


NEARLY_FLAT = ("fourbar-lecture-1", "length_m = 0.1 ", "length_m = 0.1499999999 ")


@pytest.mark.parametrize(
    ("name", "old", "new", "link", "left_deg", "engine"),
    [
        (*NEARLY_FLAT, "coupler", 181, "pymunk"),
        ("slider-crank-excel-210", "length_m = 2.1", "length_m = 2.0000001", "rod", 90, "mujoco"),
    ],
)
def test_a_run_on_the_other_branch_is_out_and_says_where_it_left(
    name: str, old: str, new: str, link: str, left_deg: int, engine: str
) -> None:
    scene = edited(name, (old, new))
    found = check(of_turns(scene, engine, 720, turns=2, converge=True))
    assert (found.verdict, found.status) == ("out", "branch-changed")
    assert {"CC101", "CC103", "CC113"} <= {finding.rule for finding in found.failures}
    assert f"branch-changed: {link} left its branch at driver {left_deg}" in found.failures[0].text
    if name == NEARLY_FLAT[0]:  # where the reference is not certain either, of any engine
        (finding,) = (f for f in found.findings if f.rule == "CC112")
        assert finding.level == "fail"
        assert "acceleration of rocker" in finding.text  # pymunk reports none, and is judged by it


def test_a_run_is_found_in_each_of_the_other_assemblies() -> None:
    """Not all of them are looked at: what their first dyads rule out is left out. What is logged of
    the crank does not matter, but that it does not stand elsewhere."""
    scene = load_scene("sixbar-watt")
    truth = Truth(scene)
    time_s = np.linspace(0.0, scene.driver.law.period_s, 90)
    shipped_run = run(scene, truth.start, "mujoco", dt_s=float(time_s[1]), steps=89)
    keys, seen = [dyad.branch_key for dyad in analyse(scene).groups if dyad.assemblies == 2], 0
    for signs in itertools.product((1, -1), repeat=len(keys)):
        branch = {k: sign * scene.branch.get(k, 1) for k, sign in zip(keys, signs, strict=True)}
        try:
            motion = solve(replace(scene, branch=branch), time_s)
        except ReachError:
            continue
        still = {joint: np.zeros_like(time_s) for joint in shipped_run.gaps}
        name, other = scene.driver.link, -1 in signs
        crank = motion.links[name]
        unknown = replace(crank, theta=np.full_like(time_s, np.nan))
        off = replace(crank, theta=np.where(time_s > 0.0, crank.theta + 1.0, np.nan))
        for own, told in ((crank, other), (unknown, other), (None, other), (off, False)):
            rest = {n: link for n, link in motion.links.items() if n != name}
            logged = replace(motion, links={**rest, **({name: own} if own else {})})
            left = departure(truth.beside(replace(shipped_run, motion=logged, gaps=still)))
            assert (left is not None) == told, signs
            assert left is None or left.time_s == 0.0
        seen += 1
    assert seen >= 2


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
QUICK = [WAYS[2], WAYS[3], WAYS[5], WAYS[6]]


@pytest.mark.parametrize(
    "steps", [360, slowly(720, reason="a finer step, at which some ring more")]
)
@pytest.mark.parametrize("way", few(WAYS, QUICK, "others of both kinds"))
def test_engines_go_through_change_points_within_limits(way: tuple[str, str], steps: int) -> None:
    name, engine = way
    assert solve(SCENES[name], np.linspace(0.0, 0.7, 50)).crossings
    # Where the block is in the lever's pivot its two joints are as good as one: 150 iterations
    # leave so much there that it rings for 30 degrees, and more with a finer step.
    more = {"iterations": 4000} if way == LONG else {}
    found = ran(SCENES[name], engine, steps, turns=3, **more)
    assert found.verdict == "within", found.failures


def test_limits_are_those_of_the_motion_away_from_the_change_points() -> None:
    found = ran(SCENES["kite"], "pymunk", 360)
    # The sine of both is about that of the angle from the change point, on the worse side.
    assert (
        0.9 * math.sin(WINDOW_RAD) < found.errors.of_scene.conditioning < 1.2 * math.sin(WINDOW_RAD)
    )
    assert found.limits["angle"].number < 5.0 * found.errors.of_scene.step_rad**2
    assert found.limits["velocity"].number < 0.05 * found.errors.of_scene.step_rad / 0.1
    assert found.limits["acceleration"].number < 0.01


def test_a_motion_that_does_not_go_through_or_is_within_the_window_is_as_hard_as_it_is() -> None:
    scene = SCENES["parallelogram"]
    motion = solve(scene, np.linspace(0.0, 0.5, 200))
    other = tuple(replace(crossing, dyad="X") for crossing in motion.crossings)
    for crossings in ((), other):
        found = replace(motion, crossings=crossings)
        assert conditioning(found, motion.links["crank"].theta) < 0.05
    # Within, where it is farthest from the middle.
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


@pytest.mark.parametrize(("engine", "start_deg"), [("mujoco", 170.1), ("pymunk", 3.0)])
def test_a_run_may_start_beside_a_change_point(engine: str, start_deg: float) -> None:
    found = ran(grashof("kite", *KITE, start_deg=start_deg), engine, 720)
    assert found.errors.of_scene.starts_in_passage
    assert found.verdict == "within", found.failures


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
