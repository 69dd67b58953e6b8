"""A run that goes over to the other assembly of its loop is named, and never passes."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest

from analytic.kinematics import solve
from analytic.structure.mobility import analyse
from models.errors import ReachError
from models.files import load_scene, parse_scene, shipped
from models.scene import Scene
from reports.compare.beside import Beside, Truth
from reports.compare.branch import departure
from reports.judge.cell import check
from sim.run import run
from tests.worlds.turns import of_turns


def edited(name: str, *changes: tuple[str, str]) -> Scene:
    """A shipped scene with some of its text changed."""
    text = shipped()[name].read_text(encoding="utf-8")
    for old, new in changes:
        assert text.count(old) == 1
        text = text.replace(old, new)
    return parse_scene(text, "edited")


NEARLY_FLAT = ("fourbar-lecture-1", "length_m = 0.1 ", "length_m = 0.1499999999 ")


@pytest.mark.parametrize("engine", ["mujoco", "pymunk"])
@pytest.mark.parametrize(
    ("name", "old", "new", "link", "left_deg"),
    [
        (*NEARLY_FLAT, "coupler", 181),
        ("slider-crank-excel-210", "length_m = 2.1", "length_m = 2.0000001", "rod", 90),
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


def yoke_and_rocker() -> Scene:
    """A Scotch yoke, which has one assembly alone, with a coupler and a rocker on its crank."""
    more = """
[links]
coupler = { bar = ["B", "C"], length_m = 0.25 }
rocker = { bar = ["D", "C"], length_m = 0.3 }"""
    ground = ("A = [0.0, 0.0]", "A = [0.0, 0.0], D = [0.2, 0.0]")
    return edited("scotch-yoke", ground, ("\n[links]", more))


@pytest.mark.parametrize("name", ["sixbar-watt", "sixbar-stephenson", "yoke and rocker"])
def test_a_run_is_found_in_each_of_the_other_assemblies(name: str) -> None:
    """Not all of them are looked at: what their first dyads rule out is left out."""
    scene = load_scene(name) if name in shipped() else yoke_and_rocker()
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
        stands = Beside.of(truth, replace(shipped_run, motion=motion, gaps=still))
        assert (departure(stands) is not None) == (-1 in signs), signs
        seen += 1
    assert seen >= 2
