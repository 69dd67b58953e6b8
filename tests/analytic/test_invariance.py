"""A mechanism turned, moved, mirrored, scaled or sped up moves as it did before."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from analytic.check import moved_scene as transform
from analytic.check.moved_scene import mirrored
from analytic.dyads.plane import EPS
from analytic.kinematics import solve
from models.array import Array
from models.files import load_scene, shipped
from models.laws import ConstantSpeed
from models.motion import Motion
from models.scene import Scene
from tests.worlds.other_way import sped_up
from tests.worlds.strategies import swing_times


def _allowed(a: Array, b: Array) -> Array:
    """Twice both bounds: the changed scene has other roundings in its lengths."""
    return 2.0 * (a + b)


def _assert_same(
    old: Motion, new: Motion, turn: float, grow: float, fast: float, flip: bool
) -> None:
    """Motion ``new`` is ``old`` turned, grown, sped up, and mirrored in the x-axis."""
    side = -1.0 if flip else 1.0
    for name, m in old.links.items():
        found, b0, b1 = new.links[name], old.bound.links[name], new.bound.links[name]
        apart = found.theta - side * m.theta - turn
        apart -= math.tau * np.round(apart / math.tau)
        assert np.all(np.abs(apart) <= _allowed(b0.theta, b1.theta))
        assert np.all(
            np.abs(found.omega - side * fast * m.omega) <= _allowed(fast * b0.omega, b1.omega)
        )
        limit = _allowed(fast**2 * b0.alpha, b1.alpha)
        assert np.all(np.abs(found.alpha - side * fast**2 * m.alpha) <= limit)
    for name, s in old.sliders.items():
        values = zip(vars(s).values(), vars(new.sliders[name]).values(), strict=True)
        bounds = zip(
            vars(old.bound.sliders[name]).values(),
            vars(new.bound.sliders[name]).values(),
            strict=True,
        )
        for level, ((was, now), (b0, b1)) in enumerate(zip(values, bounds, strict=True)):
            factor = grow * fast**level
            assert np.all(np.abs(now - factor * was) <= _allowed(factor * b0, b1))
    c, s_ = math.cos(turn), math.sin(turn)
    for name, p in old.points.items():
        values = zip(vars(p).values(), vars(new.points[name]).values(), strict=True)
        bounds = zip(
            vars(old.bound.points[name]).values(),
            vars(new.bound.points[name]).values(),
            strict=True,
        )
        for level, ((was, now), (b0, b1)) in enumerate(zip(values, bounds, strict=True)):
            factor = grow * fast**level
            x, y = was[:, 0], side * was[:, 1]
            wanted = factor * np.stack([c * x - s_ * y, s_ * x + c * y], axis=1)
            limit = _allowed(factor * b0, b1) + 8 * EPS * grow * np.hypot(*was.T)
            assert np.all(np.hypot(*(now - wanted).T) <= limit)


CHANGES: dict[str, tuple[Callable[[Scene], Scene], tuple[float, float, float, bool]]] = {
    "turned": (lambda s: transform.rotated(s, 0.7), (0.7, 1.0, 1.0, False)),
    "mirrored": (mirrored, (0.0, 1.0, 1.0, True)),
    "larger": (lambda s: transform.scaled(s, 10.0), (0.0, 10.0, 1.0, False)),
    "smaller": (lambda s: transform.scaled(s, 0.1), (0.0, 0.1, 1.0, False)),
    "faster": (lambda s: sped_up(s, 50.0), (0.0, 1.0, 50.0, False)),
}


@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize("name", shipped())
def test_motion_does_not_depend_on_place_size_speed_or_hand(name: str, change: str) -> None:
    scene, time_s = load_scene(name), swing_times(load_scene(name), 50)
    changed, (turn, grow, fast, flip) = CHANGES[change][0](scene), CHANGES[change][1]
    _assert_same(solve(scene, time_s), solve(changed, time_s / fast), turn, grow, fast, flip)


@pytest.mark.parametrize("name", shipped())
def test_motion_moves_with_the_scene(name: str) -> None:
    scene, time_s = load_scene(name), swing_times(load_scene(name), 50)
    old, new = solve(scene, time_s), solve(transform.moved(scene, (3.0, -2.0)), time_s)
    for point, was in old.points.items():
        apart = new.points[point].position - was.position - np.array([3.0, -2.0])
        bounds = old.bound.points[point].position + new.bound.points[point].position
        assert np.all(np.hypot(*apart.T) <= 2.0 * bounds + 8 * EPS * 3.0)
    for link, m in old.links.items():
        limit = _allowed(old.bound.links[link].alpha, new.bound.links[link].alpha)
        assert np.all(np.abs(new.links[link].alpha - m.alpha) <= limit + 8 * EPS * 3.0 * 1e4)


def test_backwards_drive_runs_through_the_same_positions() -> None:
    scene = load_scene("shaper")
    law = scene.driver.law
    assert isinstance(law, ConstantSpeed)
    back = replace(
        scene, driver=replace(scene.driver, law=replace(law, speed_rad_s=-law.speed_rad_s))
    )
    time_s = np.linspace(0.0, 1.0, 77)
    ahead, behind = solve(scene, -time_s[::-1]), solve(back, time_s)
    for name, m in behind.links.items():
        assert np.allclose(m.omega, -ahead.links[name].omega[::-1], rtol=0, atol=1e-11)
        assert np.allclose(m.alpha, ahead.links[name].alpha[::-1], rtol=0, atol=1e-9)
