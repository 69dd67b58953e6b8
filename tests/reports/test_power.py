"""What the verdict can see: faults planted in real runs, and the rule that must name each."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from analytic.kinematics import solve
from models.files import load_scene
from models.laws import ConstantSpeed
from models.motion import LinkMotion, Motion
from models.scene import Scene
from reports import cell as cells
from reports.cell import Cell, Checked, check
from sim.engine import Run
from sim.run import run

Runner = Callable[..., Run]
Fault = Callable[[Scene], Runner]
SCENES = ("fourbar-lecture-1", "slider-crank-offset")
STEPS = (360, 720)
OUTPUT = {"fourbar-lecture-1": "rocker", "slider-crank-offset": "rod"}
"""The link whose log is spoilt."""
LONG = {"fourbar-lecture-1": "coupler", "slider-crank-offset": "rod"}
"""The link that is made too long."""


def other(change: Callable[[Scene], Scene]) -> Fault:
    """The engine is given another scene than the reference, well assembled."""

    def fault(_: Scene) -> Runner:
        def runner(scene: Scene, _state: object, *args: Any, **options: Any) -> Run:
            wrong = change(scene)
            state = solve(wrong, np.zeros(1)).state()
            return run(wrong, state, *args, **options)

        return runner

    return fault


def logged(change: Callable[[Scene, Run], Run]) -> Fault:
    """The engine runs the scene; its log is changed afterwards."""

    def fault(scene: Scene) -> Runner:
        return lambda *args, **options: change(scene, run(*args, **options))

    return fault


def moved(done: Run) -> Motion:
    """The motion of a run that has one."""
    assert done.motion is not None
    return done.motion


def parts(bodies: Mapping[str, Any], keep: slice) -> dict[str, Any]:
    """The samples ``keep`` of every series of every body."""
    return {
        name: replace(body, **{key: series[keep] for key, series in vars(body).items()})
        for name, body in bodies.items()
    }


def samples(done: Run, keep: slice, stamps: slice) -> Run:
    """The samples ``keep`` with the time stamps ``stamps``."""
    motion = moved(done)
    assert done.velocity_time_s is not None
    assert done.acceleration_time_s is not None
    return replace(
        done,
        motion=replace(
            motion,
            time_s=motion.time_s[stamps],
            links=parts(motion.links, keep),
            points=parts(motion.points, keep),
            sliders=parts(motion.sliders, keep),
        ),
        gaps={name: gap[keep] for name, gap in done.gaps.items()},
        velocity_time_s=done.velocity_time_s[stamps],
        acceleration_time_s=done.acceleration_time_s[stamps],
    )


def with_link(done: Run, name: str, **changed: Any) -> Run:
    """The run with other series of one link."""
    motion = moved(done)
    links = {**motion.links, name: replace(motion.links[name], **changed)}
    return replace(done, motion=replace(motion, links=links))


def link(scene: Scene, done: Run) -> LinkMotion:
    return moved(done).links[OUTPUT[scene.name]]


def spoilt(series: np.ndarray[Any, Any], at: int | slice, value: float) -> Any:
    """The series with one stretch of it added to."""
    wrong = series.copy()
    wrong[at] += value
    return wrong


def long_link(scene: Scene) -> Scene:
    long = scene.links[LONG[scene.name]]
    points = {name: (1.001 * x, 1.001 * y) for name, (x, y) in long.points.items()}
    return replace(scene, links={**scene.links, long.name: replace(long, points=points)})


def moved_pin(scene: Scene) -> Scene:
    """The last pin of the ground, or the line of the slider, set off by 1e-4 L."""
    off = 1e-4 * scene.longest_m
    if scene.sliders:
        (slider,) = scene.sliders.values()
        x, y = slider.through_m
        aside = replace(slider, through_m=(x, y + off))
        return replace(scene, sliders={slider.name: aside})
    name, (x, y) = list(scene.ground.items())[-1]
    return replace(scene, ground={**scene.ground, name: (x + off, y)})


def faster(scene: Scene) -> Scene:
    law = scene.driver.law
    assert isinstance(law, ConstantSpeed)
    quick = replace(law, speed_rad_s=law.speed_rad_s * (1 + 1e-5))
    return replace(scene, driver=replace(scene.driver, law=quick))


def other_branch(scene: Scene) -> Scene:
    return replace(scene, branch={name: -sign for name, sign in scene.branch.items()})


def late_clock(scene: Scene) -> Runner:
    """Every sample is that of one step later."""

    def runner(*args: Any, steps: int, every: int, **options: Any) -> Run:
        longer = run(*args, steps=steps + every, every=every, **options)
        return replace(samples(longer, slice(1, None), slice(-1)), steps=steps)

    return runner


def late_velocity(_: Scene, done: Run) -> Run:
    assert done.velocity_time_s is not None
    return replace(done, velocity_time_s=done.velocity_time_s + done.dt_s / 2)


def without_link(scene: Scene, done: Run) -> Run:
    motion = moved(done)
    links = {name: part for name, part in motion.links.items() if name != OUTPUT[scene.name]}
    return replace(done, motion=replace(motion, links=links))


def without_point(_: Scene, done: Run) -> Run:
    motion = moved(done)
    points = {name: part for name, part in motion.points.items() if name != "C"}
    return replace(done, motion=replace(motion, points=points))


def end_missing(scene: Scene, done: Run) -> Run:
    theta = spoilt(link(scene, done).theta, -1, np.nan)
    return with_link(done, OUTPUT[scene.name], theta=theta)


def whole_turn(scene: Scene, done: Run) -> Run:
    theta = spoilt(link(scene, done).theta, 100, 2 * np.pi)
    return with_link(done, OUTPUT[scene.name], theta=theta)


def whole_turn_of_crank(scene: Scene, done: Run) -> Run:
    name = scene.driver.link
    theta = spoilt(moved(done).links[name].theta, 100, 2 * np.pi)
    return with_link(done, name, theta=theta)


def wild_start(scene: Scene, done: Run) -> Run:
    omega = spoilt(link(scene, done).omega, slice(5, 39), 1e6)
    return with_link(done, OUTPUT[scene.name], omega=omega)


def wrong_start(scene: Scene, done: Run) -> Run:
    speed = scene.driver.law.peak_speed_rad_s
    omega = spoilt(link(scene, done).omega, slice(5, 39), 0.05 * speed)
    return with_link(done, OUTPUT[scene.name], omega=omega)


def silent_link(scene: Scene, done: Run) -> Run:
    """An engine that reports accelerations, of one link NaN throughout."""
    alpha = np.full_like(link(scene, done).alpha, np.nan)
    return replace(with_link(done, OUTPUT[scene.name], alpha=alpha), reports_accelerations=True)


def short(keep: int) -> Fault:
    return logged(lambda _, done: samples(done, slice(keep), slice(keep)))


def off_grid(_: Scene, done: Run) -> Run:
    motion = moved(done)
    return replace(done, motion=replace(motion, time_s=motion.time_s * (1 + 1e-9)))


FAULTS: dict[str, tuple[Fault, str | dict[int, str]]] = {
    "link 0.1 % too long": (other(long_link), "CC103"),
    "pin or line moved by 1e-4 L": (other(moved_pin), {360: "CC110", 720: "CC103"}),
    "omega off by 1e-5": (other(faster), "CC102"),
    "wrong branch": (other(other_branch), "CC103"),
    "clock one sample late": (late_clock, "CC102"),
    "velocity half a step late": (logged(late_velocity), "CC106"),
    "link absent": (logged(without_link), "CC109"),
    "point absent": (logged(without_point), "CC109"),
    "gaps absent": (logged(lambda _, done: replace(done, gaps={})), "CC109"),
    "NaN at the end": (logged(end_missing), "CC109"),
    "accelerations of one link NaN": (logged(silent_link), "CC109"),
    "whole turn at one sample": (logged(whole_turn), "CC103"),
    "whole turn of the crank at one sample": (logged(whole_turn_of_crank), "CC102"),
    "velocity of 1e6 at the start": (logged(wild_start), "CC116"),
    "velocity off by w/20 at the start": (logged(wrong_start), "CC116"),
    "log of 50 samples": (short(50), "CC115"),
    "log of one sample": (short(1), "CC115"),
    "time stamps off the grid": (logged(off_grid), "CC115"),
}
"""Fault, and the rule that must fail: one for all steps, or by steps a turn. A pin moved by less
than the limit at a coarse step shows where the finer runs do not follow their limits down."""


def checked(
    name: str, engine: str, steps: int, monkeypatch: pytest.MonkeyPatch, fault: Fault | None
) -> Checked:
    """One turn of a scene, with a fault planted between the engine and the comparison."""
    scene = load_scene(name)
    if fault is not None:
        monkeypatch.setattr(cells, "run", fault(scene))
    return check(Cell(scene, engine, "tuned", scene.driver.law.period_s / steps, steps))


@pytest.mark.parametrize("engine", ["mujoco", "pymunk"])
@pytest.mark.parametrize("steps", STEPS)
@pytest.mark.parametrize("name", SCENES)
def test_without_a_fault_no_rule_fails(
    name: str, steps: int, engine: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert checked(name, engine, steps, monkeypatch, None).failures == ()


@pytest.mark.parametrize("engine", ["mujoco", "pymunk"])
@pytest.mark.parametrize("steps", STEPS)
@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("fault", FAULTS)
def test_a_planted_fault_fails_its_rule(
    fault: str, name: str, steps: int, engine: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    plant, rule = FAULTS[fault]
    found = checked(name, engine, steps, monkeypatch, plant)
    assert found.verdict == "out"
    wanted = rule if isinstance(rule, str) else rule[steps]
    assert wanted in {finding.rule for finding in found.failures}
