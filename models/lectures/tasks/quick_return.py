"""The task of a quick return: one way slowly, and back in less time."""

from __future__ import annotations

from typing import Literal

from pydantic import model_validator

from models.files.schema import Positive
from models.lectures.tasks.rocker import Swing
from models.lectures.tasks.stroke import TimeRatio
from models.lectures.tasks.task import TaskTable

NEEDS = {
    "slotted-lever": ("crank_m", "pivots_m", "stroke_m"),
    "whitworth": ("crank_m", "pivots_m", "stroke_m"),
    "crank-rocker": ("rocker_m",),
}
"""What gives a mechanism its size, one of them."""


class QuickReturnTask(TaskTable):
    """A mechanism whose slow stroke takes ``time_ratio`` times the quick one, at constant speed.

    Its size is that of the ``crank_m``, of the distance of the pivots (``pivots_m``) or of the
    ram's ``stroke_m``; of a crank-rocker ``rocker_m``, whose ``swing_deg`` is asked for as well. A
    ram has a rod of ``rod_m``, silent twice its stroke.
    """

    mechanism: Literal["slotted-lever", "whitworth", "crank-rocker"]
    time_ratio: TimeRatio
    crank_m: Positive | None = None
    pivots_m: Positive | None = None
    stroke_m: Positive | None = None
    rocker_m: Positive | None = None
    swing_deg: Swing | None = None
    rod_m: Positive | None = None

    @model_validator(mode="after")
    def _has_one_size(self) -> QuickReturnTask:
        sizes = ("crank_m", "pivots_m", "stroke_m", "rocker_m")
        given = [key for key in sizes if getattr(self, key) is not None]
        own = NEEDS[self.mechanism]
        if len(given) != 1 or given[0] not in own:
            raise ValueError(
                f"found {' and '.join(given) or 'no size'}; a {self.mechanism} is given one of "
                f"{', '.join(own)}"
            )
        if (self.swing_deg is not None) != (self.mechanism == "crank-rocker"):
            raise ValueError(
                "swing_deg: a crank-rocker needs it, and the swing of other mechanisms follows "
                "from the time ratio"
            )
        if self.rod_m is not None and self.stroke_m is None:
            raise ValueError("rod_m: a ram with a rod needs its stroke_m")
        return self
