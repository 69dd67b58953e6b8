"""Mechanisms for a task of function generation: all that meet its precision points."""

import cmath
import itertools
import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from analytic.lectures.synthesis import design
from analytic.lectures.synthesis.function.equal_ripple import equal_ripple
from analytic.lectures.synthesis.function.generator import STARTS, FunctionProposal, Generator
from analytic.lectures.synthesis.function.linkages import (
    SliderCrankGenerator,
    fourbars,
    slider_cranks,
)
from analytic.lectures.synthesis.function.task import FunctionTask
from models.array import Array
from models.errors import CrankcheckError
from models.lectures.draft import Draft, bar

SOURCE = (
    "F. Freudenstein, Approximate synthesis of four-bar linkages, Transactions of the ASME 77 "
    "(1955); R. S. Hartenberg and J. Denavit, Kinematic Synthesis of Linkages, chapter 10"
)


def proposed(
    task: FunctionTask, generator: Generator, x: Array, chosen: Mapping[str, str], doubt: str
) -> FunctionProposal:
    """Return the proposal of a generator that meets a task's function at x (n,)."""
    phi = generator.input_start + task.input_turn(x)
    ends = (generator.input_start, generator.input_start + task.input_range_rad)
    output = task.output_scale * generator.output_start + task.output_way(x)
    positions = tuple(
        design.PrecisionPosition(float(angle), (_asked(task, float(of)),))
        for angle, of in zip(phi, output, strict=True)
    )
    return FunctionProposal(
        _draft(task, generator, x),
        design.INPUT,
        positions,
        dict(chosen),
        _steps(task, generator, x, _places(task, generator, phi, output)),
        doubt,
        task=task,
        generator=generator,
        x_points=tuple(float(each) for each in x),
        also_rad=ends,
    )


def _asked(task: FunctionTask, output: float) -> design.Asked:
    if task.mechanism == "fourbar":
        return design.AskedAngle(design.OUTPUT, math.remainder(output, math.tau))
    return design.AskedSlide(design.PINS[1], output)


def _draft(task: FunctionTask, generator: Generator, x: Array) -> Draft:
    lengths = [task.scale_m * length for length in generator.lengths]
    links = {
        design.INPUT: bar(design.PIVOTS[0], design.PINS[0], lengths[0]),
        design.COUPLER: bar(design.PINS[0], design.PINS[1], lengths[1]),
    }
    note = f"generates {task.function.name} from x = {task.x_low:g} to {task.x_high:g}, exact at "
    note += f"x = {', '.join(f'{each:.6g}' for each in x)}"
    name = f"function-{task.mechanism}-{task.count}"
    if isinstance(generator, SliderCrankGenerator):
        line = (0.0, task.scale_m * generator.offset)
        slider = {"on": "ground", "through_m": line, "direction_deg": 0.0}
        ground = {design.PIVOTS[0]: 0j}
        return Draft(name, SOURCE, ground, links, {}, sliders={design.PINS[1]: slider}, note=note)
    links[design.OUTPUT] = bar(design.PIVOTS[1], design.PINS[1], lengths[2])
    ground = {design.PIVOTS[0]: 0j, design.PIVOTS[1]: complex(task.ground_m)}
    return Draft(name, SOURCE, ground, links, {}, note=note)


def _places(
    task: FunctionTask, generator: Generator, phi: Array, output: Array
) -> list[tuple[complex, complex]]:
    """Return the pins A and B in each precision position [m]."""
    a, *_, last = (task.scale_m * length for length in generator.lengths)
    pins = []
    for angle, of in zip(phi.tolist(), output.tolist(), strict=True):
        if isinstance(generator, SliderCrankGenerator):
            end = complex(of, task.scale_m * generator.offset)
        else:
            end = task.ground_m + cmath.rect(last, of)
        pins.append((cmath.rect(a, angle), end))
    return pins


def _steps(
    task: FunctionTask, generator: Generator, x: Array, places: list[tuple[complex, complex]]
) -> tuple[design.DrawingStep, ...]:
    slides = isinstance(generator, SliderCrankGenerator)
    pivot = None if slides else complex(task.ground_m)
    frame: tuple[design.Element, ...] = (design.Dot(0j, design.PIVOTS[0], "given", fixed=True),)
    frame += () if pivot is None else (design.Dot(pivot, design.PIVOTS[1], "given", fixed=True),)
    k1, k2, k3 = generator.k
    first_in, first_out = places[0]
    links = design.chained(0j, first_in, first_out)
    links += [] if pivot is None else design.chained(pivot, first_out)
    unit = f"{abs(task.output_range):.6g} m" if slides else _degrees(task.output_range)
    return (
        design.DrawingStep(
            f"x from {task.x_low:g} to {task.x_high:g} turns the input by "
            f"{_degrees(task.input_range_rad)}, y moves the output by {unit}; precision points at "
            f"x = {', '.join(f'{each:.6g}' for each in x)}",
            (*frame, *_asked_lines(places, pivot)),
        ),
        design.DrawingStep(
            f"Freudenstein's equation in these points gives k1 = {k1:.6g}, k2 = {k2:.6g}, "
            f"k3 = {k3:.6g}, and with them the lengths",
            (
                *links,
                design.Dot(first_in, design.PINS[0], "result"),
                design.Dot(first_out, design.PINS[1], "result"),
            ),
        ),
    )


