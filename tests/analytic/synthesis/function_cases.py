"""Tasks of function generation that are known to have a solution: made from random mechanisms."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from analytic.synthesis.function.fourbar import FourBarGenerator
from analytic.synthesis.function.generator import Generator
from analytic.synthesis.function.given import GivenFunction
from analytic.synthesis.function.slider_crank import SliderCrankGenerator
from analytic.synthesis.function.task import FunctionTask, MechanismKind
from models.array import Array

CLEAR = 0.15
"""Of the discriminant: how far a made mechanism keeps from its limit positions."""


@dataclass(frozen=True)
class Known:
    """A mechanism, its assembly, and a task that it solves exactly."""

    generator: Generator
    sign: float
    task: FunctionTask


def random_generator(rng: np.random.Generator, kind: MechanismKind) -> Generator:
    """Lengths of one order, starts anywhere."""
    start = float(rng.uniform(-math.pi, math.pi))
    if kind == "fourbar":
        a, b, c = (float(each) for each in rng.uniform(0.3, 2.0, 3))
        k = (1.0 / a, 1.0 / c, (a * a - b * b + c * c + 1.0) / (2.0 * a * c))
        return FourBarGenerator(k, start, 0.0)
    a, b = (float(each) for each in rng.uniform(0.3, 2.0, 2))
    e = float(rng.uniform(-0.8, 0.8))
    return SliderCrankGenerator((2.0 * a, 2.0 * a * e, b * b - a * a - e * e), start, 0.0)


def known(
    rng: np.random.Generator, kind: MechanismKind, count: int, given: tuple[str, ...]
) -> Known:
    """A task whose function a random mechanism generates over the whole range: ``given`` are the
    starts that the task tells. x is the share of the input's range."""
    while True:
        own = random_generator(rng, kind)
        turn = float(rng.choice([-1.0, 1.0]) * rng.uniform(0.7, 1.6))
        sign = float(rng.choice([-1.0, 1.0]))
        phi = own.input_start + turn * np.linspace(0.0, 1.0, 501)
        if np.min(own.discriminant(phi)) < CLEAR:
            continue
        course = _whole(own, phi, sign)
        span = float(course[-1] - course[0])
        if abs(span) < 0.3 or np.ptp(np.sign(np.diff(course))) > 0.0:
            continue  # an output that turns back is asked for in tests of its own
        function = GivenFunction("a known one", _function(own, turn, sign, float(course[0]), span))
        task = FunctionTask(
            function,
            0.0,
            1.0,
            turn,
            span,
            kind,
            count,
            input_start_rad=own.input_start if "input" in given else None,
            output_start=float(course[0]) if "output" in given else None,
            ground_m=1.0,
        )
        return Known(own, sign, task)


def _function(
    own: Generator, turn: float, sign: float, first: float, span: float
) -> Callable[[Array], Array]:
    """The share of the output's way, over that of the input's."""

    def at(x: Array) -> Array:
        off = _whole(own, own.input_start + turn * np.append(0.0, x), sign)[1:] - first
        if isinstance(own, FourBarGenerator):  # looks may lie far apart: the turn is the way's own
            middle = 0.5 * span
            off = middle + np.remainder(off - middle + math.pi, math.tau) - math.pi
        return np.asarray(off / span)

    return at


def _whole(own: Generator, phi: Array, sign: float) -> Array:
    """The output, of a four-bar without jumps by whole turns."""
    output = own.output(phi, sign)
    return np.unwrap(output) if isinstance(own, FourBarGenerator) else output
