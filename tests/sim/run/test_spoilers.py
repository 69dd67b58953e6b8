"""What is broken in an engine is broken: in every scene, and by nothing where the size is 0."""

from collections.abc import Callable
from functools import cache
from typing import Any

import pytest

from models.files.reading import load_scene
from reports.contract.subject import numbers
from sim.engine import Session
from sim.registry import engine, offering
from sim.run.spoil import Opening, Spoiler, spoilt
from tests.worlds.runs import opened
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


@cache
def logged(name: str, engine_name: str, what: str | None, size: float) -> tuple[Any, ...]:
    """The numbers of a turn, with the masses that the engine holds at its end."""

    def act(tools: Spoiler, session: Session, opening: Opening, _: object) -> None:
        if what is not None:
            BREAKS[what][0](tools, session, opening, size)

    scene, broken = load_scene(name), spoilt(engine(engine_name), (MIDWAY,), act)
    session = opened(scene, broken, steps=STEPS)
    return numbers(session.record(STEPS, 1).poses).tolist(), session.facts().mass_kg


@pytest.mark.parametrize("what", BREAKS)
@pytest.mark.parametrize("name", offering("spoiler"))
@pytest.mark.parametrize(
    "scene",
    few(SCENES, {"slider-crank-excel-210", "scotch-yoke"}, "these close at a pin and a line"),
)
def test_what_is_broken_shows_in_the_log_or_the_model(scene: str, name: str, what: str) -> None:
    assert logged(scene, name, what, BREAKS[what][1]) != logged(scene, name, None, 0.0)


@pytest.mark.parametrize("name", offering("spoiler"))
def test_nothing_is_broken_by_a_size_of_0(name: str) -> None:
    for what in BREAKS:
        assert logged("shaper", name, what, 0.0) == logged("shaper", name, None, 0.0)
