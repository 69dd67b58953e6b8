"""What is no number is refused in words, by whatever takes times, angles or rates of a caller."""

from __future__ import annotations

import datetime
from collections.abc import Callable

import numpy as np
import pandas as pd
import pytest

from analytic.check import newton
from analytic.free.window_chain import ChainMotion
from analytic.kinematics import solve, solve_driven
from models.errors import CrankcheckError, EngineError
from models.files import load_scene
from models.laws import ConstantSpeed
from models.motion import Motion
from models.samples import numbers, samples
from models.window_chain import Chain
from sim.run import run

SCENE = load_scene("fourbar-lecture-1")
TIMES = np.linspace(0.0, 0.1, 3)
CHAIN = ChainMotion(Chain(2))
NOT_NUMBERS = {
    "text": (["a", "b"], "could not convert string to float: .*a"),
    "one text": ("soon", "could not convert string to float: .*soon"),
    "masked": (np.ma.masked_array([0.0, 1.0], [False, True]), "a masked array; give those that"),
    "durations": (np.array([0, 1], "m8[ms]"), r"durations \(timedelta64\[ms\]\); give floats"),
    "durations among objects": (np.array([np.timedelta64(1, "s")], object), "not 'datetime.timede"),
    "duration": ([datetime.timedelta(seconds=1)], "not 'datetime.timedelta'"),
    "durations of pandas": (pd.to_timedelta([1, 2], unit="s"), "durations"),
    "dates": (np.array(["2020-01-01"], "M8[D]"), "dates"),
    "complex": (np.array([1j]), "complex numbers"),
    "truths": (np.array([True]), "truths"),
    "nothing": ([None], "not 'NoneType'"),
    "missing": (pd.array([1.0, None], dtype="Float64"), "sample 1 is nan; give finite numbers"),
    "ragged": ([[0.0], [0.0, 1.0]], "inhomogeneous"),
    "set": ({1.0, 2.0}, "not 'set'"),
    "huge": ([10**400], "too large"),
    "infinite": ([0.0, np.inf], "sample 1 is inf; give finite numbers"),
    "table": (np.zeros((2, 2)), r"of shape \(2, 2\); give one dimension"),
    "none": ([], r"of shape \(0,\)"),
}
TAKING: dict[str, Callable[[object], Motion]] = {
    "solve": lambda values: solve(SCENE, values),
    "solve_driven": lambda values: solve_driven(SCENE, values, 1.0, 0.0),
    "newton": lambda values: newton.solve(SCENE, values, newton.Guess(GUESS)),
    "chain": CHAIN.motion,
}
START = solve(SCENE, 0.0).state()
GUESS = {
    name: (*START.position[next(iter(link.points))], START.theta[name])
    for name, link in SCENE.links.items()
}


@pytest.mark.parametrize("name", NOT_NUMBERS)
@pytest.mark.parametrize("taking", TAKING)
def test_what_is_no_number_is_refused_in_words(taking: str, name: str) -> None:
    values, words = NOT_NUMBERS[name]
    with pytest.raises(CrankcheckError, match=rf"^(time_s|theta)\b.*{words}"):
        TAKING[taking](values)


@pytest.mark.parametrize("taking", TAKING)
def test_times_of_a_motion_are_its_own(taking: str) -> None:
    given = TIMES.copy()
    motion = TAKING[taking](given)
    kept = motion.time_s.copy()
    given += 1.0
    np.testing.assert_array_equal(motion.time_s, kept)


def test_numbers_of_any_kind_are_taken() -> None:
    for values in (
        [0, 1],
        ["0", " 1.0"],
        np.array([0, 1], np.float32),
        range(2),
        pd.Series([0, 1]),
    ):
        np.testing.assert_array_equal(samples(values), [0.0, 1.0])
    np.testing.assert_array_equal(samples(3), [3.0])
    np.testing.assert_array_equal(numbers(np.array([1, 2.5], object), "x"), [1.0, 2.5])


@pytest.mark.parametrize("name", ["omega", "alpha", "time_s"])
def test_rates_of_another_number_are_refused(name: str) -> None:
    given = {"omega": TIMES, "alpha": TIMES, "time_s": TIMES}
    solve_driven(SCENE, TIMES, **given)
    for single in (1.0, [1.0], np.ones((1, 1))):
        solve_driven(SCENE, TIMES, **given | {name: single})
    with pytest.raises(CrankcheckError, match=rf"^{name} of shape \(2,\), theta of \(3,\); give"):
        solve_driven(SCENE, TIMES, **given | {name: TIMES[:2]})
    with pytest.raises(CrankcheckError, match=f"^{name}: found .*'x'"):
        solve_driven(SCENE, TIMES, **given | {name: ["x"] * 3})


def test_labels_of_a_driven_motion_are_its_own() -> None:
    given = TIMES.copy()
    motion = solve_driven(SCENE, TIMES, 1.0, 0.0, given)
    given += 1.0
    np.testing.assert_array_equal(motion.time_s, TIMES)


@pytest.mark.parametrize("number", ["1", None, np.timedelta64(1, "s"), 10**400, float("nan")])
def test_a_law_of_what_is_no_number_is_refused(number: object) -> None:
    with pytest.raises(ValueError, match=r"speed_rad_s is .*: a law of motion needs fin"):
        ConstantSpeed(0.0, number)


@pytest.mark.parametrize("wrong", [{"dt_s": "1e-3"}, {"steps": "9"}, {"every": None}])
def test_a_step_that_is_no_number_is_refused(wrong: dict[str, object]) -> None:
    asked = {"dt_s": 1e-3, "steps": 9, **wrong}
    with pytest.raises(EngineError, match=r"found .*; it takes a number"):
        run(SCENE, START, "pymunk", **asked)
