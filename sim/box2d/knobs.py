"""Search space of Box2D's settings, and the cost of a step with them."""

from models.motion import State
from models.scene import Scene
from sim.engine import Settings
from sim.engine.ties import joint_count
from sim.registry.offers import Knob, SearchSpace, Work

STEP_US, JOINT_US = 7.0, 0.09
"""Time of a step, and of a joint in a sub-step."""


def work(scene: Scene, start: State) -> Work:
    """Return the cost of a step: a part for itself, and the joints once per sub-step."""
    count = joint_count(scene)

    def us(settings: Settings) -> float:
        return STEP_US + JOINT_US * count * float(settings["substeps"])

    return us


KNOBS = SearchSpace(
    knobs=(
        Knob("substeps", (1, 2, 3, 4, 6, 8, 10, 15, 20, 30, 50, 100, 200)),
        Knob("joint_swings", (0.0, 0.25, 0.5, 1.0, 2.0, 4.0, 100.0)),
    ),
    starts=({"substeps": 4}, {"substeps": 1}),
    work=work,
)
