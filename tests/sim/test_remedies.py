"""What an engine has against a run that fails are settings that it takes, each another one."""

from __future__ import annotations

import numpy as np
import pytest

from analytic.kinematics import solve
from models.files import load_scene
from sim.registry import engine, offering
from sim.remedies import remedies
from sim.settings import profile_of, resolved


@pytest.mark.parametrize("name", offering("remedies"))
@pytest.mark.parametrize("scene_name", ["fourbar-lecture-1", "sixbar-watt", "shaper"])
def test_every_remedy_opens_and_none_is_what_tuned_has(name: str, scene_name: str) -> None:
    scene = load_scene(scene_name)
    start = solve(scene, np.zeros(1)).state()
    chosen = engine(name)
    tuned = resolved(profile_of(chosen, "tuned"), {})
    held = [chosen.open(scene, start, tuned, 1e-3, "prescribed").facts().settings]
    for remedy in remedies(name, scene, start, tuned):
        settings = resolved(profile_of(chosen, "tuned"), remedy)
        facts = chosen.open(scene, start, settings, 1e-3, "prescribed").facts()
        assert facts.settings not in held
        held.append(facts.settings)
    assert len(held) > 2


@pytest.mark.parametrize("name", offering("remedies"))
def test_no_remedy_is_what_there_is_or_less(name: str) -> None:
    scene = load_scene("sixbar-watt")
    start = solve(scene, np.zeros(1)).state()
    tuned = resolved(profile_of(engine(name), "tuned"), {})
    for remedy in remedies(name, scene, start, tuned):
        left = remedies(name, scene, start, {**tuned, **remedy})
        assert remedy not in left
        assert len(left) < len(remedies(name, scene, start, tuned))


def test_several_pins_are_named_with_plus_or_comma_between() -> None:
    scene = load_scene("sixbar-watt")
    start = solve(scene, np.zeros(1)).state()
    for text in ("B+G", "B,G", " B , G "):
        settings = resolved(profile_of(engine("mujoco"), "tuned"), {"close": text})
        session = engine("mujoco").open(scene, start, settings, 1e-3, "prescribed")
        assert set(str(session.facts().settings["close"]).split(", ")) == {"B", "G"}
