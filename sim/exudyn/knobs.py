"""Search space of exudyn's settings, and the cost of a step with them."""

import math

from models.motion import State
from models.scene import Scene
from models.scene.joints import bodies, joints
from sim.engine import Settings
from sim.engine.ties import hinges
from sim.exudyn.settings import BY_NEED, INTEGRATORS, JACOBIANS
from sim.registry.offers import Knob, SearchSpace, Work

STEP_US, ITERATION_US, MATRIX_US = 12.036, 0.074, 0.0188
DIGITS_PER_ITERATION = 8.0
"""Digits of the residual that an iteration gains."""


def unknowns(scene: Scene) -> int:
    """Return the number of coordinates and constraints, including the crank's."""
    pins, slides = [*hinges(scene)], joints(scene).slides
    return 3 * len(bodies(scene)) + 2 * (len(pins) + len(slides)) + 1


def counts(scene: Scene, settings: Settings) -> tuple[float, float, float]:
    """Return 1; iterations in a step, times all unknowns; and matrices, times all their pairs."""
    size = unknowns(scene)
    digits = -math.log10(max(float(settings["relative_tolerance"]), 1e-16))
    iterations = 1.0 + digits / DIGITS_PER_ITERATION
    # One matrix at least, as steps are requested one by one (see `sim.exudyn.settings`).
    matrices = iterations if settings["jacobian"] == "each-iteration" else 1.0
    return 1.0, iterations * size, matrices * size**2


def work(scene: Scene, start: State) -> Work:
    """Return the cost of a step: a part for itself, for each iteration and each matrix."""

    def us(settings: Settings) -> float:
        step, iterated, filled = counts(scene, settings)
        return STEP_US * step + ITERATION_US * iterated + MATRIX_US * filled

    return us


KNOBS = SearchSpace(
    knobs=(
        Knob("integrator", INTEGRATORS),
        Knob("spectral_radius", (0.0, 0.2, 0.4, 0.6, 0.7, 0.8, 0.9, 0.95, 1.0)),
        Knob("relative_tolerance", (1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3)),
        Knob("jacobian", JACOBIANS),
        Knob("linear_solver", ("EXUdense", BY_NEED)),
    ),
    starts=(
        {"integrator": "TrapezoidalIndex2"},
        {"relative_tolerance": 1e-4},
    ),
    work=work,
)
