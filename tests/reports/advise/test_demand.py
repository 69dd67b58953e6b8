"""What may be asked for, the steps that follow from it, and what advice chooses from."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest

from models.errors import CrankcheckError
from models.files import load_scene
from models.laws import ConstantSpeed
from models.scene import Scene
from reports.advise.choices import OWN, Choice, choices
from reports.advise.demand import MOST_SUBSTEPS, Demand, at_speed, demanded
from reports.plan.steps import LEAST_STEPS_PER_TURN, MOST_SEARCHED
from reports.plan.study import load_study
from sim.registry import engine, usual
from sim.settings import resolved

FOURBAR = load_scene("fourbar-lecture-1")
CHOICE = Choice("fake", "tuned", "tuned", {})


def asked(*scenes: Scene, **changes: Any) -> Demand:
    """60 Hz at 10 rad/s, but for some of it."""
    numbers = {"speed_rad_s": 10.0, "frame_s": 1 / 60, "target": 1e-3, "turns": 10.0}
    return demanded(scenes or (FOURBAR,), **(numbers | changes))


def test_a_speed_takes_the_place_of_the_scenes_own() -> None:
    moved = at_speed(FOURBAR, -3.0)
    law = moved.driver.law
    assert isinstance(law, ConstantSpeed)
    assert (law.speed_rad_s, law.start_rad) == (-3.0, FOURBAR.driver.law.at(0.0)[0])  # type: ignore[arg-type]
    assert replace(moved, driver=FOURBAR.driver) == FOURBAR


def test_frames_and_sub_steps_are_counted_in_turns() -> None:
    demand = asked()
    assert demand.frames_per_turn == pytest.approx(37.699, rel=1e-4)
    cell = demand.cell(demand.scenes[0], CHOICE, 4)
    assert cell.dt_s == demand.frame_s / 4
    assert cell.steps == math.ceil(10 * 4 * demand.frames_per_turn)
    assert cell.turns >= 10.0
    longer = demand.cell(demand.scenes[0], CHOICE, 4, longer=8.0)
    assert longer.steps == 8 * cell.steps
    assert demand.cell(demand.scenes[0], CHOICE, 200, longer=8.0).steps == MOST_SEARCHED


@pytest.mark.parametrize(
    ("frame_s", "least"), [(1 / 60, 1), (math.tau / 80, 1), (math.tau / 79, 2), (1.0, 13)]
)
def test_a_turn_has_steps_enough_with_the_least_sub_steps(frame_s: float, least: int) -> None:
    demand = asked(frame_s=frame_s)
    assert demand.least == least
    assert demand.steps_per_turn(least) > LEAST_STEPS_PER_TURN * (1 - 1e-9)


@pytest.mark.parametrize("frame_s", [1e-5, 1e-3, 1 / 60, 1.0, 10.0])
def test_twice_the_most_sub_steps_are_still_run(frame_s: float) -> None:
    demand = asked(frame_s=frame_s, turns=1.0)
    assert demand.least <= demand.most <= MOST_SUBSTEPS
    assert demand.cell(demand.scenes[0], CHOICE, 2 * demand.most).steps <= MOST_SEARCHED


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"frame_s": 0.0}, "--dt 0: give a number above 0, in seconds for a frame"),
        ({"frame_s": -1.0}, "--dt -1: "),
        ({"frame_s": math.nan}, "--dt nan: "),
        ({"frame_s": math.inf}, "--dt inf: "),
        ({"speed_rad_s": 0.0}, "--speed 0: .* clockwise it is negative"),
        ({"speed_rad_s": math.nan}, "--speed nan: "),
        ({"speed_rad_s": -math.inf}, "--speed -inf: "),
        ({"target": 0.0}, "--target 0: give an error of place from 1e-11"),
        ({"target": 1.0}, "--target 1: .* to under 1"),
        ({"target": math.nan}, "--target nan: "),
        ({"turns": 0.5}, "--turns 0.5: give 1 turn"),
        ({"turns": math.inf}, "--turns inf: "),
        ({"frame_s": 1e4}, "--dt 10000: .* even in 4096 sub-steps; give one of 322 s at most"),
        ({"turns": 1e4}, "--turns 10000: 376991 frames, 37.7 in .*: take --turns 2.65e.03, or"),
        ({"frame_s": 1e-9}, "at most 100000 steps are run: ask for a longer frame"),
        ({"speed_rad_s": 1e-9}, "at most 100000 steps are run: ask for"),
    ],
)
def test_what_can_not_be_asked_for_is_told(changes: dict[str, float], words: str) -> None:
    with pytest.raises(CrankcheckError, match=words):
        asked(**changes)


def test_the_longest_frame_that_a_message_names_is_taken_and_no_driver_of_another_law() -> None:
    assert asked(frame_s=321.0, turns=2.0).least <= MOST_SUBSTEPS
    assert asked(turns=2650.0).least == 1
    with pytest.raises(CrankcheckError, match=r'fourbar-double-rocker.*law = "constant"'):
        asked(FOURBAR, load_scene("fourbar-double-rocker"))


def test_all_profiles_and_the_variants_of_the_shipped_study_are_there() -> None:
    every = choices(usual(), ())
    labels = sorted(choice.label for choice in every)
    for name in usual():
        assert {f"{name} {profile}" for profile in engine(name).profiles} <= {*labels}
    variants = [one for each in load_study(None).variants for one in each.each()]
    assert labels == sorted(f"{one.engine} {one.name}" for one in variants)
    for choice in every:
        assert choice.settings.keys() == engine(choice.engine).profiles["tuned"].settings.keys()


def test_a_variant_like_another_choice_is_left_out_and_one_of_its_name_told_apart() -> None:
    settings = resolved(engine("pymunk").profiles["tuned"], {"iterations": 77})
    same = Choice("pymunk", "alias", "tuned", resolved(engine("pymunk").profiles["tuned"], None))
    mine = Choice("pymunk", "no bias", "tuned", settings)
    plain = choices(["pymunk"], ())
    every = choices(["pymunk"], (same, mine, replace(mine, name="twice")))
    (added,) = [choice for choice in every if choice not in plain]
    assert (added.name, added.settings) == ("no bias (study)", settings)


def test_words_tell_what_is_not_as_shipped_of_the_engines_asked_for_alone() -> None:
    words = {choice.label: choice.words for choice in choices(["pymunk"], ())}
    assert {label.split()[0] for label in words} == {"pymunk"}
    assert words["pymunk as-shipped"] == OWN
    assert words["pymunk no bias"] == "error_bias 0"
