"""Search space of Rapier's settings, and the cost of a step with them."""

from models.motion import State
from models.scene import Scene
from sim.engine import Settings
from sim.engine.ties import joint_count
from sim.registry.offers import Knob, SearchSpace, Work

STEP_US, SUBSTEP_US, JOINT_US = 12.0, 2.0, 0.025
"""Time of a step, of a sub-step, and of a joint in a sweep."""


def work(scene: Scene, start: State) -> Work:
    """Return the cost of a step: a part for itself, one a sub-step, and the joints once a sweep."""
    count = joint_count(scene)

    def us(settings: Settings) -> float:
        sweeps = float(settings["sweeps"]) + float(settings["velocity_sweeps"])
        each = SUBSTEP_US + JOINT_US * count * sweeps
        return STEP_US + each * float(settings["substeps"])

    return us


KNOBS = SearchSpace(
    knobs=(
        Knob("substeps", (1, 2, 3, 4, 6, 8, 10, 15, 20)),
        Knob("sweeps", (1, 2, 4, 8, 15, 30, 40, 50, 100, 200)),
        Knob("velocity_sweeps", (0, 1, 2, 4, 8, 15, 30, 50, 100, 200)),
    ),
    starts=({"sweeps": 1, "velocity_sweeps": 1}, {"substeps": 1}),
    work=work,
)
