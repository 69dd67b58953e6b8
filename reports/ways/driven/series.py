"""Hard runs of driven scenes: beside the closed form, a limit position, or a chain that falls."""

from analytic.kinematics import solve
from models.array import Array
from models.motion import Motion
from reports.stability.case import Trial, Yardstick
from reports.stability.error_series import ErrorSeries, error_series
from reports.stability.matrix import PLACE
from reports.stability.other_truths import at_limit, falling, freely, held
from sim.engine import Run


def _beside(trial: Trial, run: Run) -> ErrorSeries:
    return error_series(trial.scene, run, trial.settled_turns)


def _solved(trial: Trial, time_s: Array) -> Motion:
    return solve(trial.scene, time_s, bound=False)


SERIES = {
    "follow": Yardstick(PLACE, _beside, _solved, with_forces=True),
    "limit": Yardstick("the crank at its limit, rad", at_limit, held),
    "chain": Yardstick(
        "the first pin of a free chain, over a rod, and of its energy, over what is exchanged",
        freely,
        falling,
    ),
}
