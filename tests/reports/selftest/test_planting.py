"""A plant breaks what it says, where it says, and a size of 0 changes no bit."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from analytic.kinematics import solve
from models.files import load_scene
from models.scene import Scene
from reports.selftest.all_faults import FAULTS
from reports.selftest.fault import FOURBAR, SLIDER, in_engine
from reports.selftest.logs import WHEN, moved, output, rows
from sim.engine import Run
from sim.registry import engine
from sim.run import run
from sim.spoil import Post, rounded, spoilt

STEPS = 360
ENGINES = ("mujoco", "pymunk")


def ran(name: str, engine_name: str, size: float, scene_name: str = FOURBAR) -> Run:
    """A run with a fault of that size in it."""
    scene = load_scene(scene_name)
    return FAULTS[name].plant(size)(*start(scene, engine_name), **options(scene))


def start(scene: Scene, engine_name: str) -> tuple[Any, ...]:
    return scene, solve(scene, np.zeros(1)).state(), engine_name, "tuned"


def options(scene: Scene) -> dict[str, Any]:
    return {"dt_s": scene.driver.law.period_s / STEPS, "steps": STEPS, "every": 1}


def angles(done: Run) -> np.ndarray[Any, Any]:
    return np.stack([link.theta for link in moved(done).links.values()])


@pytest.mark.parametrize("engine_name", ENGINES)
@pytest.mark.parametrize("scene_name", [FOURBAR, SLIDER])
def test_a_session_cut_into_stretches_gives_the_same_bits(
    scene_name: str, engine_name: str
) -> None:
    scene = load_scene(scene_name)
    whole = run(*start(scene, engine_name), **options(scene))
    idle = in_engine(lambda steps: range(0, steps, 50), lambda *_: None)(0.0)
    cut = idle(*start(scene, engine_name), **options(scene))
    assert np.array_equal(moved(cut).time_s, moved(whole).time_s)
    assert np.array_equal(angles(cut), angles(whole))
    assert cut.status == "ok"


@pytest.mark.parametrize("engine_name", ENGINES)
def test_a_session_is_spoilt_once_at_each_step_whether_it_logs_or_not(engine_name: str) -> None:
    scene = load_scene(FOURBAR)
    heard: list[int] = []
    broken = spoilt(engine(engine_name), (0, 5, 7), lambda _t, _s, _o, done: heard.append(done))
    settings = {
        name: one.value for name, one in engine(engine_name).profiles["tuned"].settings.items()
    }
    state = solve(scene, np.zeros(1)).state()
    session = broken.open(scene, state, settings, 1e-3, "prescribed")
    session.step(6)
    session.record(4, 2)
    assert heard == [0, 5, 8]  # samples are logged at 6, 8 and 10


@pytest.mark.parametrize("engine_name", ENGINES)
def test_a_dropped_joint_holds_until_it_is_dropped(engine_name: str) -> None:
    gap = ran("joint-dropped", engine_name, 0.1).gaps["C"] / 0.25
    assert gap[: STEPS - 35].max() < 2e-4
    assert gap[-1] > 0.02


@pytest.mark.parametrize("engine_name", ENGINES)
def test_joints_soften_with_time(engine_name: str) -> None:
    healthy, soft = (ran("joint-softens", engine_name, size).gaps["C"] for size in (0.0, 0.98))
    assert np.array_equal(soft[:5], healthy[:5])
    assert soft[-60:].max() > 3.0 * soft[40:100].max()


@pytest.mark.parametrize("engine_name", ENGINES)
def test_a_link_meets_the_post_in_mid_turn_and_not_before(engine_name: str) -> None:
    scene = load_scene(FOURBAR)
    clear, met = (ran("body-collides", engine_name, size) for size in (0.0, 0.03))
    free, held = output(scene, clear).theta, output(scene, met).theta
    first = int(np.argmax(free > free.max() - 0.031))  # the engine may be off by 1e-4
    assert 60 < first < STEPS
    assert np.array_equal(held[:first], free[:first])
    assert not np.allclose(held[first : first + 20], free[first : first + 20], atol=1e-5)
    opened, shut = (max(gap.max() for gap in done.gaps.values()) for done in (met, clear))
    assert opened > 5.0 * shut


@pytest.mark.parametrize("engine_name", ENGINES)
def test_a_post_aside_touches_nothing(engine_name: str) -> None:
    scene = load_scene(FOURBAR)
    aside = Post((10.0, 10.0), 0.01)
    plant = in_engine(
        lambda _: (0,),
        lambda tools, session, opening, *_: tools.block(session, opening, "rocker", aside),
    )
    blocked = plant(1.0)(*start(scene, engine_name), **options(scene))
    assert np.array_equal(
        angles(blocked), angles(run(*start(scene, engine_name), **options(scene)))
    )


def test_one_iteration_is_what_the_engine_holds() -> None:
    assert ran("solver-stops-early", "pymunk", 1.0).settings["iterations"] == 1
    mujoco = ran("solver-stops-early", "mujoco", 1.0).settings
    assert (mujoco["solver"], mujoco["iterations"]) == ("PGS", 1)


def test_rounding_to_24_bits_is_float32() -> None:
    values = np.random.default_rng(7).standard_normal(1000) * 10.0 ** np.arange(-5, 5).repeat(100)
    assert np.array_equal(rounded(values, 2.0**-24), values.astype(np.float32).astype(np.float64))
    assert rounded(values, 0.0) is values


def test_one_sided_accelerations_are_half_a_step_late() -> None:
    scene = load_scene(FOURBAR)
    done = ran("acceleration-late", "mujoco", 0.5)
    time_s = moved(done).time_s
    reference = solve(scene, np.clip(time_s - done.dt_s / 2, 0.0, None)).links["rocker"].alpha
    assert np.abs(output(scene, done).alpha - reference)[1:].max() < 2e-4 * 100.0


def test_the_clock_that_is_late_shows_the_next_sample() -> None:
    sound, late = (ran("clock-late", "pymunk", size) for size in (0.0, 1.0))
    assert np.array_equal(angles(late)[:, :-1], angles(sound)[:, 1:])
    assert np.array_equal(moved(late).time_s, moved(sound).time_s)


def test_the_other_assembly_comes_from_a_run_of_it() -> None:
    one, both = (ran("branch-midway", "mujoco", size) for size in (0.0, 1.0))
    half = STEPS // 2
    assert np.array_equal(angles(both)[:, :half], angles(one)[:, :half])
    assert np.abs(angles(both)[1:, half + 1 :] - angles(one)[1:, half + 1 :]).min() > 0.1
    assert max(gap.max() for gap in both.gaps.values()) < 1e-5


def test_rows_keep_values_and_stamps_apart() -> None:
    done = ran("row-stale", "mujoco", 0.0)
    some = rows(done, slice(1, 4), slice(0, 3))
    assert np.array_equal(moved(some).time_s, moved(done).time_s[:3])
    assert np.array_equal(output(load_scene(FOURBAR), some).theta, angles(done)[-1, 1:4])
    stale = ran("row-stale", "mujoco", 1.0)
    assert angles(stale)[0, WHEN] == angles(done)[0, WHEN - 1]


def test_a_fault_in_the_log_leaves_the_rest_of_it_alone() -> None:
    sound, wrong = (ran("spike", "pymunk", size) for size in (0.0, 1e-5))
    theta = output(load_scene(FOURBAR), sound).theta
    changed = np.flatnonzero(output(load_scene(FOURBAR), wrong).theta != theta)
    assert changed.tolist() == [WHEN]
    put_back = replace(output(load_scene(FOURBAR), wrong), theta=theta)
    assert np.array_equal(put_back.omega, output(load_scene(FOURBAR), sound).omega)