def _asked_lines(
    places: list[tuple[complex, complex]], pivot: complex | None
) -> Iterator[design.Element]:
    """Yield the required input and output of the points; for a slider its line."""
    for number, (pin, end) in enumerate(places, 1):
        yield design.Segment(0j, pin)
        yield design.Dot(pin, f"{design.PINS[0]}{number}")
        yield design.Dot(end, f"{design.PINS[1]}{number}")
        if pivot is not None:
            yield design.Segment(pivot, end)
    if pivot is None:
        along = sorted((end for _, end in places), key=lambda place: place.real)
        yield design.Segment(along[0], along[-1], "given", beyond=0.2)


def _degrees(angle: float) -> str:
    return f"{math.degrees(angle):.6g} degrees"


COARSE, FINE = 12, 24
"""Starts over half a turn that are tried if two are open, and if one is: the other half has the
same mechanisms, as a negative length turns a start by 180 degrees."""
ROUNDING = 1e-13
"""Discriminant, over the largest of the range, that is zero: links in line at an end of a range."""
MIDDLES = np.linspace(-3.0, 3.0, 13)
"""Tried middles of a slider's range, in ranges from the foot of the input's pivot."""


@dataclass(frozen=True)
class Starts:
    """Given starts of one try [rad, for a slider scales]; ``tried`` are those of a grid."""

    input: float | None
    output: float | None
    tried: tuple[str, ...] = ()

    @property
    def free(self) -> tuple[str, ...]:
        """Starts that the points determine."""
        return tuple(name for name in STARTS if getattr(self, name) is None)


def function_designs(
    task: FunctionTask, progress: Callable[[float], None] | None = None
) -> list[FunctionProposal]:
    """Return all mechanisms that meet the precision points of a task, in no order.

    Starts that too few points leave open are tried on a grid: every 15 degrees, every 7.5 for a
    single one, and a slider's in half ranges up to three ranges from the foot; ``progress`` is
    called with the finished share. With equal ripples
    the points are moved; a mechanism without them keeps Chebyshev's spacing, with the reason in its
    `doubt`.

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
    every = list(starts_of(task))
    for number, starts in enumerate(every):
        if progress is not None:
            progress(number / len(every))
        try:
            generators = _solved(task, task.x_points, starts)
        except CrankcheckError as fault:
            special = fault
            continue
        proposals += [_refined(task, starts, each) for each in generators if each.sound]
    if not proposals:
        raise special or CrankcheckError(
            f"no {task.mechanism} meets the {task.count} precision points with these starts and "
            "ranges; change a start or leave it open, change a range or its sense, or use fewer "
            "points"
        )
    return proposals


def starts_of(task: FunctionTask) -> Iterator[Starts]:
    """Yield the starts to try: the given ones, those that the points find, and a grid of others."""
    given: Mapping[str, float | None] = {
        "input": task.input_start_rad,
        "output": None if task.output_start is None else task.output_start / task.output_scale,
    }
    opened = [name for name in STARTS if given[name] is None]
    finds = task.count - 3
    # Four points with both open find the output's start.
    tried = tuple(opened[: len(opened) - finds])
    grids = [_grid(task, name, FINE if len(tried) == 1 else COARSE) for name in tried]
    for values in itertools.product(*grids):
        taken = dict(given) | dict(zip(tried, values, strict=True))
        yield Starts(taken["input"], taken["output"], tried)


def _grid(task: FunctionTask, name: str, count: int) -> list[float]:
    """Return the starts to try for the input or the output [rad or scales]."""
    if name == "output" and task.mechanism == "slider-crank":
        return [float(middle) - 0.5 * math.copysign(1.0, task.output_range) for middle in MIDDLES]
    return [math.pi * k / count for k in range(count)]


def _solved(task: FunctionTask, x: Array, starts: Starts) -> list[Generator]:
    """Return the mechanisms that meet the points at x with these starts, to rounding."""
    turns, ways = task.input_turn(x), task.output_scales(x)
    solve = fourbars if task.mechanism == "fourbar" else slider_cranks
    found = solve(turns, ways, starts.input, starts.output)
    return [each.polished(turns, ways, starts.free) for each in found if each.sound]


def _refined(task: FunctionTask, starts: Starts, generator: Generator) -> FunctionProposal:
    """Return the proposal of a mechanism, with equal ripples if requested."""
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
    """Return the text on given starts that are not kept."""
    given = {"input": task.input_start_rad, "output": task.output_start}
    return [
        f"the {name} starts 180 degrees from the start that was given: its length came out negative"
        for name in generator.turned
        if given[name] is not None
    ]


def _gap(task: FunctionTask, generator: Generator) -> list[str]:
    """Return the text on a mechanism that does not close over the whole range."""
    x = np.linspace(task.x_low, task.x_high, 1001)
    room = generator.discriminant(generator.input_start + task.input_turn(x))
    opened = room < -ROUNDING * np.max(np.abs(room))
    if not opened.any():
        return []
    return [f"it can not be assembled over the whole range: not at x = {x[np.argmax(opened)]:.6g}"]
