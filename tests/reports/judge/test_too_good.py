"""What is nearer to the reference than an engine can come was taken from it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import product
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from analytic.kinematics import solve
from models.files import load_scene, shipped
from models.laws import ConstantSpeed
from models.scene import Scene
from reports.compare.errors import Error
from reports.compare.uneven import uneven
from reports.judge.cell import examined
from reports.judge.rules import RULES
from reports.judge.too_good import LEAST, too_good
from sim.engine import Run
from sim.registry import ENGINES, engine
from sim.run import run
from sim.settings import resolved
from tests.worlds.tiers import few
from tests.worlds.turns import of_turns

FOURBAR = load_scene("fourbar-lecture-1")


def uneven_in(scene: Scene, part: slice = slice(None)) -> dict[tuple[str, str], float]:
    """What moves unevenly in a part of a turn."""
    law = scene.driver.law
    time_s = np.linspace(0.0, law.period_s, 361)[part]
    return uneven(scene, solve(scene, time_s), law.at(time_s)[0])


def test_the_bodies_that_a_four_bar_moves_unevenly_are_all_but_its_crank() -> None:
    found = uneven_in(FOURBAR)
    assert set(found) == {("link", "coupler"), ("link", "rocker"), ("point", "C")}
    assert all(0.05 < far <= 1.0 for far in found.values())
    assert uneven_in(FOURBAR, slice(12)) == {}  # a short stretch says nothing


def test_nothing_of_a_parallelogram_moves_unevenly() -> None:
    links = {
        name: replace(link, points={n: (side * x, side * y) for n, (x, y) in link.points.items()})
        for (name, link), side in zip(FOURBAR.links.items(), (1.0, 1.2, 1 / 2), strict=True)
    }
    lengths = [max(x for x, _ in link.points.values()) for link in links.values()]
    assert lengths == pytest.approx([0.1, 0.3, 0.1])
    assert uneven_in(replace(FOURBAR, links=links), slice(20, 160)) == {}


def test_a_law_that_swings_is_looked_at_like_any_other() -> None:
    scene = load_scene("fourbar-double-rocker")
    assert not isinstance(scene.driver.law, ConstantSpeed)
    assert ("link", "rocker") in uneven_in(scene)


@pytest.mark.parametrize(
    "each",
    few(shipped(), {FOURBAR.name, "shaper", "tangent"}, "another body comes nearest in each"),
)
def test_no_body_of_a_shipped_scene_comes_near_what_is_too_good(each: str) -> None:
    """With room for a factor of ten, so that no setting that somebody finds is blamed."""
    for name, profile, steps in product(ENGINES, ("tuned", "as-shipped"), (45, 720)):
        errors = examined(of_turns(each, name, steps, profile=profile))[0].errors
        assert errors.uneven
        wide = {body: 10.0 * far for body, far in errors.uneven.items()}
        adapter = engine(name)
        placing = adapter.placing(resolved(adapter.profiles[profile], None))
        assert too_good(replace(errors, uneven=wide), placing, adapter.order) == []


def verdict_of(runner: Callable[..., Run]) -> dict[str, str]:
    return {f.rule: f.text for f in examined(of_turns(FOURBAR), runner)[0].failures}


def exactly(fake_engine: ModuleType) -> Callable[..., Run]:
    """An engine that solves its joints runs in the place of any."""
    fake = fake_engine.FakeEngine()
    return lambda scene, state, _, *rest, **asked: run(scene, state, fake, *rest, **asked)


def test_at_rounding_is_no_fault_of_an_engine_that_solves_its_joints(
    fake_engine: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen = verdict_of(exactly(fake_engine))
    assert "what is integrated is off by step^2" in seen["CC111"]
    monkeypatch.setattr("reports.judge.cell.engine", lambda _: fake_engine.FakeEngine())
    assert "CC111" not in verdict_of(exactly(fake_engine))


@pytest.mark.parametrize("spared", [None, "coupler"])
def test_rates_that_are_the_references_are_too_good_of_any_engine(
    fake_engine: ModuleType, monkeypatch: pytest.MonkeyPatch, spared: str | None
) -> None:
    def taken(*args: Any, **options: Any) -> Run:
        done = exactly(fake_engine)(*args, **options)
        true = solve(FOURBAR, done.motion.time_s)
        own = {n: link for n, link in done.motion.links.items() if n == spared}
        return replace(done, motion=replace(done.motion, links={**true.links, **own}))

    monkeypatch.setattr("reports.judge.cell.engine", lambda _: fake_engine.FakeEngine())
    found = verdict_of(taken)["CC111"]
    assert "link rocker" in found
    assert ("link coupler" in found) == (spared is None)
    assert "rates are rounded in another way" in found


@pytest.mark.parametrize("digits", [6, 8, 10])
def test_an_angle_of_few_digits_is_no_error_of_an_engine(digits: int) -> None:
    def rounded(*args: Any, **options: Any) -> Run:
        done = run(*args, **options)
        true = solve(FOURBAR, done.motion.time_s).links["rocker"]
        links = {**done.motion.links, "rocker": replace(true, theta=np.round(true.theta, digits))}
        return replace(done, motion=replace(done.motion, links=links))

    failed = verdict_of(rounded)
    assert {"CC118", "CC111"} & set(failed), failed


def test_least_is_far_above_rounding_at_the_steps_of_verify() -> None:
    assert LEAST * (2.0 * np.pi / 360) ** 2 > 1e-9
    assert RULES["CC111"].cure


@pytest.mark.parametrize("moved", [0.0, 1e-3])
def test_forces_where_places_are_solved_are_too_good_for_accelerations_that_are_off(
    moved: float,
) -> None:
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
