"""One name is a name, and no collection of its letters."""

from __future__ import annotations

import numpy as np
import pytest

from analytic.kinematics import solve, solve_driven
from models.errors import CrankcheckError
from models.files import load_scene, scene_texts
from models.mjcf import build
from models.mjcf_options import Writing
from models.one_or_more import names_in
from reports.plan.chosen import chosen_engines, chosen_profiles, chosen_scenes

SCENE = load_scene("shaper")


@pytest.mark.parametrize("given", [{"links": "crank"}, {"points": "B"}, {"sliders": "F"}])
def test_one_name_is_one_body(given: dict[str, str]) -> None:
    ((kind, name),) = given.items()
    for motion in (solve(SCENE, 0.1, **given), solve_driven(SCENE, 1.0, 1.0, 0.0, **given)):
        assert list(getattr(motion, kind)) == [name]
    with pytest.raises(CrankcheckError, match=f"{kind[:-1]} 'crunk' is not in the scene; it has"):
        solve(SCENE, 0.1, **{kind: "crunk"})


def test_several_names_are_several() -> None:
    motion = solve(SCENE, np.zeros(1), links=iter(["crank"]), points=(), sliders=["F"])
    assert (list(motion.links), list(motion.points), list(motion.sliders)) == (["crank"], [], ["F"])


def test_a_pin_to_close_a_loop_at_may_have_a_long_name() -> None:
    scene = load_scene("fourbar-lecture-1")
    start = solve(scene, 0.0).state()
    assert build(scene, start, Writing(close="C")) == build(scene, start, Writing(close=("C",)))
    with pytest.raises(CrankcheckError, match="CD"):
        build(scene, start, Writing(close="CD"))


def test_one_scene_engine_or_profile_is_one() -> None:
    assert list(scene_texts("shaper")) == ["shaper"]
    assert [scene.name for scene in chosen_scenes("shaper")] == ["shaper"]
    assert chosen_engines("pymunk") == ["pymunk"]
    assert chosen_profiles("tuned", ["pymunk"]) == [("tuned", True)]


@pytest.mark.parametrize("given", [1, None, [1], ["a", None]])
def test_what_is_no_name_is_refused(given: object) -> None:
    with pytest.raises(CrankcheckError, match=r"links: found .*; give a name, or a list of names"):
        names_in(given, "links")
