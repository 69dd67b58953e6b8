"""A run that is not the one that was requested is refused, by the field that differs; and what is
nearer to the reference than an engine can come was taken from it."""

from collections.abc import Callable
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import pytest

from analytic.kinematics import solve
from models.files.reading import load_scene, shipped
from models.scene import Scene
from reports.compare.compare import not_asked_for
from reports.compare.errors import Error
from reports.compare.hardness import uneven, unevenly_turned
from reports.judge.cell import Cell, CellRunner, examined
from reports.judge.rules.reference import LEAST, too_good
from reports.selftest.fault import integrates
from sim.engine import Run
from sim.engine.settings import resolved
from sim.registry import engine
from sim.run import run, setup
from tests.worlds.engines import FULL
from tests.worlds.facts import with_facts
from tests.worlds.fake.engine import FakeEngine
from tests.worlds.tiers import few
from tests.worlds.turns import of_turns

FOURBAR = load_scene("fourbar-lecture-1")


def cell(scene: Scene | str, name: str, **more: Any) -> Cell:
    return of_turns(scene, name, 180, **{"converge": True, **more})


def said(asked: Cell, *runner: CellRunner) -> str:
    """What the rule says where it fails; empty where it passes."""
    checked = examined(asked, *runner)[0]
    return next((f.text for f in checked.failures if f.rule == "CC117"), "")


@pytest.mark.parametrize("name", FULL)
@pytest.mark.parametrize("drive", ["prescribed", "servo"])
@pytest.mark.parametrize("profile", ["tuned", "as-shipped"])
def test_the_run_asked_for_is_taken(name: str, profile: str, drive: str) -> None:
    assert said(cell("shaper", name, profile=profile, drive=drive)) == ""


FIELDS: dict[str, Any] = {
    "scene": "another", "engine": "another", "version": "0.0", "profile": "another",
    "drive": "servo", "dt_s": 2e-3, "steps": 61, "every": 2, "start_s": 1e-3,
    "reports_accelerations": None, "asked": {}, "settings": {},
}  # fmt: skip


@pytest.mark.parametrize("field", FIELDS)
def test_every_word_of_a_run_is_held_to_the_request(field: str) -> None:
    state = solve(FOURBAR, np.zeros(1)).state()
    options: dict[str, Any] = {"dt_s": 1e-3, "steps": 60}
    asked = setup(FOURBAR, state, "pymunk", **options)
    held = engine("pymunk").holds(asked.asked, 1e-3, "prescribed")
    done = run(FOURBAR, state, "pymunk", **options)
    assert not_asked_for(done, asked, held, FOURBAR, state) == []
    texts = not_asked_for(replace(done, **{field: FIELDS[field]}), asked, held, FOURBAR, state)
    assert texts
    word = "setting" if field in ("asked", "settings") else field
    end = {"setting": "the run has none", "profile": "requested 'tuned', the run has 'another'"}
    assert all(text.startswith(word) for text in texts), texts
    assert all(text.endswith(end.get(word, "")) for text in texts), texts


C_M = 0.37885
"""How far the pin is from the origin at the start, which is more than the longest link."""


@pytest.mark.parametrize(
    ("kind", "body", "place", "share", "unit"),
    [
        ("links", "rod", "theta", 1.0, "rad"),
        ("points", "C", "position", 2**0.5 / C_M, "L"),  # along both axes
        ("sliders", "C", "displacement", 1.0 / C_M, "L"),
    ],
)
def test_a_wrong_start_is_named(kind: str, body: str, place: str, share: float, unit: str) -> None:
    size = 2e-9

    def moved(*args: Any, **options: Any) -> Run:
        done = run(*args, **options)
        own = getattr(done.motion, kind)
        off = replace(own[body], **{place: getattr(own[body], place) + size})
        return replace(done, motion=replace(done.motion, **{kind: {**own, body: off}}))

    found = said(cell("slider-crank-offset", "pymunk", converge=False), moved)
    assert f"start: {kind[:-1]} {body} has an error of {share * size:.2g} {unit}" in found


