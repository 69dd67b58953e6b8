"""What is broken in an engine is broken: in every scene, and by nothing where the size is 0."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from analytic.kinematics import solve
from models.files import load_scene
from models.scene import Scene
from sim.engine import Facts, Poses, Session
from sim.registry import engine, offering
from sim.spoil import Opening, Spoiler, spoilt
from tests.worlds.tiers import few

STEPS, MIDWAY = 180, 60
SCENES = ("fourbar-lecture-1", "slider-crank-excel-210", "shaper", "scotch-yoke", "whitworth")
"""Loops that close at pins and at lines, of links and blocks with and without a mass."""
Act = Callable[[Spoiler, Session, Opening, float], None]
BREAKS: dict[str, tuple[Act, float]] = {
    "open_loop": (lambda tools, session, _, size: tools.open_loop(session) if size else None, 1.0),
    "soften": (lambda tools, session, opening, size: tools.soften(session, opening, size), 0.5),
    "slip": (lambda tools, session, _, size: tools.slip(session, size), 1e-4),
    "pull": (lambda tools, session, _, size: tools.pull(session, size), 9.81),
    "load": (lambda tools, session, _, size: tools.load(session, size), 0.1),
    "turn": (lambda tools, session, _, size: tools.turn(session, size), 1e-6),
    "round_state": (lambda tools, session, _, size: tools.round_state(session, size), 2.0**-24),
    "lose": (lambda tools, session, _, size: tools.lose(session) if size else None, 1.0),
}


def logged(scene: Scene, name: str, act: Act, size: float) -> tuple[Poses, Facts]:
    """The poses of a turn, with what the engine holds at its end."""
    adapter = engine(name)
    settings = {key: each.value for key, each in adapter.profiles["tuned"].settings.items()}
    dt_s = scene.driver.law.period_s / STEPS
    broken = spoilt(
        adapter, (MIDWAY,), lambda tools, session, opening, _: act(tools, session, opening, size)
    )
    session = broken.open(scene, solve(scene, np.zeros(1)).state(), settings, dt_s, "prescribed")
    return session.record(STEPS, 1).poses, session.facts()


def numbers(poses: Poses) -> list[list[float]]:
    return [
        [*np.ravel(body.origin), *body.theta, *np.ravel(body.velocity), *body.omega]
        for body in poses.bodies.values()
    ]


@pytest.mark.parametrize("what", BREAKS)
@pytest.mark.parametrize("name", offering("spoiler"))
@pytest.mark.parametrize(
    "scene",
    few(SCENES, {"slider-crank-excel-210", "scotch-yoke"}, "these close at a pin and a line"),
)
def test_what_is_broken_shows_in_the_log_or_the_model(scene: str, name: str, what: str) -> None:
    act, size = BREAKS[what]
    whole, broken = (logged(load_scene(scene), name, act, each) for each in (0.0, size))
    same_log = numbers(whole[0]) == numbers(broken[0])
    assert not same_log or whole[1].mass_kg != broken[1].mass_kg


@pytest.mark.parametrize("name", offering("spoiler"))
def test_nothing_is_broken_by_a_size_of_0(name: str) -> None:
    scene = load_scene("shaper")
    untouched, _ = logged(scene, name, lambda *_: None, 0.0)
    for act, _ in BREAKS.values():
        assert numbers(logged(scene, name, act, 0.0)[0]) == numbers(untouched)
