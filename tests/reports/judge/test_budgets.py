"""The default tolerances: tight at every step size, for both engines, on easy and hard scenes."""

from __future__ import annotations

import pytest

from models.files import load_scene, shipped
from reports.judge.cell import Cell, check

LIMITED = {"CC102", "CC103", "CC104", "CC105", "CC106", "CC107", "CC108", "CC113", "CC114"}


@pytest.mark.parametrize("engine", ["mujoco", "pymunk"])
@pytest.mark.parametrize("name", ["fourbar-lecture-1", "slider-crank-excel-210", "whitworth"])
def test_an_error_takes_the_same_share_of_its_limit_at_every_step(name: str, engine: str) -> None:
    scene = load_scene(name)
    shares = []
    for steps in (180, 1440):
        dt_s = scene.driver.law.period_s / steps
        cell = Cell(scene, engine, "tuned", dt_s, steps, converge=False)
        found = {f.rule: f for f in check(cell).findings if f.rule in LIMITED}
        assert all(f.level == "pass" for f in found.values()), found
        shares.append(
            {rule: f.number / f.limit for rule, f in found.items() if f.number and f.limit}
        )
        assert max(shares[-1].values()) < 0.6
    if engine == "pymunk":  # second order throughout, so the share shows that the budget is too
        for rule in ("CC103", "CC105", "CC113"):
            assert shares[1][rule] == pytest.approx(shares[0][rule], rel=0.4)


@pytest.mark.parametrize("engine", ["mujoco", "pymunk"])
@pytest.mark.parametrize("name", list(shipped()))
def test_every_shipped_scene_is_within_tolerance_at_ninety_steps_a_turn(
    name: str, engine: str
) -> None:
    scene = load_scene(name)
    period = scene.driver.law.period_s
    found = check(Cell(scene, engine, "tuned", period / 90, 180, converge=False))
    assert found.verdict == "within", found.failures


def test_half_a_permille_of_a_links_length_is_more_than_the_budget_of_its_angles() -> None:
    scene = load_scene("fourbar-lecture-1")
    period = scene.driver.law.period_s
    found = check(Cell(scene, "pymunk", "tuned", period / 720, 720, converge=False))
    assert found.limits["angle"].number < 5e-4 / 2
