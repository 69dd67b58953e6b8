"""Cells are timed in turns, in repeats that are long enough, from where each of them starts."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from analytic.kinematics import solve
from models.files import load_scene
from reports.compare.free.kept_motion import released_state
from reports.judge.cell import Cell
from reports.sweep import measured
from reports.workers.isolated import Limits, Lost
from tests.worlds.in_process import Here


def cell(name: str = "fourbar-lecture-1", **more: Any) -> Cell:
    return Cell(load_scene(name), "pymunk", "tuned", 0.002, 100, **more)


def test_cells_take_turns_and_one_that_is_lost_is_timed_no_more() -> None:
    cells = [(cell("whitworth"), 3.0), (cell("shaper"), 5.0)]
    answers: Iterator[object] = iter(
        [(1.0, 2.0), (7.0,), (3.0,), Lost("crashed", ""), (4.0,), (5.0, 6.0)]
    )
    asked: list[object] = []
    done: list[int] = []

    class Child(Here[Any]):
        def call(self, function: Callable[..., object], *arguments: object) -> object:
            asked.append((function, *arguments))
            return next(answers)

    found = measured.timed_in_turns(Child(Limits()), cells, 4, lambda: done.append(len(asked)))
    assert found == [((1.0, 2.0, 4.0), (3.0, 5.0, 6.0)), None]
    first, second = ((measured.timed, *each) for each in cells)
    assert asked == [first, second, first, second, first, first]
    assert done == [1, 2, 3, 4, 5, 5, 6, 6]


@pytest.mark.parametrize(
    ("guess_us", "steps"), [(50.0, 300), (1e-9, 50_000), (0.2, 50_000), (1.0, 15_000), (1e6, 200)]
)
def test_a_repeat_has_steps_for_about_15_ms(
    guess_us: float, steps: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[tuple[object, ...]] = []

    def time_run(*arguments: object, **options: object) -> SimpleNamespace:
        asked.append((arguments, options))
        return SimpleNamespace(walls_s=(3e-3, 6e-3))

    monkeypatch.setattr(measured, "time_run", time_run)
    one = cell(settings={"iterations": 7})
    assert measured.timed(one, guess_us) == pytest.approx((3e3 / steps, 6e3 / steps))
    ((arguments, options),) = asked
    scene, _, *engine = arguments
    assert (scene, engine) == (one.given, ["pymunk", "tuned"])
    assert options == {
        "dt_s": 0.002,
        "steps": steps,
        "repeats": 2,
        "drive": one.drive,
        "settings": {"iterations": 7},
    }


@pytest.mark.parametrize("kind", ["driven", "free", "elastic"])
def test_a_cell_is_timed_from_its_own_start(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    states: list[object] = []
    monkeypatch.setattr(
        measured,
        "time_run",
        lambda scene, state, *_, **__: states.append(state) or SimpleNamespace(walls_s=()),
    )
    monkeypatch.setattr(Cell, "truth", SimpleNamespace(start="that of the truth"))
    name = {"driven": "shaper", "free": "fourbar-swing", "elastic": "fourbar-elastic"}[kind]
    one = cell(name, **({"drive": "free"} if kind == "free" else {}))
    assert measured.timed(one, 50.0) == ()
    wanted = {
        "driven": lambda: solve(one.scene, np.zeros(1)).state(),
        "free": lambda: released_state(one.scene),
        "elastic": lambda: "that of the truth",
    }[kind]()
    assert repr(states) == repr([wanted])
