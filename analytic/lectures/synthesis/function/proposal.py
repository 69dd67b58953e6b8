"""The proposal of a function generator: its draft, its precision positions, its construction."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Mapping

from analytic.lectures.synthesis.design import (
    COUPLER,
    INPUT,
    OUTPUT,
    PINS,
    PIVOTS,
    Asked,
    AskedAngle,
    AskedSlide,
    Dot,
    Element,
    PrecisionPosition,
    Segment,
    Step,
)
from analytic.lectures.synthesis.function.generator import Generator
from analytic.lectures.synthesis.function.slider_crank import SliderCrankGenerator
from analytic.lectures.synthesis.function.structural_error import FunctionProposal
from analytic.lectures.synthesis.function.task import FunctionTask
from models.array import Array
from models.lectures.draft import Draft, bar

SOURCE = (
    "F. Freudenstein, Approximate synthesis of four-bar linkages, Transactions of the ASME 77 "
    "(1955); R. S. Hartenberg and J. Denavit, Kinematic Synthesis of Linkages, chapter 10"
)


def proposed(
    task: FunctionTask, generator: Generator, x: Array, chosen: Mapping[str, str], doubt: str
) -> FunctionProposal:
    """The proposal of a generator that meets a task's function at x (n,)."""
    phi = generator.input_start + task.input_turn(x)
    ends = (generator.input_start, generator.input_start + task.input_range_rad)
    output = task.output_scale * generator.output_start + task.output_way(x)
    positions = tuple(
        PrecisionPosition(float(angle), (_asked(task, float(of)),))
        for angle, of in zip(phi, output, strict=True)
    )
    return FunctionProposal(
        _draft(task, generator, x),
        INPUT,
        positions,
        dict(chosen),
        _steps(task, generator, x, _places(task, generator, phi, output)),
        doubt,
        task=task,
        generator=generator,
        x_points=tuple(float(each) for each in x),
        also_rad=ends,
    )


def _asked(task: FunctionTask, output: float) -> Asked:
    if task.mechanism == "fourbar":
        return AskedAngle(OUTPUT, math.remainder(output, math.tau))
    return AskedSlide(PINS[1], output)


def _draft(task: FunctionTask, generator: Generator, x: Array) -> Draft:
    """The tables of the scene: lengths in m."""
    lengths = [task.scale_m * length for length in generator.lengths]
    links = {
        INPUT: bar(PIVOTS[0], PINS[0], lengths[0]),
        COUPLER: bar(PINS[0], PINS[1], lengths[1]),
    }
    note = f"generates {task.function.name} from x = {task.x_low:g} to {task.x_high:g}, exact at "
    note += f"x = {', '.join(f'{each:.6g}' for each in x)}"
    name = f"function-{task.mechanism}-{task.count}"
    if isinstance(generator, SliderCrankGenerator):
        line = (0.0, task.scale_m * generator.offset)
        slider = {"on": "ground", "through_m": line, "direction_deg": 0.0}
        ground = {PIVOTS[0]: 0j}
        return Draft(name, SOURCE, ground, links, {}, sliders={PINS[1]: slider}, note=note)
    links[OUTPUT] = bar(PIVOTS[1], PINS[1], lengths[2])
    ground = {PIVOTS[0]: 0j, PIVOTS[1]: complex(task.ground_m)}
    return Draft(name, SOURCE, ground, links, {}, note=note)


def _places(
    task: FunctionTask, generator: Generator, phi: Array, output: Array
) -> list[tuple[complex, complex]]:
    """The pins A and B in each precision position [m]."""
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
) -> tuple[Step, ...]:
    """The maps, what the points ask of input and output, and the links that do it."""
    slides = isinstance(generator, SliderCrankGenerator)
    pivot = None if slides else complex(task.ground_m)
    frame: tuple[Element, ...] = (Dot(0j, PIVOTS[0], "given", fixed=True),)
    frame += () if pivot is None else (Dot(pivot, PIVOTS[1], "given", fixed=True),)
    k1, k2, k3 = generator.k
    first_in, first_out = places[0]
    links = [Segment(0j, first_in, "result"), Segment(first_in, first_out, "result")]
    links += [] if pivot is None else [Segment(pivot, first_out, "result")]
    unit = f"{abs(task.output_range):.6g} m" if slides else _degrees(task.output_range)
    return (
        Step(
            f"x from {task.x_low:g} to {task.x_high:g} turns the input by "
            f"{_degrees(task.input_range_rad)}, y moves the output by {unit}; precision points at "
            f"x = {', '.join(f'{each:.6g}' for each in x)}",
            (*frame, *_asked_lines(places, pivot)),
        ),
        Step(
            f"Freudenstein's equation in these points gives k1 = {k1:.6g}, k2 = {k2:.6g}, "
            f"k3 = {k3:.6g}, and with them the lengths",
            (*links, Dot(first_in, PINS[0], "result"), Dot(first_out, PINS[1], "result")),
        ),
    )


def _asked_lines(places: list[tuple[complex, complex]], pivot: complex | None) -> Iterator[Element]:
    """The input and the output as the points ask for them: of a slider its line."""
    for number, (pin, end) in enumerate(places, 1):
        yield Segment(0j, pin)
        yield Dot(pin, f"{PINS[0]}{number}")
        yield Dot(end, f"{PINS[1]}{number}")
        if pivot is not None:
            yield Segment(pivot, end)
    if pivot is None:
        along = sorted((end for _, end in places), key=lambda place: place.real)
        yield Segment(along[0], along[-1], "given", beyond=0.2)


def _degrees(angle: float) -> str:
    return f"{math.degrees(angle):.6g} degrees"
