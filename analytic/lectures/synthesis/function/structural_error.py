"""The structural error of a mechanism over the range of its function, by the reference.

Source: lecture "Tong hop co cau" (synthesis), structural error E(x) = f(x) - F(x), F what the
mechanism generates.
"""

from dataclasses import dataclass

import numpy as np

from analytic.kinematics import solve_driven
from analytic.lectures.synthesis.design import OUTPUT, PINS, Proposal
from analytic.lectures.synthesis.examine import Examined
from analytic.lectures.synthesis.function.generator import Generator
from analytic.lectures.synthesis.function.task import FunctionTask
from models.array import Array
from models.errors import ReachError
from models.scene import Scene

LOOKS = 721
ZOOMS, FINER = 4, 17
"""How often the largest error is looked for closer, and in how many places."""


@dataclass(frozen=True, kw_only=True)
class FunctionProposal(Proposal):
    """A proposal with the task that it is for, its generator, and the x of its precision points."""

    task: FunctionTask
    generator: Generator
    x_points: tuple[float, ...]

    def input_rad(self, x: Array) -> Array:
        """The angle of the driver at x [rad], (T,)."""
        return np.asarray(self.generator.input_start + self.task.input_turn(x))

    def asked(self, x: Array) -> Array:
        """What is asked of the output [rad or m], (T,)."""
        start = self.generator.output_start * self.task.output_scale
        return np.asarray(start + self.task.output_way(x))


@dataclass(frozen=True)
class StructuralError:
    """Asked less had at x: of the output [rad, of a slider m], and in units of y, (T,).

    ``largest`` is the largest size of it, at ``x_largest``; ``rms`` its root mean square over x.
    ``y_scale`` is what y changes by per rad or m of the output.
    """

    x: Array
    asked: Array
    error: Array
    largest: float
    x_largest: float
    rms: float
    y_scale: float

    @property
    def largest_y(self) -> float:
        """The largest in units of y."""
        return self.largest * abs(self.y_scale)


def structural_error(
    proposal: FunctionProposal, examined: Examined, count: int = LOOKS
) -> StructuralError:
    """The error over the range of x, on the branch that the scene is examined on.

    Parameters
    ----------
    proposal, examined : FunctionProposal, Examined
        A proposal of `function_designs`, and `examine` of it.
    count : int
        Looks at the range, its ends included; the largest error is looked for closer.

    Raises
    ------
    ReachError
        A mechanism that can not be assembled over the whole range.
    """
    task = proposal.task
    x = np.linspace(task.x_low, task.x_high, count)
    error = _error(proposal, examined.scene, x)
    k = int(np.argmax(np.abs(error)))
    x_largest, largest = x[k], abs(error[k])
    low, high = x[max(k - 1, 0)], x[min(k + 1, count - 1)]
    for _ in range(ZOOMS):
        looks = np.linspace(low, high, FINER)
        sizes = np.abs(_error(proposal, examined.scene, looks))
        j = int(np.argmax(sizes))
        if sizes[j] > largest:
            x_largest, largest = looks[j], sizes[j]
        low, high = looks[max(j - 1, 0)], looks[min(j + 1, FINER - 1)]
    rms = float(np.sqrt(np.trapezoid(error**2, x) / (x[-1] - x[0])))
    return StructuralError(
        x, proposal.asked(x), error, float(largest), float(x_largest), rms, task.y_scale
    )


def _error(proposal: FunctionProposal, scene: Scene, x: Array) -> Array:
    """Asked less had [rad or m]: the output of the scene, driven to where x is."""
    turns = proposal.task.mechanism == "fourbar"
    try:
        motion = solve_driven(
            scene,
            proposal.input_rad(x),
            np.ones(1),
            np.zeros(1),
            links=(OUTPUT,) if turns else (),
            points=(),
            sliders=() if turns else (PINS[1],),
            bound=False,
        )
    except ReachError as fault:
        raise ReachError(
            f"the mechanism does not close over the whole range of x: {fault}"
        ) from None
    asked = proposal.asked(x)
    if not turns:
        return np.asarray(asked - motion.sliders[PINS[1]].displacement)
    off = asked - motion.links[OUTPUT].theta
    return np.asarray(off - 2.0 * np.pi * np.round(off / (2.0 * np.pi)))
