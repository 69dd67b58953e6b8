"""From a task of function generation to mechanisms: all that meet its precision points."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from analytic.lectures.synthesis.function.equal_ripple import equal_ripple
from analytic.lectures.synthesis.function.fourbar import fourbars
from analytic.lectures.synthesis.function.generator import STARTS, Generator
from analytic.lectures.synthesis.function.proposal import proposed
from analytic.lectures.synthesis.function.slider_crank import slider_cranks
from analytic.lectures.synthesis.function.structural_error import FunctionProposal
from analytic.lectures.synthesis.function.task import FunctionTask
from models.array import Array
from models.errors import CrankcheckError

COARSE, FINE = 12, 24
"""Starts over half a turn that are tried where two are open, and where one is: the other half has
the same mechanisms, as a negative length turns a start by 180 degrees."""
MIDDLES = np.linspace(-3.0, 3.0, 13)
"""Where the middle of a slider's range is tried, in ranges from the foot of the input's pivot."""


@dataclass(frozen=True)
class Starts:
    """What one try takes for given [rad, of a slider scales]; ``tried`` are those of a grid."""

    input: float | None
    output: float | None
    tried: tuple[str, ...] = ()

    @property
    def free(self) -> tuple[str, ...]:
        """Those that are found."""
        return tuple(name for name in STARTS if getattr(self, name) is None)


def function_designs(task: FunctionTask) -> list[FunctionProposal]:
    """All mechanisms that meet the precision points of a task, in no order.

    Where fewer points are asked for than leave every start found, an open start is tried on a grid:
    every 15 degrees, every 7.5 where only one is, and a slider's in half ranges up to three ranges
    from the foot. With equal ripples the points are moved; a mechanism of which that fails keeps
    Chebyshev's spacing, and says why in its `doubt`.

    Returns
    -------
    list of FunctionProposal
        To be examined: they may have branch, circuit and order defects. Mechanisms with a length
        beyond 10,000 times the scale, or below its 10,000th, are left out.

    Raises
    ------
    CrankcheckError
        No mechanism meets the points, or a whole family does.
    """
    proposals: list[FunctionProposal] = []
    special: CrankcheckError | None = None
    for starts in starts_of(task):
        try:
            generators = _solved(task, task.x_points, starts)
        except CrankcheckError as fault:
            special = fault
            continue
        proposals += [_refined(task, starts, each) for each in generators if each.sound]
    if not proposals:
        raise special or CrankcheckError(
            f"no {task.mechanism} meets the {task.count} precision points with these starts and "
            "ranges; change a start or leave it open, change a range or its sense, or ask for "
            "fewer points"
        )
    return proposals


def starts_of(task: FunctionTask) -> Iterator[Starts]:
    """The starts that are tried: those given, those that the points find, and a grid of others."""
    given: Mapping[str, float | None] = {
        "input": task.input_start_rad,
        "output": None if task.output_start is None else task.output_start / task.output_scale,
    }
    opened = [name for name in STARTS if given[name] is None]
    finds = task.count - 3
    # Four points with both open: the output's start is found.
    tried = tuple(opened[: len(opened) - finds])
    grids = [_grid(task, name, FINE if len(tried) == 1 else COARSE) for name in tried]
    for values in itertools.product(*grids):
        taken = dict(given) | dict(zip(tried, values, strict=True))
        yield Starts(taken["input"], taken["output"], tried)


def _grid(task: FunctionTask, name: str, count: int) -> list[float]:
    """The starts that are tried of the input or the output [rad or scales]."""
    if name == "output" and task.mechanism == "slider-crank":
        return [float(middle) - 0.5 * math.copysign(1.0, task.output_range) for middle in MIDDLES]
    return [math.pi * k / count for k in range(count)]


def _solved(task: FunctionTask, x: Array, starts: Starts) -> list[Generator]:
    """The mechanisms that meet the points at x with these starts, to rounding."""
    turns, ways = task.input_turn(x), task.output_scales(x)
    solve = fourbars if task.mechanism == "fourbar" else slider_cranks
    found = solve(turns, ways, starts.input, starts.output)
    return [each.polished(turns, ways, starts.free) for each in found if each.sound]


def _refined(task: FunctionTask, starts: Starts, generator: Generator) -> FunctionProposal:
    """The proposal of a mechanism, with equal ripples where they are asked for."""
    x, spacing = task.x_points, "as given"
    doubts: list[str] = []
    if isinstance(task.points, int):
        spacing = "Chebyshev's"
    if task.equal_ripple:
        try:
            refined = equal_ripple(task, generator, starts.free)
            generator, x, spacing = refined.generator, refined.x_points, "for equal ripples"
        except CrankcheckError as fault:
            doubts.append(str(fault))
    doubts = [*_turned(task, generator), *doubts, *_gap(task, generator)]
    chosen = {
        f"{name} start": _start_in_words(task, name, getattr(starts, name)) for name in starts.tried
    } | {"spacing": spacing}
    return proposed(task, generator, x, chosen, "; ".join(doubts))


def _start_in_words(task: FunctionTask, name: str, start: float) -> str:
    if name == "output" and task.mechanism == "slider-crank":
        return f"{start * task.scale_m:.6g} m"
    return f"{start:.6g} rad"


def _turned(task: FunctionTask, generator: Generator) -> list[str]:
    """What is said of starts that were given, and are not kept."""
    given = {"input": task.input_start_rad, "output": task.output_start}
    return [
        f"the {name} starts 180 degrees from the start that was given: its length came out negative"
        for name in generator.turned
        if given[name] is not None
    ]


def _gap(task: FunctionTask, generator: Generator) -> list[str]:
    """What is said of a mechanism that does not close over the whole range."""
    x = np.linspace(task.x_low, task.x_high, 1001)
    opened = generator.discriminant(generator.input_start + task.input_turn(x)) < 0.0
    if not opened.any():
        return []
    return [f"it can not be assembled over the whole range: not at x = {x[np.argmax(opened)]:.6g}"]
