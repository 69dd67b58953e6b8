"""One run of settings, and what is said of it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import get_args

import numpy as np
import pytest

from models.files import load_scene
from reports.advise.choices import Choice, choices
from reports.advise.demand import demanded
from reports.advise.look import WORDS, TriedRun, _seen, look
from reports.compare.beside import Beside, Truth
from reports.compare.compare import compare
from reports.compare.errors import Departure
from reports.quantities import named
from reports.stability.error_series import ErrorSeries
from sim.engine import Status
from sim.run import run

DEMAND = demanded([load_scene("slider-crank-central")], 50.0, 0.002, 1e-3, 4.0)
(SCENE,) = DEMAND.scenes


def series(place: np.ndarray, turns: float = 4.0) -> ErrorSeries:
    """Errors of place over so many turns."""
    time_s, none = np.linspace(0.0, turns, place.size), np.zeros_like(place)
    return ErrorSeries("ok", "", time_s, time_s, place, none, none, none, 1.0, 1.0)


@pytest.mark.parametrize("choice", choices(["mujoco", "pymunk"], ()), ids=lambda each: each.label)
def test_its_error_is_that_of_a_comparison(choice: Choice) -> None:
    cell = DEMAND.cell(SCENE, choice, 2)
    truth = Truth(SCENE)
    done = run(
        SCENE,
        truth.start,
        choice.engine,
        choice.profile,
        dt_s=cell.dt_s,
        steps=cell.steps,
        settings=choice.settings,
    )
    errors = compare(Beside.of(truth, done))
    places = [worst for name in named("place") if (worst := errors.worst(name))]
    assert look(cell).error == pytest.approx(max(worst.pure for worst in places), rel=1e-9)


def test_an_error_that_grows_is_seen_and_one_that_comes_back_every_turn_is_not() -> None:
    turn = np.linspace(0.0, 4.0, 401)
    steady = _seen(series(1e-3 * np.abs(np.sin(math.tau * turn))))
    assert (steady.error, steady.grows) == (pytest.approx(1e-3), False)
    creeps = _seen(series(1e-3 * turn))
    assert creeps.error == pytest.approx(4e-3)
    assert creeps.growth == pytest.approx(2.0, rel=0.02)
    assert creeps.grows


def test_of_a_single_turn_no_growth_is_told() -> None:
    only = _seen(series(np.linspace(0.0, 1.0, 50), turns=1.0))
    assert math.isnan(only.growth)
    assert not only.grows


@pytest.mark.parametrize(
    ("change", "status"),
    [
        ({"status": "diverged", "reason": "came apart"}, "diverged"),
        ({"departure": Departure("rod", 0.1, 0.2)}, "branch-changed"),
        ({"incomplete": "3 samples, not the 4"}, "crashed"),
    ],
)
def test_what_did_not_end_well_has_no_error(change: dict[str, object], status: str) -> None:
    found = _seen(replace(series(np.zeros(9)), **change))  # type: ignore[arg-type]
    assert (found.error, found.status) == (math.inf, status)
    assert found.reason


def test_what_an_engine_can_not_hold_is_told_and_not_raised() -> None:
    wrong = Choice("mujoco", "tuned", "tuned", {"close": "nowhere"})
    found = look(DEMAND.cell(SCENE, wrong, 1))
    assert found.error == math.inf
    assert found.status == "unsupported"
    assert "nowhere" in found.reason


def test_every_way_to_end_has_a_word() -> None:
    assert {*WORDS, "ok"} == set(get_args(Status))
    assert TriedRun(1.0).status == "ok"
