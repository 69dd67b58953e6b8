"""Search space of MuJoCo's settings, and the cost of a step with them.

Solvers other than Newton are left out, as their passes depend on the state, not on the settings
alone, and save nothing (PGS: 7 % of a step with 1 pass, and -15 % with 10).
"""

from models.mjcf.tree import plan
from models.motion import State
from models.scene import Scene
from sim.registry.offers import Knob, SearchSpace, Work, rungs

EVALUATIONS = {"Euler": 1.0, "implicitfast": 1.04, "discrete": 1.08, "implicit": 1.24, "RK4": 3.87}
"""Time of an integrator over Euler's, which computes the accelerations once."""
STEP_US, BODY_US, LOOP_US = 1.313, 0.035, 0.560


def counts(scene: Scene, start: State) -> tuple[float, float, float]:
    """Return 1, bodies, closed loops: the size of one evaluation of the accelerations."""
    tree = plan(scene, start)
    return 1.0, float(len(tree.limbs)), float(len(tree.closures))


def work(scene: Scene, start: State) -> Work:
    """Return the cost of the evaluations of the accelerations, each growing with bodies and loops.

    The solver's iterations are no part of it: pins make a quadratic problem, which Newton's method
    solves in its first, so that limits of 1 and 100 take the same time (measured).
    """
    step, body, loop = counts(scene, start)
    each = STEP_US * step + BODY_US * body + LOOP_US * loop
    return lambda settings: EVALUATIONS[str(settings["integrator"])] * each


KNOBS = SearchSpace(
    knobs=(
        Knob("integrator", ("RK4", "implicitfast", "Euler", "implicit", "discrete")),
        # MuJoCo itself takes 2 steps for anything shorter (refsafe).
        Knob("solref_timeconst_steps", rungs(2.0, 20.0, 1.06)),
        # Above 5 pins open slowly, over tens of turns, which no short run shows.
        Knob("solref_dampratio", rungs(0.2, 5.0, 1.08)),
        Knob(
            "solimp",
            (0.9, 0.95, 0.98, 0.99, 0.995, 0.998, 0.999, 0.9995, 0.9998, 0.9999),
            sets=("solimp_dmin", "solimp_dmax"),
        ),
        Knob("iterations", (1, 2, 3, 5, 10, 20, 50, 100)),
    ),
    starts=(
        {"integrator": "implicitfast", "solref_timeconst_steps": 2.0},
        {"integrator": "Euler", "solref_timeconst_steps": 2.0},
    ),
    work=work,
)
