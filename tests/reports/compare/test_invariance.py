"""The same mechanism turned, moved, mirrored, scaled or sped up has the same pure errors."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from analytic.check.moved_scene import mirrored, moved, rotated, scaled
from models.files import load_scene
from models.scene import Scene
from reports.compare.errors import Errors
from reports.judge.cell import Cell, check
from tests.worlds.other_way import sped_up

CHANGES: dict[str, Callable[[Scene], Scene]] = {
    "rotated by 0.7 rad": lambda scene: rotated(scene, 0.7),
    "moved by (3, -2) m": lambda scene: moved(scene, (3.0, -2.0)),
    "mirrored": mirrored,
    "10 times as large": lambda scene: scaled(scene, 10.0),
    "a tenth as large": lambda scene: scaled(scene, 0.1),
    "turning the other way": lambda scene: sped_up(scene, -1.0),
    "at 500 rad/s": lambda scene: sped_up(scene, 50.0),
}
ROUNDING = 1e-10


@pytest.fixture(scope="module", params=["mujoco", "pymunk"])
def before(request: pytest.FixtureRequest, fourbar: Scene) -> tuple[str, Errors]:
    """An engine, and its errors of what is not changed."""
    return request.param, errors_of(fourbar, request.param)


def errors_of(scene: Scene, engine: str) -> Errors:
    cell = Cell(scene, engine, "tuned", scene.driver.law.period_s / 720, 720, converge=False)
    return check(cell).errors


@pytest.mark.parametrize("change", list(CHANGES))
def test_pure_errors_stay_within_a_factor_of_two(
    fourbar: Scene, change: str, before: tuple[str, Errors]
) -> None:
    engine, unchanged = before
    after = errors_of(CHANGES[change](fourbar), engine)
    compared = 0
    for quantity in ("drive", "angle", "position", "gap", "velocity", "acceleration"):
        old, new = unchanged.worst(quantity), after.worst(quantity)
        if old is None or new is None:
            assert old is new
            continue
        assert new.pure <= max(2.0 * old.pure, ROUNDING), quantity
        assert old.pure <= max(2.0 * new.pure, ROUNDING), quantity
        compared += 1
    assert compared >= 5


@pytest.mark.parametrize("engine", ["mujoco", "pymunk"])
def test_sliders_on_moving_lines_keep_their_pure_errors_when_turned(engine: str) -> None:
    scene = load_scene("shaper")
    before, after = (errors_of(s, engine) for s in (scene, rotated(scene, 0.7)))
    for quantity in ("angle", "displacement", "gap"):
        old, new = before.worst(quantity), after.worst(quantity)
        assert 0.5 < new.pure / old.pure < 2.0
