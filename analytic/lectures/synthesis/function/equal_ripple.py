"""Remez' exchange: a function generator whose error has its largest size in n + 1 places, with
alternating signs.

::

    error |  .                         Of mechanisms with n numbers to choose, one with n + 1 equal
       +L |-.-.- - _ - - - - - .       ripples has the smallest largest error among its neighbours
          |   \\   / \\   _   /          (Chebyshev's alternation). The precision points are where
        0 |----\\-/---\\-/-\\-/---        the error changes its sign.
       -L |- - -'- - -'- -'- -

Newton's steps for the numbers and the level at fixed places, then the places moved to the largest
errors, and on. Where an error has more tips, or its slopes do not alternate as those of polynomials
do, a step of least largest linear error leads on.

Source: R. S. Hartenberg and J. Denavit, Kinematic Synthesis of Linkages, chapter 10 (respacing of
precision points); E. Ya. Remez (1934), as in any text on approximation.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, linprog  # type: ignore[import-untyped]  # ships no stubs

from analytic.lectures.synthesis.function.generator import Generator
from analytic.lectures.synthesis.function.task import FunctionTask
from models.array import Array
from models.errors import CrankcheckError

LOOKS = 1201
"""Samples of the error over the range; its tips lie on parabolas through three of them."""
STEPS = 60
HALVINGS = 12
"""Halvings of a step that enlarges the largest error, or opens the mechanism."""
EVEN = 1e-7
"""Difference of equal ripples, over the level. The error of parabolas at a tip is below it."""
ROUNDING = 1e-13
"""Difference of ripples that is rounding, over the scale."""


@dataclass(frozen=True)
class Ripples:
    """Generator with the tips of its error: their x and sizes with sign (n + 1,), in order; the
    ``largest`` error over the range [rad or scales] may be beside them."""

    generator: Generator
    sign: float
    x: Array
    tips: Array
    largest: float

    @property
    def unevenness(self) -> float:
        """Largest error less the smallest tip."""
        return self.largest - float(np.min(np.abs(self.tips)))


@dataclass(frozen=True)
class EqualRipple:
    """Refined generator, its precision points (n,) and its level [rad or scales]; ``before`` is the
    largest error before the refinement."""

    generator: Generator
    x_points: Array
    level: float
    before: float


def equal_ripple(task: FunctionTask, start: Generator, varied: Sequence[str]) -> EqualRipple:
    """Find the generator with equal ripples near one that meets the task's precision points.

    Parameters
    ----------
    task : FunctionTask
        The function and its maps.
    start : Generator
        A generator that meets n points in one assembly.
    varied : sequence of str
        The movable starts: n - 3 of "input" and "output".

    Raises
    ------
    CrankcheckError
        A start with its points in two assemblies, that does not close over the range, or whose
        error does not change its sign n times; no equal ripples after many steps.
    """
    course, sign = _Course.of(task), _one_sign(start, task)
    exact = float(np.max(np.abs(start.error(course.turns, course.ways, sign))))
    if exact <= ROUNDING:  # it generates the function everywhere
        return EqualRipple(start, task.x_points, exact, exact)
    now = course.ripples(start, sign, 4 + len(varied))
    if isinstance(now, str):
        raise CrankcheckError(f"equal ripples can not be searched: {now}")
    before = now.largest
    for _ in range(STEPS):
        if now.unevenness <= max(EVEN * now.largest, ROUNDING):
            return EqualRipple(now.generator.positive, course.zeros(now), now.largest, before)
        now = _stepped(course, now, varied)
    raise CrankcheckError(
        f"no equal ripples after {STEPS} steps: the errors still differ by "
        f"{now.unevenness / now.largest:.1e} of the largest; the points of Chebyshev's spacing "
        "are kept"
    )


def _one_sign(start: Generator, task: FunctionTask) -> float:
    """Return the assembly of all precision points."""
    x = task.x_points
    signs = start.signs(task.input_turn(x), task.output_scales(x))
    if np.ptp(signs) > 0.0:
        raise CrankcheckError(
            "equal ripples can not be searched: the precision points are met in two assemblies"
        )
    return float(signs[0])


def _stepped(course: _Course, now: Ripples, varied: Sequence[str]) -> Ripples:
    """Return a step that makes the largest error smaller: Newton's for equal tips, or else the best
    for linear errors; each halved until it does."""
    for propose in (_newton, _linear):
        step = propose(course, now, varied)
        for _ in range(HALVINGS):
            moved = now.generator.moved(step, varied)
            after = course.ripples(moved, now.sign, len(now.x)) if moved.sound else ""
            if isinstance(after, Ripples) and _better(after, now):
                return after
            step = 0.5 * step
    raise CrankcheckError(
        f"no equal ripples: no step makes the largest error, {now.largest:.3g}, smaller, with "
        f"tips that differ by {now.unevenness:.1e}; the points of Chebyshev's spacing are kept"
    )


def _newton(course: _Course, now: Ripples, varied: Sequence[str]) -> Array:
    """Return the step that makes the tips equal, if linear and in place."""
    turns, ways = course.at(now.x)
    gradient = now.generator.gradient(turns, now.sign, varied)
    system = np.column_stack([gradient, -np.sign(now.tips)])
    try:
        step = np.linalg.solve(system, -now.generator.error(turns, ways, now.sign))[:-1]
    except np.linalg.LinAlgError:
        return np.zeros(len(now.x) - 1)
    return np.asarray(step, dtype=np.float64)


def _linear(course: _Course, now: Ripples, varied: Sequence[str]) -> Array:
    """Return the step with the least largest error of many samples, if linear."""
    x = np.concatenate([course.x[::8], now.x])
    turns, ways = course.at(x)
    gradient = now.generator.gradient(turns, now.sign, varied)
    error = now.generator.error(turns, ways, now.sign) / now.largest
    sizes = np.linalg.norm(gradient, axis=0)
    scaled, ones = gradient / sizes, np.ones((len(x), 1))
    found = linprog(
        np.append(np.zeros(len(sizes)), 1.0),
        np.block([[scaled / now.largest, -ones], [-scaled / now.largest, -ones]]),
        np.concatenate([-error, error]),
        bounds=[(None, None)] * len(sizes) + [(0.0, None)],
    )
    return np.asarray(found.x[:-1] / sizes) if found.status == 0 else np.zeros(len(sizes))


def _better(after: Ripples, now: Ripples) -> bool:
    """True if the largest error is smaller, or near its least the tips are more even."""
    slack = EVEN * now.largest + ROUNDING
    return after.largest < now.largest or (
        after.largest <= now.largest + slack and after.unevenness < now.unevenness
    )


@dataclass(frozen=True)
class _Course:
    """Samples of a task: x, the input's turns and the output's ways (T,)."""

    task: FunctionTask
    x: Array
    turns: Array
    ways: Array

    @staticmethod
    def of(task: FunctionTask) -> _Course:
        x = np.linspace(task.x_low, task.x_high, LOOKS)
        return _Course(task, x, task.input_turn(x), task.output_scales(x))

    def at(self, x: Array) -> tuple[Array, Array]:
        """Return the input's turns and the output's ways at other x."""
        return self.task.input_turn(x), self.task.output_scales(x)

    def ripples(self, generator: Generator, sign: float, count: int) -> Ripples | str:
        """Return the largest tip between each two of ``count`` changes of sign; a text if fewer."""
        error = generator.error(self.turns, self.ways, sign)
        if np.isnan(error).any():
            at = self.x[int(np.argmax(np.isnan(error)))]
            return f"the mechanism does not close at x = {at:.6g}"
        parts = np.split(np.arange(LOOKS), np.flatnonzero(np.diff(np.signbit(error))) + 1)
        if len(parts) < count:
            return (
                f"the error changes its sign {len(parts) - 1} times over the range, and "
                f"{count - 1} are wanted"
            )
        x = np.array([self._tip(error, part) for part in parts])
        tips = generator.error(*self.at(x), sign)
        largest = float(np.max(np.abs(tips)))
        # Of too many tips, adjacent ones whose smallest is largest.
        starts = range(len(parts) - count + 1)
        first = max(starts, key=lambda k: float(np.min(np.abs(tips[k : k + count]))))
        own = slice(first, first + count)
        return Ripples(generator, sign, x[own], tips[own], largest)

    def _tip(self, error: Array, part: NDArray[np.intp]) -> float:
        """Return the x of the largest error of a part of the samples, by a parabola."""
        k = int(part[np.argmax(np.abs(error[part]))])
        if k in (0, LOOKS - 1):
            return float(self.x[k])
        before, here, after = error[k - 1 : k + 2]
        bend = before - 2.0 * here + after
        off = 0.5 * (before - after) / bend if bend else 0.0
        return float(self.x[k] + np.clip(off, -1.0, 1.0) * (self.x[1] - self.x[0]))

    def zeros(self, ripples: Ripples) -> Array:
        """Return the x between each two tips where the error is zero."""

        def error(x: float) -> float:
            turns, ways = self.at(np.array([x]))
            return float(ripples.generator.error(turns, ways, ripples.sign)[0])

        pairs = zip(ripples.x[:-1], ripples.x[1:], strict=True)
        return np.array([brentq(error, a, b, xtol=1e-15, rtol=1e-15) for a, b in pairs])
