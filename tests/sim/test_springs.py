"""Springs in the motion of an engine: how long they are, what they keep, whether they are there."""

from __future__ import annotations

from dataclasses import replace
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from analytic.forces.springs import spring_lengths as true_lengths
from analytic.kinematics import chunks, solve
from models.errors import EngineError
from models.files import load_scene
from models.scene import GROUND, Scene
from models.spring_ends import line_ends, whole_turns
from models.springs import LineSpring, PinSpring, SlideSpring, Spring
from sim.check import refuse_other_model
from sim.energy import energy
from sim.spring_lengths import spring_lengths

DT_S = 1e-3


def with_springs(scene: Scene, *springs: Spring) -> Scene:
    return replace(scene, springs={spring.name: spring for spring in springs})


FOURBAR = with_springs(
    load_scene("fourbar-lecture-1"),
    LineSpring("across", 100.0, 1.0, 0.05, ("A", "C")),
    LineSpring("diagonal", 10.0, 0.0, 0.0, ("B", "D")),
    PinSpring("knee", 5.0, 0.1, 0.3, "C", ("coupler", "rocker")),
    PinSpring("crank", 0.1, 0.0, 0.0, "A", (GROUND, "crank")),
)
SLIDERS = (
    with_springs(
        load_scene("slider-crank-offset"),
        SlideSpring("along", 300.0, 3.0, 0.1, "C"),
        LineSpring("block", 20.0, 0.0, 0.0, ("C", "A")),
    ),
    with_springs(
        load_scene("slider-crank-excel-210"),  # a block without mass
        SlideSpring("along", 300.0, 3.0, 0.1, "C"),
        LineSpring("pin", 20.0, 0.0, 0.0, ("C", "A")),
    ),
    with_springs(load_scene("slotted-lever"), SlideSpring("along", 300.0, 3.0, 0.1, "B")),
    with_springs(load_scene("shaper"), SlideSpring("ram", 300.0, 3.0, 0.1, "F")),
)
"""Springs along lines of the ground and of a link, of blocks with and without mass, of a link."""


def poses_of(fake: ModuleType, scene: Scene, shift: float = 0.0) -> Any:
    time_s = np.linspace(0.0, 1.2 * scene.driver.law.period_s, 301)
    return fake.exact_poses(scene, fake.FakeEngine(solve, velocity_shift=shift), time_s, DT_S)


@pytest.mark.parametrize("scene", [FOURBAR, *SLIDERS], ids=lambda scene: scene.name)
def test_lengths_are_those_of_the_reference(scene: Scene, fake_engine: ModuleType) -> None:
    poses = poses_of(fake_engine, scene)
    found = spring_lengths(scene, poses)
    ((_, chunk),) = chunks(scene, poses.time_s, bound=False)
    for spring, true, _ in true_lengths(scene, chunk):
        off = found[spring.name] - true
        if isinstance(spring, PinSpring):  # turns are counted on here
            assert off[0] == pytest.approx(0.0, abs=1e-12)
            off = np.remainder(off + np.pi, 2.0 * np.pi) - np.pi
        np.testing.assert_allclose(off, 0.0, atol=1e-12)
    assert list(found) == list(scene.springs)


def test_a_spring_in_a_pin_is_wound_up_and_not_let_go_after_half_a_turn(
    fake_engine: ModuleType,
) -> None:
    q = spring_lengths(FOURBAR, poses_of(fake_engine, FOURBAR))["crank"]
    assert abs(q[0]) <= np.pi
    assert q[-1] - q[0] == pytest.approx(2.4 * np.pi)
    spring = PinSpring("turned", 1.0, 0.0, 4.0, "A", (GROUND, "crank"))
    assert 0.5 + whole_turns(spring, 0.5) == pytest.approx(0.5 + 2.0 * np.pi)


def test_springs_add_what_they_keep_at_the_instants_of_the_velocities(
    fake_engine: ModuleType,
) -> None:
    bare = replace(FOURBAR, springs={})
    late = poses_of(fake_engine, FOURBAR, 0.5)
    added = energy(FOURBAR, late).potential_j - energy(bare, late).potential_j
    ((_, chunk),) = chunks(FOURBAR, late.time_s + 0.5 * DT_S, bound=False)
    kept = np.zeros(len(late.time_s))
    for spring, q, _ in true_lengths(FOURBAR, chunk):
        if spring.name != "crank":
            kept += 0.5 * spring.rate * (q - spring.free) ** 2
    crank = FOURBAR.springs["crank"]
    kept += 0.5 * crank.rate * spring_lengths(FOURBAR, late)["crank"] ** 2
    assert np.abs(added - kept).max() < 2e-3 * kept.max()
    without = replace(FOURBAR, springs={"crank": crank})
    shift = energy(without, late).potential_j - energy(bare, late).potential_j
    moved = spring_lengths(FOURBAR, late)["crank"] + 0.5 * DT_S * late.bodies["crank"].omega
    np.testing.assert_allclose(shift, 0.05 * moved**2, rtol=1e-12)


def test_what_the_engine_holds_of_a_spring_is_held_to_the_scene(fake_engine: ModuleType) -> None:
    fake = fake_engine.FakeEngine(solve)
    state = solve(FOURBAR, np.zeros(1)).state()
    facts = fake.open(FOURBAR, state, {}, DT_S, "prescribed").facts()
    refuse_other_model(FOURBAR, state, facts, DT_S, "prescribed")
    own = dict(facts.springs)
    stray = {**own, "stray": (1.0, 0.0, 0.0)}
    missing = {name: one for name, one in own.items() if name != "knee"}
    for springs, words in (
        ({**own, "across": (100.0, 2.0, 0.05)}, "springs.across has damping 2, not 1"),
        ({**own, "across": (100.0, 1.0, 0.0)}, "springs.across has free 0, not 0.05"),
        ({**own, "diagonal": (10.1, 0.0, 0.0)}, "springs.diagonal has rate 10.1, not 10"),
        ({**own, "diagonal": (10.0, 0.0, 1e-6)}, "springs.diagonal has free 1e-06, not 0"),
        ({**own, "knee": (float("nan"), 0.1, 0.3)}, "springs.knee has rate nan, not 5"),
        (missing, "springs.knee is not there"),
        (stray, "springs.stray is none of the scene"),
    ):
        with pytest.raises(EngineError, match=words):
            refuse_other_model(FOURBAR, state, replace(facts, springs=springs), DT_S, "prescribed")


def test_the_end_of_a_spring_is_on_a_body_that_carries_its_point() -> None:
    across = FOURBAR.springs["across"]
    (ground, place), (body, at) = line_ends(FOURBAR, across)
    assert (ground, place) == (GROUND, FOURBAR.ground["A"])
    assert (body, at) == ("coupler", FOURBAR.links["coupler"].points["C"])
    lost = replace(across, points=("A", "Z"))
    with pytest.raises(EngineError, match=r"springs\.across: no body carries point Z"):
        line_ends(FOURBAR, lost)
