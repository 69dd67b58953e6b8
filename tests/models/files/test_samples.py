"""What callers give: what is no number is refused in words, one name is a name and no collection of
its letters; and motions one after the other.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from analytic.free.exact_motions import ChainMotion
from analytic.kinematics import solve, solve_driven
from models.array import numbers, samples
from models.errors import CrankcheckError, EngineError
from models.files.inputs import names_in
from models.files.reading import load_scene, scene_texts
from models.mjcf.document import build
from models.mjcf.options import Writing
from models.motion import Crossing, Motion
from models.scene.hard import WindowChain
from models.scene.laws import ConstantSpeed
from reports.plan.requirements import chosen_engines, chosen_profiles, chosen_scenes
from sim.run import run

SCENE = load_scene("fourbar-lecture-1")
TIMES = np.linspace(0.0, 0.1, 3)
CHAIN = ChainMotion(WindowChain(2))
NOT_NUMBERS = {
    "text": (["a", "b"], "could not convert string to float: .*a"),
    "masked": (np.ma.masked_array([0.0, 1.0], [False, True]), "a masked array; give those that"),
    "durations": (np.array([0, 1], "m8[ms]"), r"durations \(timedelta64\[ms\]\); give floats"),
    "durations among objects": (np.array([np.timedelta64(1, "s")], object), "not 'datetime.timede"),
    "dates": (np.array(["2020-01-01"], "M8[D]"), "dates"),
    "complex": (np.array([1j]), "complex numbers"),
    "truths": (np.array([True]), "truths"),
    "missing": (pd.array([1.0, None], dtype="Float64"), "sample 1 is nan; give finite numbers"),
    "ragged": ([[0.0], [0.0, 1.0]], "inhomogeneous"),
    "infinite": ([0.0, np.inf], "sample 1 is inf; give finite numbers"),
    "table": (np.zeros((2, 2)), r"of shape \(2, 2\); give one dimension"),
    "none": ([], r"of shape \(0,\)"),
}
TAKING: dict[str, Callable[[object], Motion]] = {
    "solve": lambda values: solve(SCENE, values),
    "solve_driven": lambda values: solve_driven(SCENE, values, 1.0, 0.0),
    "chain": CHAIN.motion,
}
START = solve(SCENE, 0.0).state()


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


def test_a_law_or_a_step_of_what_is_no_number_is_refused() -> None:
    for number in ("1", None, np.timedelta64(1, "s"), 10**400, float("nan")):
        with pytest.raises(ValueError, match=r"speed_rad_s is .*: a law of motion needs fin"):
            ConstantSpeed(0.0, number)
    asked = {"dt_s": 1e-3, "steps": 9}
    for wrong in ({"dt_s": "1e-3"}, {"steps": "9"}, {"every": None}):
        with pytest.raises(EngineError, match=r"found .*; it takes a number"):
            run(SCENE, START, "pymunk", **asked | wrong)


def test_numbers_of_any_kind_are_taken() -> None:
    single = np.array([0, 1], np.float32)
    for values in ([0, 1], ["0", " 1.0"], single, range(2), pd.Series([0, 1])):
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


SHAPER = load_scene("shaper")


@pytest.mark.parametrize("given", [{"links": "crank"}, {"points": "B"}, {"sliders": "F"}])
def test_one_name_is_one_body_and_several_are_several(given: dict[str, str]) -> None:
    ((kind, name),) = given.items()
    for motion in (solve(SHAPER, 0.1, **given), solve_driven(SHAPER, 1.0, 1.0, 0.0, **given)):
        assert list(getattr(motion, kind)) == [name]
    with pytest.raises(CrankcheckError, match=f"{kind[:-1]} 'crunk' is not in the scene; it has"):
        solve(SHAPER, 0.1, **{kind: "crunk"})
    motion = solve(SHAPER, np.zeros(1), links=iter(["crank"]), points=(), sliders=["F"])
    assert (list(motion.links), list(motion.points), list(motion.sliders)) == (["crank"], [], ["F"])


def test_one_name_is_one_scene_engine_profile_or_pin() -> None:
    assert list(scene_texts("shaper")) == ["shaper"]
    assert [scene.name for scene in chosen_scenes("shaper")] == ["shaper"]
    assert chosen_engines("pymunk") == ["pymunk"]
    assert chosen_profiles("tuned", ["pymunk"]) == [("tuned", True)]
    words = r"links: found .*; give a name, or a list of names"
    for given in (1, None, [1], ["a", None]):
        with pytest.raises(CrankcheckError, match=words):
            names_in(given, "links")
    assert build(SCENE, START, Writing(close="C")) == build(SCENE, START, Writing(close=("C",)))
    with pytest.raises(CrankcheckError, match="CD"):
        build(SCENE, START, Writing(close="CD"))


LATER = np.linspace(0.0, 0.3, 7)


def test_parts_of_a_motion_joined_are_the_whole() -> None:
    scene = load_scene("slider-crank-offset")
    whole = solve(scene, LATER)
    parts = [solve(scene, times) for times in (LATER[:2], LATER[2:3], LATER[3:])]
    joined = Motion.joined(parts)
    assert (joined.time_s == LATER).all()
    for own, other in ((joined, whole), (joined.bound, whole.bound)):
        for kind in ("links", "points", "sliders"):
            assert getattr(own, kind).keys() == getattr(other, kind).keys()
            for name, body in getattr(own, kind).items():
                for key, series in vars(body).items():
                    wanted = getattr(getattr(other, kind)[name], key)
                    np.testing.assert_allclose(series, wanted, rtol=1e-9, atol=1e-12)
    shapes = [{k: x.shape for k, x in one.conditioning.items()} for one in (joined, whole)]
    assert shapes[0] == shapes[1]


def test_what_a_part_lacks_is_left_out_and_change_points_of_all_are_kept_once() -> None:
    motion = solve(load_scene("fourbar-lecture-1"), LATER)
    bare = replace(motion, points={}, conditioning={}, bound=None)
    for parts in ([motion, bare], [bare, motion]):
        joined = Motion.joined(parts)
        assert (joined.points, joined.conditioning) == ({}, {})
        assert joined.bound is joined.forces is None
        assert joined.links["crank"].theta.shape == (14,)
    one, other = Crossing("C", 0.1), Crossing("C", 3.2)
    parts = [replace(motion, crossings=seen) for seen in ((one,), (one, other), ())]
    assert Motion.joined(parts).crossings == (one, other)
