"""Worlds of a batch: each is the same run as alone; what engines and scenes refuse."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from analytic.kinematics import solve
from models.errors import EngineError
from models.files.reading import load_scene
from models.motion import State
from models.scene import Scene
from reports.compare.worlds import difference
from sim.engine import Batches, Log, Run
from sim.own_engine.watched import BrokenContractError, watched
from sim.registry import engine
from sim.run import run
from sim.run.worlds import run_worlds

FOURBAR, SLIDER = load_scene("fourbar-lecture-1"), load_scene("slider-crank-offset")
MUJOCO = engine("mujoco")


def starts(scene: Scene, count: int) -> list[State]:
    times = scene.driver.law.period_s * np.arange(count) / count
    return [solve(scene, times).state(k) for k in range(count)]


def options(scene: Scene) -> dict[str, Any]:
    return {"dt_s": scene.driver.law.period_s / 90, "steps": 60, "every": 3}


def recording(record: Any) -> Any:
    return replace(MUJOCO, batches=Batches(record))


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize(
    ("scene", "drive", "profile"),
    [
        (FOURBAR, "prescribed", "tuned"),
        (SLIDER, "servo", "tuned"),  # with controls
        (load_scene("shaper"), "prescribed", "as-shipped"),
    ],
)
def test_a_world_is_the_run_alone_to_the_bit(
    scene: Scene, drive: Any, profile: str, threads: int
) -> None:
    states, asked = starts(scene, 5), {**options(scene), "drive": drive}
    worlds = run_worlds(scene, states, "mujoco", profile, threads=threads, **asked)
    assert len(worlds) == len(states)
    for state, world in zip(states, worlds, strict=True):
        alone = run(scene, state, "mujoco", profile, **asked)
        assert difference(scene, world, alone) == (0.0, True)
        assert (world.status, world.start_s) == ("ok", state.time_s)
        np.testing.assert_array_equal(world.motion.time_s, alone.motion.time_s)
        assert world.cost.steps == 60
    first, second = worlds[:2]
    assert difference(scene, first, second)[0] > 0.1


def test_engines_and_scenes_without_batches_say_so() -> None:
    with pytest.raises(EngineError, match="pymunk runs one world at a time"):
        run_worlds(FOURBAR, starts(FOURBAR, 2), "pymunk", **options(FOURBAR))
    compressor = load_scene("compressor")
    with pytest.raises(EngineError, match="follows the motion by calls from each step"):
        run_worlds(compressor, starts(compressor, 2), "mujoco", **options(compressor))


def test_a_batch_that_fails_is_the_end_of_every_world() -> None:
    def fails(*_: Any) -> Sequence[Log]:
        raise RuntimeError("out of memory")

    states = starts(FOURBAR, 3)
    worlds = run_worlds(FOURBAR, states, recording(fails), **options(FOURBAR))
    assert [(one.status, one.reason) for one in worlds] == [
        ("crashed", "RuntimeError: out of memory")
    ] * 3
    assert worlds[2].start_s == states[2].time_s


def test_a_world_that_flies_apart_ends_and_the_others_go_on() -> None:
    def torn(*asked: Any) -> Sequence[Log]:
        first, *others = MUJOCO.batches.record(*asked)
        lost = first.poses.changed(lambda body: replace(body, origin=body.origin * 1e9))
        return [replace(first, poses=lost), *others]

    worlds: list[Run] = run_worlds(FOURBAR, starts(FOURBAR, 3), recording(torn), **options(FOURBAR))
    assert [one.status for one in worlds] == ["diverged", "ok", "ok"]


def test_logs_of_an_engine_of_a_user_are_checked_one_by_one() -> None:
    def short(*asked: Any) -> Sequence[Log]:
        first, second = MUJOCO.batches.record(*asked)
        cut = replace(second.poses, time_s=second.poses.time_s[:-1])
        return [first, replace(second, poses=cut)]

    asked = FOURBAR, starts(FOURBAR, 2)
    sound = run_worlds(*asked, watched("own:ENGINE", MUJOCO), **options(FOURBAR))
    assert [one.status for one in sound] == ["ok", "ok"]
    with pytest.raises(BrokenContractError, match=r"batches\.record gave 20 samples"):
        run_worlds(*asked, watched("own:ENGINE", recording(short)), **options(FOURBAR))


@pytest.mark.parametrize("given", [7, Batches(MUJOCO.batches.record, threads=0)])
def test_a_user_s_batches_are_checked_when_the_engine_is_read(given: Any) -> None:
    with pytest.raises(BrokenContractError, match="batches is no Batches that takes one thread"):
        watched("own:ENGINE", replace(MUJOCO, batches=given))


@pytest.mark.parametrize("count", [0, 2])
def test_a_user_s_batch_gives_at_most_one_log_for_each_world(count: int) -> None:
    def record(*asked: Any) -> Any:
        return [*MUJOCO.batches.record(*asked)] * count if count else None

    own = watched("own:ENGINE", recording(record))
    with pytest.raises(BrokenContractError, match="gave not a log for each of 2 worlds"):
        run_worlds(FOURBAR, starts(FOURBAR, 2), own, **options(FOURBAR))
