"""Faults of dynamics inside the engine: after the look at the model, which would refuse most."""

from __future__ import annotations

from functools import partial
from typing import Any

from models.array import Array
from models.scene import Scene
from reports.judge.cell import CellRunner
from reports.selftest.engines import TIMES, Act, after_a_third, done_to
from reports.selftest.fault import REFUSED, Fault, Plant, can_set, in_engine, in_settings
from reports.selftest.free_runs import SWING
from sim.engine import Run, Session
from sim.registry import engine
from sim.run import run
from sim.spoil import Opening, Spoiler, spoilt

TOGETHER = 10
"""Steps that are made explicit together: what they lack adds up to a change of velocity."""


def after_look(act: Act) -> Plant:
    """What is done to a session after its first step, when the model was looked at."""
    return done_to(act, lambda _: (1,))


def now_and_then(steps: int) -> range:
    return range(1, steps, max(steps // TIMES, 1))


def explicit(share: float) -> CellRunner:
    """Positions go on with the velocity before each step, as explicit Euler has it, or a share of
    the way there: they are held back by the step times the change of velocity."""

    def runner(scene: Scene, state: Any, name: str, *args: Any, **options: Any) -> Run:
        before: list[Array] = []

        def act(tools: Spoiler, session: Session, opening: Opening, _: int) -> None:
            before.append(tools.hold_back(session, share * opening.dt_s, *before[-1:]))

        steps = tuple(range(0, options["steps"], TOGETHER))
        return run(scene, state, spoilt(engine(name), steps, act), *args, **options)

    return runner


_fault = partial(Fault, "stepping", scenes=(SWING,))
FAULTS = (
    _fault(
        "damping-left-on",
        "something damps all joints",
        "CC129",
        after_look(lambda tools, session, size: tools.damp(session, size)),
        0.1,
        "1/s",
    ),
    _fault(
        "armature-left-on",
        "the last joint is slow to turn",
        "CC127",
        after_look(lambda tools, session, size: tools.slow(session, size)),
        1.0,
        "of it",
    ),
    _fault(
        "mass-later",
        "a body becomes heavier",
        "CC127",
        after_a_third(lambda tools, session, size: tools.load(session, size)),
        1.0,
        "of it",
    ),
    _fault(
        "gravity-later",
        "more gravity in mid-run",
        "CC127",
        after_a_third(lambda tools, session, size: tools.pull(session, size)),
        1.0,
        "m/s^2",
    ),
    _fault(
        "start-contradicts",
        "a link starts at a speed of its own",
        "CC101",
        done_to(lambda tools, session, size: tools.spin(session, size)),
        1e-3,
        "rad/s",
        says=(REFUSED, "turns at"),
    ),
    _fault("explicit-euler", "explicit steps: energy grows", "CC129", explicit, 1.0, "of it"),
    _fault(
        "energy-fed",
        f"speeds made larger, {TIMES} times",
        "CC129",
        in_engine(now_and_then, lambda tools, session, _o, size, _: tools.quicken(session, size)),
        1e-3,
        "of it",
    ),
    _fault(
        "loop-slips",
        "a joint slips on its link in mid-run",
        "CC128",
        after_a_third(lambda tools, session, size: tools.slip(session, size)),
        1e-3,
        "m",
    ),
    _fault(
        "semi-implicit",
        "semi-implicit Euler for RK4",
        "CC127",
        in_settings("semi-implicit"),
        needs=can_set("semi-implicit"),
    ),
    _fault(
        "bias-left-on",
        "gaps closed slowly: first order",
        "CC129",
        in_settings("first-order"),
        needs=can_set("first-order"),
    ),
)
