"""Faults inside the engine, planted in a real session: in its model, its state, its settings."""

import math
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from analytic.kinematics import solve
from models.array import Array
from models.scene import Scene, span
from reports.judge.cell import CellRunner
from reports.selftest import fault
from reports.selftest.log_faults import last, moved
from sim.engine import Run, Session
from sim.registry import engine
from sim.run import run
from sim.run.spoil import Opening, Post, Spoiler, spoilt

CLEAR_RAD = 0.01
"""Distance beyond the end of its swing at which a link does not touch the post."""
TIMES = 36
"""Number of changes in a run, for faults that change over time."""
TOGETHER = 10
"""Steps that are made explicit together: their missing parts add up to a change of velocity."""
Act = Callable[[Spoiler], Callable[[Session, float], object]]
"""Change of a session, by a size."""


def done_to(act: Act, at: Callable[[int], Iterable[int]] = lambda _: (0,)) -> fault.Plant:
    """Change a session before the first step, or after others of so many."""
    return fault.in_engine(at, lambda tools, session, _o, size, _: act(tools)(session, size))


def after_a_third(act: Act) -> fault.Plant:
    """Change a session in mid-run."""
    return done_to(act, lambda steps: (steps // 3,))


def after_look(act: Act) -> fault.Plant:
    """Change a session after its first step, when the model was looked at."""
    return done_to(act, lambda _: (1,))


def now_and_then(steps: int) -> range:
    return range(1, steps, max(steps // TIMES, 1))


@fault.planting
def explicit(share: float, scene: Scene, state: Any, name: str, *args: Any, **options: Any) -> Run:
    """Move positions on with the velocity before each step, as explicit Euler does, or a share of
    the way there: they are held back by the step times the change of velocity."""
    before: list[Array] = []

    def act(tools: Spoiler, session: Session, opening: Opening, _: int) -> None:
        before.append(tools.hold_back(session, share * opening.dt_s, *before[-1:]))

    steps = tuple(range(0, options["steps"], TOGETHER))
    return run(scene, state, spoilt(engine(name), steps, act), *args, **options)


def _dropped(turns: float) -> CellRunner:
    plant = done_to(
        lambda tools: lambda session, _: tools.open_loop(session),
        lambda steps: (steps - round(turns * steps),) if turns else (),
    )
    return plant(turns)


def _soften(tools: Spoiler, session: Session, opening: Opening, share: float, over: float) -> None:
    tools.soften(session, opening, share * over)


def _block(tools: Spoiler, session: Session, opening: Opening, into_rad: float, _: float) -> None:
    """Put up a post that the last link would meet, in mid-turn, so far before its swing ends."""
    tools.block(session, opening, last(opening.scene), _post(opening.scene, into_rad))


def _post(scene: Scene, into_rad: float) -> Post:
    """Return a post beside the last link, near its end, where its swing ends; clear at size 0."""
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


@fault.planting
def _servo(size: float, *args: Any, drive: Any, **options: Any) -> Run:
    """Turn the crank by a motor that has to see an error first."""
    return run(*args, drive="servo" if size else drive, **options)


@fault.planting
def _misread(size: float, *args: Any, **options: Any) -> Run:
    """Take velocities at the instants of the positions, where Euler's are not."""
    done: Run = fault.in_settings("semi-implicit")(size)(*args, **options)
    return replace(done, velocity_time_s=moved(done).time_s)


_fault = partial(fault.Fault, "engine")
FAULTS = (
    _fault("joint-dropped", "a joint is taken away towards the end", "CC105", _dropped,
           0.1, "turn"),
    _fault("joint-softens", "joints give way, more with time", "CC105",
           fault.in_engine(lambda n: range(0, n, max(n // TIMES, 1)), _soften), 0.98, "of it"),
    _fault("joint-slips", "a joint slips on its link in mid-turn", "CC105",
           after_a_third(lambda tools: tools.slip), 1e-3, "L", scenes=(fault.FOURBAR,)),
    _fault("gravity-left-on", "gravity, of which the scene has none", "CC101",
           done_to(lambda tools: tools.pull), 9.81, "m/s^2", says=(fault.REFUSED, "gravity")),
    _fault("mass-off", "a body is too heavy", "CC101", done_to(lambda tools: tools.load),
           1e-3, "of it", says=(fault.REFUSED, "mass_kg")),
    _fault("starts-askew", "a body starts turned", "CC101", done_to(lambda tools: tools.turn),
           1e-6, "rad", says=(fault.REFUSED,)),
    _fault("body-collides", "a link hits a post in mid-turn", "CC105",
           fault.in_engine(lambda _: (0,), _block), 0.03, "rad", scenes=(fault.FOURBAR,)),
    _fault("solver-stops-early", "one iteration of an iterative solver", "CC105",
           fault.in_settings("few-iterations"), 1.0,
           shown=lambda size: f"{round(1.0 / size)} iter.", needs=fault.can_set("few-iterations")),
    _fault("first-order", "places corrected late: first order", "CC103",
           fault.in_settings("first-order"), needs=fault.can_set("first-order")),
    _fault("float32-arithmetic", "the state is kept in float32", "CC102",
           done_to(lambda tools: tools.round_state, lambda n: range(1, n)), 2.0**-24, "of it",
           scenes=(fault.FOURBAR,)),  # each of its runs is cut into 360 stretches
    _fault("state-lost", "a velocity in the engine becomes NaN", "CC101",
           after_a_third(lambda tools: lambda session, size: tools.lose(session) if size else None),
           says=("diverged",)),
    _fault("drive-too-light", "a flywheel too light for the crank", "CC102",
           fault.in_settings("light-drive"), 1e-3, "of it", needs=fault.can_set("light-drive")),
    _fault("servo-lags", "the crank follows a servo", "CC102", _servo),
    _fault("integrator-misread", "semi-implicit Euler, taken for RK4", "CC106", _misread,
           needs=fault.can_set("semi-implicit")),
)  # fmt: skip
