"""Slotted levers whose block runs nearly through the pivot of the lever."""

from __future__ import annotations

from functools import partial

from models.hard import slotted_lever
from reports.stability.case import Case, Trial
from reports.stability.catalogue.change_points import four_turns, through

SOURCE = 'Lecture "Phan tich dong hoc", example 3 (culisse), with AB carried on to AC'
CRANK_M = 0.1


def _swinging(excess: float) -> Trial:
    ground_m = CRANK_M * (1.0 + excess)
    return Trial(slotted_lever("swinging-lever", CRANK_M, ground_m, source="AB/AC to 1"))


def _turning(excess: float) -> Trial:
    crank_m = CRANK_M * (1.0 + excess)
    return Trial(slotted_lever("turning-lever", crank_m, CRANK_M, source="AB/AC to 1"))


def _through(steps: float) -> Trial:
    return four_turns(
        slotted_lever("lever-through-pivot", CRANK_M, CRANK_M, source="AB = AC"), steps
    )


_near = partial(
    Case, source=SOURCE, expected="follows", values=(1.0, 0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
)
CASES = (
    _near(
        name="swinging-lever",
        title="Slotted lever, AB/AC up to 1",
        truth="closed form; the lever swings back faster and faster",
        parameter="AC/AB - 1",
        trial=_swinging,
    ),
    _near(
        name="turning-lever",
        title="Whitworth, AB/AC down to 1",
        truth="closed form; the lever turns fully, nearly all at once",
        parameter="AB/AC - 1",
        trial=_turning,
    ),
    through(
        name="lever-through-pivot",
        title="AB = AC: the block runs through the lever's pivot",
        source=SOURCE,
        truth="the lever turns at half the crank's speed, by smooth continuation",
        expected="goes on smoothly through the pivot",
        trial=_through,
    ),
)
