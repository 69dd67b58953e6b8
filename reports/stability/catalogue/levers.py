"""Slotted levers whose block runs nearly through the pivot of the lever."""

from __future__ import annotations

from models.hard import slotted_lever
from reports.stability.case import Case, Trial

GROUP = "slotted lever, crank through the pivot"
SOURCE = 'Lecture "Phan tich dong hoc", example 3 (culisse), with AB carried on to AC'
CRANK_M = 0.1


def _swinging(value: float) -> Trial:
    scene = slotted_lever("swinging-lever", CRANK_M, CRANK_M * (1.0 + value), source="AB/AC to 1")
    return Trial(scene)


def _turning(value: float) -> Trial:
    scene = slotted_lever("turning-lever", CRANK_M * (1.0 + value), CRANK_M, source="AB/AC to 1")
    return Trial(scene)


def _through(value: float) -> Trial:
    scene = slotted_lever("lever-through-pivot", CRANK_M, CRANK_M, source="AB = AC")
    return Trial(scene, steps_per_turn=value, turns=4.0)


NEAR = (1.0, 0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
CASES = (
    Case(
        name="swinging-lever",
        group=GROUP,
        title="Slotted lever, AB/AC up to 1",
        source=SOURCE,
        truth="closed form; the lever swings back faster and faster",
        expected="follows",
        parameter="AC/AB - 1",
        unit="",
        values=NEAR,
        trial=_swinging,
    ),
    Case(
        name="turning-lever",
        group=GROUP,
        title="Whitworth, AB/AC down to 1",
        source=SOURCE,
        truth="closed form; the lever turns fully, nearly all at once",
        expected="follows",
        parameter="AB/AC - 1",
        unit="",
        values=NEAR,
        trial=_turning,
    ),
    Case(
        name="lever-through-pivot",
        group=GROUP,
        title="AB = AC: the block runs through the lever's pivot",
        source=SOURCE,
        truth="the lever turns at half the crank's speed, by smooth continuation",
        expected="goes on smoothly through the pivot",
        parameter="steps in a turn",
        unit="",
        values=(5760.0, 1440.0, 360.0, 90.0),
        trial=_through,
    ),
)