@pytest.mark.parametrize("name", [name for name in FULL if integrates(name)])
@pytest.mark.parametrize("part", [1, 2])
def test_a_finer_run_is_a_run_of_its_own(name: str, part: int) -> None:
    """With its step cut into so many parts a run stands in place of the others, with their
    words."""

    def again(*args: Any, dt_s: float, steps: int, every: int, **options: Any) -> Run:
        if every == 1:
            return run(*args, dt_s=dt_s, steps=steps, every=every, **options)
        cut = {"dt_s": dt_s * every / part, "steps": steps // every * part, "every": part}
        done = run(*args, **cut, **options)
        settings = {**done.settings, **engine(done.engine).holds(done.asked, dt_s, done.drive)}
        return replace(done, dt_s=dt_s, steps=steps, every=every, settings=settings)

    found = said(cell(FOURBAR, name), again)
    assert "finer run: requested dt" in found
    assert found.count("the places are those of dt") == (2 if part == 1 else 1)


def test_the_words_of_a_finer_run_are_held_to_the_request_too() -> None:
    def other(*args: Any, **options: Any) -> Run:
        done = run(*args, **options)
        return replace(done, version="3.0") if options["every"] > 1 else done

    found = said(cell(FOURBAR, "mujoco"), other)
    assert all(f"finer run, dt / {parts}: version: requested '" in found for parts in (2, 4))


def test_the_bodies_that_a_four_bar_moves_unevenly_are_all_but_its_crank() -> None:
    law = FOURBAR.driver.law
    turn = np.linspace(0.0, law.period_s, 361)
    found, short = (
        uneven(FOURBAR, solve(FOURBAR, time_s), law.at(time_s)[0]) for time_s in (turn, turn[:12])
    )
    assert set(found) == {("link", "coupler"), ("link", "rocker"), ("point", "C")}
    assert all(0.05 < far <= 1.0 for far in found.values())
    assert unevenly_turned(FOURBAR, found) == set(found)
    assert short == {}  # a short stretch says nothing


@pytest.mark.parametrize(
    "each",
    few(shipped(), {FOURBAR.name, "tangent"}, "another body comes nearest in each"),
)
def test_no_body_of_a_shipped_scene_comes_near_what_is_too_good(each: str) -> None:
    """With room for a factor of ten, so that no setting that somebody finds is blamed."""
    scene = load_scene(each)  # once: its truth is found once
    for name, profile, steps in product(FULL, ("tuned", "as-shipped"), (45, 720)):
        errors = examined(of_turns(scene, name, steps, profile=profile))[0].errors
        assert errors.of_scene.uneven
        wide = {body: 10.0 * far for body, far in errors.of_scene.uneven.items()}
        adapter = engine(name)
        placing = adapter.placing(resolved(adapter.profiles[profile], None))
        assert too_good(with_facts(errors, uneven=wide), placing, adapter.order) == []


@pytest.mark.parametrize("share", [0.9, 1.1])
def test_a_widest_gap_that_no_step_leaves_is_too_good_of_uneven_motion(share: float) -> None:
    errors = examined(of_turns(FOURBAR))[0].errors
    least = LEAST * errors.of_scene.step_rad**2 * max(errors.of_scene.uneven.values())
    gaps = (row for row in errors.rows if row.quantity == "gap")
    rows = tuple(replace(row, maximum=share * least * row.scale) for row in gaps)
    found = too_good(replace(errors, rows=rows), "integrated", 2)
    assert [row.quantity for row in found] == ["gap"] * (share < 1.0)
    assert too_good(with_facts(errors, rows=rows, uneven={}), "integrated", 2) == []


def verdict_of(runner: Callable[..., Run]) -> dict[str, str]:
    return {f.rule: f.text for f in examined(of_turns(FOURBAR), runner)[0].failures}


def exactly(scene: Scene, state: Any, _: str, *rest: Any, **asked: Any) -> Run:
    """An engine that solves its joints runs in the place of any."""
    return run(scene, state, FakeEngine(), *rest, **asked)


def test_rounding_is_no_fault_where_joints_are_solved(monkeypatch: pytest.MonkeyPatch) -> None:
    seen = verdict_of(exactly)
    assert "integration has an error of step^2" in seen["CC111"]
    monkeypatch.setattr("reports.judge.cell.engine", lambda _: FakeEngine())
    assert "CC111" not in verdict_of(exactly)


@pytest.mark.parametrize("spared", [None, "coupler"])
def test_exact_rates_are_too_good(monkeypatch: pytest.MonkeyPatch, spared: str | None) -> None:
    def taken(*args: Any, **options: Any) -> Run:
        done = exactly(*args, **options)
        true = solve(FOURBAR, done.motion.time_s)
        own = {n: link for n, link in done.motion.links.items() if n == spared}
        return replace(done, motion=replace(done.motion, links={**true.links, **own}))

    monkeypatch.setattr("reports.judge.cell.engine", lambda _: FakeEngine())
    found = verdict_of(taken)["CC111"]
    assert "link rocker" in found
    assert ("link coupler" in found) == (spared is None)
    assert "separately computed rates round differently" in found


@pytest.mark.parametrize("moved", [0.0, 1e-3])
def test_forces_of_solved_places_are_too_good_for_accelerations_that_are_off(moved: float) -> None:
    """An engine whose accelerations are right may have its forces from these, as inverse dynamics
    has; one whose are not, has them of somebody else."""
    errors = examined(of_turns(FOURBAR, "exudyn", with_forces=True))[0].errors

    def sized(size: float, *quantities: str) -> list[Error]:
        rows = (row for row in errors.rows if row.quantity in quantities)
        return [replace(row, maximum=size * row.scale) for row in rows]

    forces = sized(1e-13, "reaction", "torque")
    rows = (*forces, *sized(moved, "acceleration"), *sized(1e-9, "velocity"))
    assert bool(too_good(replace(errors, rows=rows), "solved", 2)) == bool(moved)
    assert too_good(errors, "solved", 2) == []
