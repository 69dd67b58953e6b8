"""Whether a run gets over its toggle into the other assembly, or falls back before it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from analytic.free.toggle_barrier import ToggleBarrier
from models.array import Array
from reports.compare.branch import CLOSED
from sim.engine import Run

Passage = Literal["over", "back", "undecided", "broken"]
OVER = -0.5
"""The part of its way from the toggle to the start, beyond it, at which a run has got over."""
NEAR = 0.5
"""And before it, at which one that turns back has been near it."""


@dataclass(frozen=True, eq=False)
class TogglePassage:
    """What a run did: ``outcome``, at the sample ``index`` (of the last where it did neither).

    ``open_rad`` (T,) is the angle that coupler and rocker have yet to turn until they are in line:
    negative in the other assembly. ``nearest_rad`` is the least of it until the outcome.
    """

    outcome: Passage
    index: int
    open_rad: Array

    @property
    def nearest_rad(self) -> float:
        return float(np.min(self.open_rad[: self.index + 1]))


def toggle_passage(barrier: ToggleBarrier, run: Run) -> TogglePassage:
    """What a run does that was thrown at a toggle.

    A run is broken where it did not end as it should, or has a pin open by more than
    `reports.compare.branch.CLOSED` of the longest link before it is decided; undecided where it
    has come neither over nor back to its start by its end. It has to have logged its motion.
    """
    motion = run.motion
    assert motion is not None
    one, other = barrier.links
    with np.errstate(all="ignore"):  # what has come apart may overflow
        turned = motion.links[other].theta - motion.links[one].theta
        share = 1.0 + (turned - turned[0]) / barrier.open_rad
        gap = np.max([np.abs(pin) for pin in run.gaps.values()], axis=0)
        apart = gap > CLOSED * barrier.scene.longest_m
    near = np.maximum.accumulate(share < NEAR)
    ends: dict[Passage, Array] = {
        "over": share <= OVER,
        "back": near & (share >= 1.0),
        "broken": apart | ~np.isfinite(share),
    }
    first = {name: int(np.argmax(at)) for name, at in ends.items() if at.any()}
    outcome: Passage = "undecided" if run.status == "ok" else "broken"
    if first:
        outcome = min(first, key=lambda name: first[name])
        return TogglePassage(outcome, first[outcome], abs(barrier.open_rad) * share)
    return TogglePassage(outcome, len(share) - 1, abs(barrier.open_rad) * share)
