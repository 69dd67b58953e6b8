"""Faults inside the engine, planted in a real session: in its model, its state, its settings."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from analytic.kinematics import solve
from models.scene import Scene, span
from reports.judge.cell import Runner
from reports.selftest.fault import FOURBAR, REFUSED, Fault, Plant, can_set, in_engine, in_settings
from reports.selftest.logs import last, moved
from sim.engine import Run, Session
from sim.run import run
from sim.spoil import Opening, Post, Spoiler

CLEAR_RAD = 0.01
"""How far beyond the end of its swing a link does not touch what stands there."""
TIMES = 36
"""How often in a run something that changes over time is changed."""
Act = Callable[[Spoiler, Session, float], None]


def _from_start(act: Act) -> Plant:
    """What the look at the model before the run could see."""
    return in_engine(lambda _: (0,), lambda tools, session, _o, size, _: act(tools, session, size))


def _in_mid_run(act: Act) -> Plant:
    """What happens after a third of the run."""
    return in_engine(
        lambda steps: (steps // 3,),
        lambda tools, session, _o, size, _: act(tools, session, size),
    )


def _dropped(turns: float) -> Runner:
    """The loop opens so many turns before the end of one turn."""
    plant = in_engine(
        lambda steps: (steps - round(turns * steps),) if turns else (),
        lambda tools, session, _o, _size, _: tools.open_loop(session),
    )
    return plant(turns)


def _soften(tools: Spoiler, session: Session, opening: Opening, share: float, over: float) -> None:
    tools.soften(session, opening, share * over)


def _block(tools: Spoiler, session: Session, opening: Opening, into_rad: float, _: float) -> None:
    """A post that the last link would meet so far before the end of its swing, which it comes to
    in mid-turn."""
    tools.block(session, opening, last(opening.scene), _post(opening.scene, into_rad))


def _post(scene: Scene, into_rad: float) -> Post:
    """Beside the last link, near its end, where it is as far round as it gets; clear of it where
    the size is 0."""
    name = last(scene)
    link = scene.links[name]
    pivot = next(point for point in link.points if point in scene.ground)
    turn = np.linspace(0.0, scene.driver.law.period_s, 721)
    swing = float(np.max(solve(scene, turn).links[name].theta))
    radius, away = 0.2 * scene.longest_m, 0.75 * span(link.points)
    thick = radius + 0.012 * scene.longest_m
    angle = swing - (into_rad or -CLEAR_RAD) + math.asin(thick / away)
    x, y = scene.ground[pivot]
    return Post((x + away * math.cos(angle), y + away * math.sin(angle)), radius)


def _lose(tools: Spoiler, session: Session, size: float) -> None:
    if size:
        tools.lose(session)


def _iterations(size: float) -> str:
    number = round(1.0 / size)
    return f"{number} iter."


def _servo(size: float) -> Runner:
    """The crank is turned by a motor that has to see an error first."""

    def runner(*args: Any, drive: str, **options: Any) -> Run:
        return run(*args, drive="servo" if size else drive, **options)  # type: ignore[arg-type]

    return runner


def _misread(size: float) -> Runner:
    """Velocities are taken for those of the instants of the positions, which Euler's are not."""

    def runner(*args: Any, **options: Any) -> Run:
        done = in_settings("semi-implicit")(size)(*args, **options)
        return replace(done, velocity_time_s=moved(done).time_s)

    return runner


FAULTS = (
    Fault(
        "joint-dropped",
        "engine",
        "a joint is taken away towards the end",
        "CC105",
        _dropped,
        0.1,
        "turn",
    ),
    Fault(
        "joint-softens",
        "engine",
        "joints give way, more with time",
        "CC105",
        in_engine(lambda steps: range(0, steps, max(steps // TIMES, 1)), _soften),
        0.98,
        "of it",
    ),
    Fault(
        "joint-slips",
        "engine",
        "a joint slips on its link in mid-turn",
        "CC105",
        _in_mid_run(lambda tools, session, size: tools.slip(session, size)),
        1e-3,
        "L",
        scenes=(FOURBAR,),
    ),
    Fault(
        "gravity-left-on",
        "engine",
        "gravity, of which the scene has none",
        "CC101",
        _from_start(lambda tools, session, size: tools.pull(session, size)),
        9.81,
        "m/s^2",
        says=(REFUSED, "gravity"),
    ),
    Fault(
        "mass-off",
        "engine",
        "a body is too heavy",
        "CC101",
        _from_start(lambda tools, session, size: tools.load(session, size)),
        1e-3,
        "of it",
        says=(REFUSED, "mass_kg"),
    ),
    Fault(
        "starts-askew",
        "engine",
        "a body starts turned",
        "CC101",
        _from_start(lambda tools, session, size: tools.turn(session, size)),
        1e-6,
        "rad",
        says=(REFUSED,),
    ),
    Fault(
        "body-collides",
        "engine",
        "a link hits a post in mid-turn",
        "CC105",
        in_engine(lambda _: (0,), _block),
        0.03,
        "rad",
        scenes=(FOURBAR,),
    ),
    Fault(
        "solver-stops-early",
        "engine",
        "one iteration of an iterative solver",
        "CC105",
        in_settings("few-iterations"),
        1.0,
        shown=_iterations,
        needs=can_set("few-iterations"),
    ),
    Fault(
        "first-order",
        "engine",
        "pymunk's own error_bias: first order",
        "CC103",
        in_settings("first-order"),
        needs=can_set("first-order"),
    ),
    Fault(
        "float32-arithmetic",
        "engine",
        "the state is kept in float32",
        "CC102",
        in_engine(
            lambda steps: range(1, steps),
            lambda tools, session, _o, size, _: tools.round_state(session, size),
        ),
        2.0**-24,
        "of it",
        scenes=(FOURBAR,),  # each of its runs is cut into 360 stretches
    ),
    Fault(
        "state-lost",
        "engine",
        "a velocity in the engine becomes NaN",
        "CC101",
        _in_mid_run(_lose),
        says=("diverged",),
    ),
    Fault(
        "drive-too-light",
        "engine",
        "a flywheel too light for the crank",
        "CC102",
        in_settings("light-drive"),
        1e-3,
        "of it",
        needs=can_set("light-drive"),
    ),
    Fault("servo-lags", "engine", "the crank follows a servo", "CC102", _servo),
    Fault(
        "integrator-misread",
        "engine",
        "semi-implicit Euler, taken for RK4",
        "CC106",
        _misread,
        needs=can_set("semi-implicit"),
    ),
)
