"""Tasks of functions, paths and lines as their theories have them, from a user's table."""

from __future__ import annotations

import math

from analytic.lectures.synthesis.design import Proposal
from analytic.lectures.synthesis.exact_line import peaucellier
from analytic.lectures.synthesis.function.given import GivenFunction
from analytic.lectures.synthesis.function.task import FunctionTask
from analytic.lectures.synthesis.hoeken import hoeken
from analytic.lectures.synthesis.path.task import PathTask
from analytic.lectures.synthesis.straight_line import straight_line
from models.lectures.tasks.function import FunctionTable
from models.lectures.tasks.path import PathTable
from models.lectures.tasks.straight_line import StraightLineTable


def function_task(table: FunctionTable) -> FunctionTask:
    """Raises CrankcheckError for a function or ranges that make no task."""
    if table.formula is not None:
        function = GivenFunction.of_formula(table.formula)
    else:
        function = GivenFunction.of_table(table.x or [], table.y or [])
    if table.mechanism == "fourbar":
        output_range = math.radians(table.output_range_deg or 0.0)
        output_start = _radians(table.output_start_deg)
    else:
        output_range, output_start = table.output_range_m or 0.0, table.output_start_m
    return FunctionTask(
        function,
        *table.range_of_x,
        math.radians(table.input_range_deg),
        output_range,
        mechanism=table.mechanism,
        points=table.points if isinstance(table.points, int) else tuple(table.points),
        input_start_rad=_radians(table.input_start_deg),
        output_start=output_start,
        ground_m=table.ground_m,
        equal_ripple=table.equal_ripple,
    )


def path_task(table: PathTable) -> PathTask:
    """Raises CrankcheckError for points that make no path."""
    angles = None if table.crank_deg is None else tuple(map(math.radians, table.crank_deg))
    return PathTask(tuple(complex(*place) for place in table.points_m), angles, table.closed)


def _radians(degrees: float | None) -> float | None:
    return None if degrees is None else math.radians(degrees)


def straight_line_of(table: StraightLineTable) -> Proposal:
    """The linkage of a straight line. Raises CrankcheckError for what none has."""
    start, direction = complex(*table.start_m), math.radians(table.direction_deg)
    if table.linkage == "peaucellier":
        return peaucellier(table.length_m, start=start, direction_rad=direction)
    if table.linkage == "hoeken":
        return hoeken(
            table.length_m,
            share=None if table.turn_deg is None else table.turn_deg / 360.0,
            deviation=table.deviation,
            even=table.even or "line",
            start=start,
            direction_rad=direction,
        ).proposal
    return straight_line(
        table.linkage,
        table.length_m,
        deviation=table.deviation,
        start=start,
        direction_rad=direction,
    ).proposal
