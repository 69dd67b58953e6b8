"""What a step costs by a model [microseconds]: the same number at every call, unlike a clock's.

A search that ranks settings by measured time finds others at every run, since two timings of one
thing differ by a few per cent. The models here count what an engine does in a step; what each
count takes was measured once, and fitted, with ::

    python -m benchmarks.step_cost

which prints the constants below and how far the models are off. What a search finds is timed for
real afterwards (`reports.tune.timing`).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping

import numpy as np

from analytic.kinematics import solve
from models.scene import Scene
from models.tree import plan
from sim.engine import SettingValue

Settings = Mapping[str, SettingValue]
Work = Callable[[Settings], float]
"""From complete settings to the time of a step [microseconds]."""

EVALUATIONS = {"Euler": 1.0, "implicitfast": 1.04, "discrete": 1.08, "implicit": 1.24, "RK4": 3.87}
"""The time of an integrator over that of Euler, which works out the accelerations once."""
MUJOCO_STEP, MUJOCO_BODY, MUJOCO_LOOP = 1.313, 0.035, 0.560
PYMUNK_STEP, PYMUNK_BODY, PYMUNK_RAIL = 0.612, 0.022, 2.753
PYMUNK_PASS = {"PivotJoint": 0.00761, "GrooveJoint": 0.01893, "PinJoint": 0.01747}
"""One joint in one iteration; pin joints are the rails of `sim.pymunk.rail`, a gear takes nothing
that could be measured."""


def mujoco_counts(scene: Scene) -> tuple[float, float, float]:
    """1, bodies, closed loops: what one evaluation of the accelerations works on."""
    tree = plan(scene, solve(scene, np.zeros(1)).state())
    return 1.0, float(len(tree.limbs)), float(len(tree.closures))


def mujoco_work(scene: Scene) -> Work:
    """Evaluations of the accelerations, each growing with bodies and loops.

    The solver's iterations are no part of it: pins make a quadratic problem, which Newton's method
    solves at its first, so that a limit of 1 and one of 100 take the same time (measured).
    """
    step, body, loop = mujoco_counts(scene)
    each = MUJOCO_STEP * step + MUJOCO_BODY * body + MUJOCO_LOOP * loop
    return lambda settings: EVALUATIONS[str(settings["integrator"])] * each


def pymunk_counts(scene: Scene, exact_lines: bool) -> tuple[float, float, Mapping[str, int]]:
    """1, bodies, and the joints by their kind."""
    from sim.pymunk.space import build  # only here: pymunk need not be installed to tune MuJoCo

    model = build(scene, solve(scene, np.zeros(1)).state(), exact_lines=exact_lines)
    kinds = Counter(type(joint).__name__ for joint in model.space.constraints)
    return 1.0, float(len(model.bodies)), kinds


def pymunk_work(scene: Scene) -> Work:
    """A part for the step and its bodies, one for the rails' far ends, and the joints once per
    iteration: pymunk does all iterations that it is told to."""
    base: dict[bool, float] = {}
    each: dict[bool, float] = {}
    for exact in (False, True):
        step, body, kinds = pymunk_counts(scene, exact)
        base[exact] = PYMUNK_STEP * step + PYMUNK_BODY * body + PYMUNK_RAIL * kinds["PinJoint"]
        each[exact] = sum(us * kinds[kind] for kind, us in PYMUNK_PASS.items())

    def work(settings: Settings) -> float:
        exact = settings["lines"] == "exact"
        return base[exact] + each[exact] * float(settings["iterations"])

    return work
