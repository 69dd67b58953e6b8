"""Function generator: a mechanism of three numbers and two starts, its output in closed form.

The numbers k1, k2, k3 are those of Freudenstein's equation. The output here leads a search; the
stated output of a mechanism comes from the reference.

n points give n linear equations in products of lengths and starts. Three points have four such
products: one vector fits, up to its length. To find starts there are two more products than
equations, and x = u p + v q fits for all u, v; the relation of the products is one equation more,
homogeneous, quadratic in u, v for four points, cubic for five. So there are at most two solutions,
or three, and the roots of one polynomial are all of them.

Source: lecture "Tong hop co cau" (synthesis), structural error E(x) = f(x) - F(x), F the generated
function.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from analytic.kinematics import solve_driven
from analytic.lectures.synthesis.design import OUTPUT, PINS, Proposal
from analytic.lectures.synthesis.examine import Examined
from analytic.lectures.synthesis.function.task import FunctionTask
from models.array import Array
from models.errors import CrankcheckError, ReachError
from models.scene import Scene

WIDEST = 1e4
"""Largest ratio, either way, of a length to the scale."""
POLISHES = 4
"""Newton's steps after a solution of Freudenstein's equation: each squares the rounding."""


@dataclass(frozen=True)
class Generator(ABC):
    """Mechanism in units of its scale; a search may lead through negative lengths. ``input_start``
    [rad] and ``output_start`` [rad, or scales] are the input and the output at the start of their
    ranges. ``turned`` names the starts that a negative length turned by 180 degrees: a link of
    length -a at an angle is one of length a at the opposite angle."""

    k: tuple[float, float, float]
    input_start: float
    output_start: float
    turned: tuple[str, ...] = ()

    @property
    @abstractmethod
    def positive(self) -> Generator:
        """Same mechanism with positive lengths, and starts that are turned for that."""

    @property
    @abstractmethod
    def lengths(self) -> tuple[float, ...]:
        """Sizes of its lengths in scales."""

    @abstractmethod
    def discriminant(self, phi: Array) -> Array:
        """Return the discriminant of the equation for the output at input angles [rad], (T,):
        negative where the mechanism can not be assembled."""

    @abstractmethod
    def output(self, phi: Array, sign: float | Array) -> Array:
        """Return the output at input angles [rad], in one of two assemblies (T,); nan for none."""

    @abstractmethod
    def slopes(self, phi: Array, output: Array) -> Array:
        """Return the derivatives of the output by k1, k2, k3 and the input angle (4, T)."""

    @abstractmethod
    def apart(self, asked: Array, output: Array) -> Array:
        """Return the required output less the actual one, without whole turns of an angle (T,)."""

    @property
    def sound(self) -> bool:
        """True if it is a mechanism: finite lengths, and none of them zero."""
        return all(1.0 / WIDEST < length < WIDEST for length in self.lengths)

    def error(self, turns: Array, ways: Array, sign: float | Array) -> Array:
        """Return its structural error for turns of the input [rad] and required ways of the output
        from their starts (T,): required less actual."""
        output = self.output(self.input_start + turns, sign)
        return self.apart(self.output_start + ways, output)

    def signs(self, turns: Array, ways: Array) -> Array:
        """Return the assembly nearer to the required output, for each (T,)."""
        plus, minus = (np.abs(self.error(turns, ways, sign)) for sign in (1.0, -1.0))
        return np.where(np.nan_to_num(plus, nan=np.inf) <= minus, 1.0, -1.0)

    def gradient(self, turns: Array, sign: float | Array, varied: Sequence[str]) -> Array:
        """Return the derivatives of the error by k1, k2, k3 and the free starts (T, 3 + varied)."""
        phi = self.input_start + turns
        slopes = self.slopes(phi, self.output(phi, sign))
        columns = [-slopes[0], -slopes[1], -slopes[2]]
        columns += [-slopes[3]] * ("input" in varied) + [np.ones_like(turns)] * ("output" in varied)
        return np.stack(columns, axis=1)

    def moved(self, step: Array, varied: Sequence[str]) -> Self:
        """Return it with its numbers and its free starts moved, in the order of `gradient`."""
        starts = {
            f"{name}_start": getattr(self, f"{name}_start") + float(by)
            for name, by in zip([n for n in STARTS if n in varied], step[3:], strict=True)
        }
        k1, k2, k3 = (old + float(by) for old, by in zip(self.k, step, strict=False))
        return replace(self, k=(k1, k2, k3), **starts)

    def polished(self, turns: Array, ways: Array, varied: Sequence[str]) -> Self:
        """Return the generator with errors of rounding in precision points (n,): by Newton's
        method, as long as it helps."""
        best, signs = self, self.signs(turns, ways)
        error = best.error(turns, ways, signs)
        for _ in range(POLISHES):
            gradient = best.gradient(turns, signs, varied)
            try:
                step = np.asarray(np.linalg.solve(gradient, -error), float)
            except np.linalg.LinAlgError:
                break
            nearer = best.moved(step, varied)
            left = nearer.error(turns, ways, signs)
            if not np.max(np.abs(left)) < np.max(np.abs(error)):
                break
            best, error = nearer, left
        return best


STARTS = ("input", "output")


def opposite(angle: float) -> float:
    """Return an angle half a turn on [rad]."""
    return float(angle + np.pi)


def toggled(turned: tuple[str, ...], now: tuple[str, ...]) -> tuple[str, ...]:
    """Return the turned starts after another turn of some: twice is not at all."""
    return tuple(name for name in STARTS if (name in turned) != (name in now))


RANK = 1e-13
"""Share of the largest singular value, below which equations coincide."""
REAL = 1e-7
"""Imaginary part below which a root is a double one, its two parts separated by rounding. Roots
that are nearer are one."""
LOOKS = 24
"""Directions among which the one furthest from a root is chosen."""

Form = Callable[[Array], float]


def one_vector(equations: Array) -> Array:
    """Return the unit vector of n equations (n, n + 1). Raises CrankcheckError for several."""
    return np.asarray(_null_space(equations, 1)[0])


def vectors_of(equations: Array, form: Form, degree: int) -> list[Array]:
    """Return all vectors, up to their length, that n equations (n, n + 2) leave and at which a
    homogeneous form of a degree vanishes: at most as many as the degree. Raises CrankcheckError for
    coincident equations, or a form that vanishes at every vector."""
    p, q = _null_space(equations, 2)
    turns = np.pi * np.arange(LOOKS) / LOOKS
    sizes = np.array([abs(form(np.cos(t) * p + np.sin(t) * q)) for t in turns])
    k = int(np.argmax(sizes))
    if sizes[k] <= RANK:
        raise _special()
    # The direction with the largest value leads: no root is at infinity, nor near it.
    lead = np.cos(turns[k]) * p + np.sin(turns[k]) * q
    rest = np.cos(turns[k]) * q - np.sin(turns[k]) * p
    nodes = np.cos(np.pi * (np.arange(degree + 1) + 0.5) / (degree + 1))
    values = [form(t * lead + rest) for t in nodes]
    return [t * lead + rest for t in _real_roots(np.polyfit(nodes, values, degree))]


def _null_space(equations: Array, dimension: int) -> Array:
    """Return an orthonormal basis of the kernel of equations (dimension, m)."""
    scaled = equations / np.linalg.norm(equations, axis=1, keepdims=True)
    _, sizes, rows = np.linalg.svd(scaled)
    if sizes[-1] <= RANK * sizes[0]:
        raise _special()
    return np.asarray(rows[-dimension:])


def _real_roots(polynomial: Array) -> list[float]:
    """Return the real roots of a polynomial, double ones once, in order."""
    roots: list[float] = []
    for root in sorted(np.roots(polynomial), key=lambda each: float(each.real)):
        near = REAL * (1.0 + abs(root))
        if abs(root.imag) <= near and not (roots and root.real - roots[-1] <= near):
            roots.append(float(root.real))
    return roots


def _special() -> CrankcheckError:
    return CrankcheckError(
        "the precision points are so special that a whole family of mechanisms meets them, as with "
        "an output in proportion to the input; use fewer points, or change a range"
    )


SAMPLES = 721
ZOOMS, FINER = 4, 17
"""Number of refinements of the largest error, and of places in each."""


@dataclass(frozen=True, kw_only=True)
class FunctionProposal(Proposal):
    """Proposal with its task, its generator, and the x of its precision points."""

    task: FunctionTask
    generator: Generator
    x_points: tuple[float, ...]

    def asked(self, x: Array) -> Array:
        """Return the required output [rad or m], (T,)."""
        start = self.generator.output_start * self.task.output_scale
        return np.asarray(start + self.task.output_way(x))


@dataclass(frozen=True)
class StructuralError:
    """Required less actual output at x [rad, for a slider m], and in units of y, (T,). ``largest``
    is its largest size, ``rms`` its root mean square over x. ``y_scale`` is the change of y per rad
    or m of the output."""

    x: Array
    asked: Array
    error: Array
    largest: float

    rms: float
    y_scale: float

    @property
    def largest_y(self) -> float:
        """Largest error in units of y."""
        return self.largest * abs(self.y_scale)


def structural_error(
    proposal: FunctionProposal, examined: Examined, count: int = SAMPLES
) -> StructuralError:
    """Return the error over the range of x, on the examined branch of the scene.

    Parameters
    ----------
    proposal, examined : FunctionProposal, Examined
        A proposal of `function_designs`, and `examine` of it.
    count : int
        Samples of the range, its ends included; the largest error is refined.

    Raises
    ------
    ReachError
        A mechanism that can not be assembled over the whole range.
    """
    task = proposal.task
    x = np.linspace(task.x_low, task.x_high, count)
    error = _error(proposal, examined.scene, x)
    k = int(np.argmax(np.abs(error)))
    largest = abs(error[k])
    low, high = x[max(k - 1, 0)], x[min(k + 1, count - 1)]
    for _ in range(ZOOMS):
        looks = np.linspace(low, high, FINER)
        sizes = np.abs(_error(proposal, examined.scene, looks))
        j = int(np.argmax(sizes))
        largest = max(largest, sizes[j])
        low, high = looks[max(j - 1, 0)], looks[min(j + 1, FINER - 1)]
    rms = float(np.sqrt(np.trapezoid(error**2, x) / (x[-1] - x[0])))
    return StructuralError(x, proposal.asked(x), error, float(largest), rms, task.y_scale)


def _error(proposal: FunctionProposal, scene: Scene, x: Array) -> Array:
    """Return required less actual output [rad or m], the scene driven to x."""
    turns = proposal.task.mechanism == "fourbar"
    try:
        motion = solve_driven(
            scene,
            proposal.generator.input_start + proposal.task.input_turn(x),
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
    actual = motion.links[OUTPUT].theta if turns else motion.sliders[PINS[1]].displacement
    return proposal.generator.apart(proposal.asked(x), actual)
