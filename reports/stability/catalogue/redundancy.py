"""Mechanisms with more links than they need: by count they cannot move, and they do."""

from __future__ import annotations

from models.hard import double_parallelogram
from reports.stability.case import Case, Trial

GROUP = "redundancy"


def _three_rockers(value: float) -> Trial:
    scene = double_parallelogram("double-parallelogram", source="mobility 0 by count, really 1")
    return Trial(scene, steps_per_turn=value, turns=4.0)


CASES = (
    Case(
        name="double-parallelogram",
        group=GROUP,
        title="Double parallelogram with three rockers",
        source="mobility by count 0, really 1",
        truth="the coupler keeps its direction, by smooth continuation",
        expected="moves, and passes its flat positions smoothly",
        parameter="steps in a turn",
        unit="",
        values=(5760.0, 1440.0, 360.0, 90.0),
        trial=_three_rockers,
    ),
)
