"""A run that is not the one that was asked for is refused, by the field that differs."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from analytic.kinematics import solve
from models.files import load_scene
from models.friction import ConstantFriction
from reports.compare.asked import not_asked_for
from reports.judge.cell import Cell, CellRunner, examined
from reports.selftest.fault import integrates
from sim.engine import Run
from sim.registry import ENGINES, engine
from sim.run import run, setup
from tests.worlds.tiers import few
from tests.worlds.turns import of_turns

EVERY = pytest.mark.parametrize("name", ENGINES)
SCENES = pytest.mark.parametrize(
    "scene",
    few(
        ("fourbar-lecture-1", "slider-crank-offset", "shaper"),
        {"fourbar-lecture-1"},
        "blocks and several loops, which make other models of the same settings",
    ),
)


def cell(scene: str, name: str, **more: Any) -> Cell:
    return of_turns(scene, name, 180, **{"converge": True, **more})


def said(asked: Cell, *runner: CellRunner) -> str:
    """What the rule says where it fails; empty where it passes."""
    checked = examined(asked, *runner)[0]
    return next((f.text for f in checked.failures if f.rule == "CC117"), "")


@EVERY
@pytest.mark.parametrize("drive", ["prescribed", "servo"])
@pytest.mark.parametrize("profile", ["tuned", "as-shipped"])
@SCENES
def test_the_run_that_was_asked_for_is_taken(
    scene: str, name: str, profile: str, drive: str
) -> None:
    assert said(cell(scene, name, profile=profile, drive=drive)) == ""


FIELDS: dict[str, Any] = {
    **dict.fromkeys(("scene", "engine", "profile"), "another"),
    "version": "0.0",
    "drive": "servo",
    "dt_s": 2e-3,
    "steps": 61,
    "every": 2,
    "start_s": 1e-3,
    "reports_accelerations": None,
    "asked": {},
    "settings": {},
}


@EVERY
@pytest.mark.parametrize("field", FIELDS)
def test_every_word_of_a_run_is_held_to_the_request(field: str, name: str) -> None:
    scene = load_scene("fourbar-lecture-1")
    state = solve(scene, np.zeros(1)).state()
    options: dict[str, Any] = {"dt_s": 1e-3, "steps": 60}
    asked = setup(scene, state, name, **options)
    held = engine(name).holds(asked.asked, 1e-3, "prescribed")
    done = run(scene, state, name, **options)
    assert not_asked_for(done, asked, held, scene, state) == []
    texts = not_asked_for(replace(done, **{field: FIELDS[field]}), asked, held, scene, state)
    assert texts
    word = "setting" if field in ("asked", "settings") else field
    assert all(text.startswith(word) for text in texts), texts


@pytest.mark.parametrize("size", [2e-9, 1e-3])
@pytest.mark.parametrize(
    ("kind", "body", "place"),
    [("links", "rod", "theta"), ("points", "C", "position"), ("sliders", "C", "displacement")],
)
def test_a_body_that_begins_elsewhere_is_named(
    kind: str, body: str, place: str, size: float
) -> None:
    def moved(*args: Any, **options: Any) -> Run:
        done = run(*args, **options)
        own = getattr(done.motion, kind)
        off = replace(own[body], **{place: getattr(own[body], place) + size})
        return replace(done, motion=replace(done.motion, **{kind: {**own, body: off}}))

    found = said(cell("slider-crank-offset", "pymunk", converge=False), moved)
    assert f"start: {kind[:-1]} {body} begins" in found


def again(part: int) -> CellRunner:
    """The run with its step cut into ``part`` stands in the place of the others, with their
    words."""

    def runner(*args: Any, dt_s: float, steps: int, every: int, **options: Any) -> Run:
        if every == 1:
            return run(*args, dt_s=dt_s, steps=steps, every=every, **options)
        cut = {"dt_s": dt_s * every / part, "steps": steps // every * part, "every": part}
        done = run(*args, **cut, **options)
        settings = {**done.settings, **engine(done.engine).holds(done.asked, dt_s, done.drive)}
        return replace(done, dt_s=dt_s, steps=steps, every=every, settings=settings)

    return runner


@pytest.mark.parametrize("name", [name for name in ENGINES if integrates(name)])
@SCENES
@pytest.mark.parametrize("part", [1, 2])
def test_a_finer_run_is_a_run_of_its_own(scene: str, name: str, part: int) -> None:
    found = said(cell(scene, name), again(part))
    assert "finer run: asked for dt" in found
    assert found.count("the places are those of dt") == (2 if part == 1 else 1)


def test_the_words_of_a_finer_run_are_held_to_the_request_too() -> None:
    def other(*args: Any, **options: Any) -> Run:
        done = run(*args, **options)
        return replace(done, version="3.0") if options["every"] > 1 else done

    found = said(cell("shaper", "mujoco"), other)
    assert "finer run, dt / 2: version: asked for '" in found
    assert "finer run, dt / 4: version: asked for '" in found


def test_the_iterations_that_friction_needs_are_told_beside_those_asked_for() -> None:
    scene = load_scene("fourbar-lecture-1")
    rubbing = replace(scene, friction={"D": ConstantFriction("D", 0.05)})
    checked, done = examined(replace(cell("fourbar-lecture-1", "mujoco"), scene=rubbing))
    assert (done.settings["iterations"], done.settings["iterations_of_friction"]) == (2, 20)
    assert "CC117" not in {finding.rule for finding in checked.failures}
