"""Search space of pymunk's settings, and the cost of a step with them."""

from collections import Counter
from collections.abc import Mapping

from models.motion import State
from models.scene import Scene
from sim.engine import Settings
from sim.pymunk.space import build
from sim.registry.offers import Knob, SearchSpace, Work, rungs

STEP_US, BODY_US, RAIL_US = 0.612, 0.022, 2.753
PASS_US = {"PivotJoint": 0.00761, "GrooveJoint": 0.01893, "PinJoint": 0.01747}
"""Time of one joint in one iteration; pin joints are the rails of `sim.pymunk.space`, a gear takes
no measurable time."""


def counts(scene: Scene, start: State, exact: bool) -> tuple[float, float, Mapping[str, int]]:
    """Return 1, bodies, and the joints by their kind."""
    model = build(scene, start, exact_lines=exact)
    kinds = Counter(type(joint).__name__ for joint in model.space.constraints)
    return 1.0, float(len(model.bodies)), kinds


def work(scene: Scene, start: State) -> Work:
    """Return the cost of a step: a part for the step and its bodies, one for the rails' far ends,
    and the joints once per iteration, as pymunk does all its iterations."""
    base: dict[bool, float] = {}
    each: dict[bool, float] = {}
    for exact in (False, True):
        step, body, kinds = counts(scene, start, exact)
        base[exact] = STEP_US * step + BODY_US * body + RAIL_US * kinds["PinJoint"]
        each[exact] = sum(us * kinds[kind] for kind, us in PASS_US.items())

    def us(settings: Settings) -> float:
        exact = settings["lines"] == "exact"
        return base[exact] + each[exact] * float(settings["iterations"])

    return us


KNOBS = SearchSpace(
    knobs=(
        Knob("iterations", tuple(int(x) for x in rungs(1.0, 200.0, 1.1))),
        Knob(
            "error_bias",
            (0.0, 1e-9, 1e-6, 1e-4, 0.0017970074436457143, 0.01, 0.03, 0.1, 0.2, 0.4, 0.7, 1.0),
        ),
        Knob("lines", ("exact", "groove")),
    ),
    starts=(
        {"iterations": 10},
        {"iterations": 10, "error_bias": 0.0017970074436457143, "lines": "groove"},
    ),
    work=work,
)
