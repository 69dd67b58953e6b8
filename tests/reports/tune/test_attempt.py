"""One set of settings in a real engine."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from analytic.kinematics import solve
from models.errors import CrankcheckError
from models.files.reading import load_scene
from models.scene import Scene
from reports.judge.cell import Cell
from reports.sweep.measured import Repeats, measured
from reports.tune import attempt
from reports.workers.isolated import Isolated, Limits
from sim.engine import Settings, SettingValue
from sim.mujoco.knobs import work
from sim.mujoco.settings import TUNED
from tests.reports.tune.conftest import timed

SETTINGS: dict[str, SettingValue] = {name: s.value for name, s in TUNED.settings.items()}
SCENES = ("fourbar-lecture-1", "slider-crank-excel-210")
Cells = Sequence[tuple[Cell, float]]


def goal_of(*names: str, target: float = 1e-4) -> attempt.Goal:
    scenes: tuple[Scene, ...] = tuple(load_scene(name) for name in names)
    return attempt.Goal(scenes, "mujoco", "tuned", target, turns=2.0)


def bench_of(goal: attempt.Goal, limits: Limits | None = None) -> attempt.Bench:
    works = [work(scene, solve(scene, np.zeros(1)).state()) for scene in goal.scenes]
    return attempt.Bench(goal, works, limits or Limits())


@pytest.fixture(scope="module")
def two() -> attempt.Bench:
    return bench_of(goal_of(*SCENES))


def errors(bench: attempt.Bench, steps: int) -> list[float]:
    cells = [bench.goal.cell(scene, SETTINGS, steps) for scene in bench.goal.scenes]
    return [attempt.error_of(measured(cell, False).row) for cell in cells]


def test_the_error_is_the_worst_of_the_scenes_and_the_cost_their_sum(two: attempt.Bench) -> None:
    found = two.attempt(SETTINGS, None)
    each = errors(two, found.steps_per_turn)
    assert found.error == max(each) <= 1e-4
    assert found.scene == SCENES[each.index(max(each))]
    per_step = sum(each(SETTINGS) for each in two.works)
    assert found.cost_us == pytest.approx(found.steps_per_turn * per_step)
    assert found.runs % 2 == 0
    assert max(errors(two, math.floor(found.steps_per_turn / 1.03))) > 1e-4, "at a coarser step"


def test_a_floor_says_how_far_it_is_off(
    two: attempt.Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("reports.tune.attempt.MOST_SEARCHED", 8000)
    soft = {**SETTINGS, "solref_timeconst_steps": 0.0, "solimp_dmin": 0.9, "solimp_dmax": 0.9}
    found = two.attempt(soft, None)
    assert (found.reached, found.error > 1e-4) == (False, True)
    assert 0.0 < found.over(1e-4) < attempt.NONE_KNOWN


def test_settings_are_given_up_where_they_can_not_win(two: attempt.Bench) -> None:
    best = two.attempt(SETTINGS, None)
    coarse = {**SETTINGS, "integrator": "implicitfast", "solref_timeconst_steps": 2.0}
    found = two.attempt(coarse, attempt.Attempt(SETTINGS, 60, 60, 1e-5, "", best.cost_us / 8.0, 1))
    assert not found.reached
    assert found.tried * two.us_per_step(coarse) <= attempt.DEARER * best.cost_us / 8.0
    assert found.runs <= 6


def test_a_run_that_takes_too_long_or_is_refused_costs_one_attempt(two: attempt.Bench) -> None:
    bench = bench_of(goal_of("fourbar-lecture-1"), Limits(time_s=1e-4))
    found = bench.attempt(SETTINGS, None)
    assert (found.reached, found.runs, found.timed_out) == (False, 1, True)
    assert found.reason == "fourbar-lecture-1: timeout: no end within 0.0001 s"
    assert found.over(1e-4) == attempt.NONE_KNOWN
    with pytest.raises(attempt.LostError, match="timeout"):
        bench.row(bench.goal.scenes[0], SETTINGS, 90)
    bench.close()
    assert bench._isolated.closed
    found = two.attempt({**SETTINGS, "solimp_dmin": 2.0}, None)
    assert (found.reached, found.timed_out) == (False, False)
    assert found.reason.startswith("fourbar-lecture-1: unsupported: setting solimp_dmin: found 2")
    assert two.attempt(SETTINGS, None).reached


class Planted(attempt.Bench):
    """A bench whose errors follow a law, not an engine."""

    def row(self, scene: Scene, settings: Settings, steps_per_turn: int) -> attempt.Row:
        lucky = steps_per_turn == 160
        return {"status": "ok", "place_pure": 1e-9 if lucky else 1e-3 + 1.0 / steps_per_turn**2}


def test_a_small_error_by_luck_is_not_told_as_the_nearest_and_what_came_apart_has_none() -> None:
    bench = Planted(goal_of("fourbar-lecture-1"), [lambda settings: 1.0], Limits())
    found = bench.attempt(SETTINGS, None)
    assert not found.reached
    assert found.error == pytest.approx(1e-3, rel=1e-3)
    assert found.over(1e-4) == pytest.approx(1.0, rel=1e-3)
    rows = (("diverged", 1e-9), ("ok", math.nan), ("ok", None), ("ok", 1e-9))
    found = [attempt.error_of({"status": status, "place_pure": error}) for status, error in rows]
    assert found == [math.inf, math.inf, math.inf, 1e-9]


def test_an_engine_that_can_not_hold_the_scene_is_told_before_the_search() -> None:
    heavy = load_scene("scotch-yoke")
    massless = {name: replace(slider, mass_kg=0.0) for name, slider in heavy.sliders.items()}
    goal = attempt.Goal((replace(heavy, sliders=massless),), "mujoco", "tuned", 1e-4, turns=2.0)
    with pytest.raises(CrankcheckError, match=r"scotch-yoke, mujoco, tuned: .*mass"):
        attempt.Bench(goal, [lambda settings: 1.0], Limits()).refuse_unsupported(SETTINGS)


def test_times_are_sums_over_the_scenes_at_the_step_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """The clock counts cells: of the first attempt these are 1 and 2, of the second 3 and 4."""
    goal = goal_of(*SCENES)
    attempts = [attempt.Attempt(SETTINGS, None, n, 1e-5, "", 1.0, 1) for n in (100, 300)]
    seen: list[object] = []

    def seen_by(isolated: Isolated[Repeats], cells: Cells, rounds: int) -> list[object]:
        seen.extend((cell.scene.name, cell.steps_per_turn, us) for cell, us in cells)
        assert isolated.limits == Limits(7.0)
        return timed(isolated, cells, rounds)

    module = "reports.tune.attempt.timed_in_turns"
    monkeypatch.setattr(module, seen_by)
    first, second = attempt.times(goal, attempts, Limits(7.0)) or []
    assert seen == [
        (name, pytest.approx(n), attempt.GUESS_US) for n in (100, 300) for name in SCENES
    ]
    assert (first.us_per_step, second.us_per_step) == (1 + 2, 3 + 4)
    assert first.s_per_turn == pytest.approx(1e-6 * 3 * 100)
    assert second.s_per_turn == pytest.approx(1e-6 * 7 * 300)
    assert [each.noise for each in (first, second)] == pytest.approx([0.1, 0.1])
    monkeypatch.setattr(module, lambda *asked: [None, *timed(*asked)[1:]])
    assert attempt.times(goal, attempts, Limits()) is None
