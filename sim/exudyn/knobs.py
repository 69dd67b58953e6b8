"""What is searched of exudyn's settings, and what a step costs with them."""

from __future__ import annotations

from models.motion import State
from models.scene import Scene
from sim.exudyn.settings import BY_SIZE, INTEGRATORS, JACOBIANS
from sim.tuning import Knob, SearchSpace, Work


def work(scene: Scene, start: State) -> Work:
    return lambda settings: 1.0


KNOBS = SearchSpace(
    knobs=(
        Knob("integrator", INTEGRATORS),
        Knob("spectral_radius", (0.0, 0.2, 0.4, 0.6, 0.7, 0.8, 0.9, 0.95, 1.0)),
        Knob("relative_tolerance", (1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3)),
        Knob("jacobian", JACOBIANS),
        Knob("linear_solver", ("EXUdense", BY_SIZE)),
    ),
    starts=(
        {"integrator": "TrapezoidalIndex2"},
        {"relative_tolerance": 1e-4},
    ),
    work=work,
)
