"""What is said of a motion that comes to an infinite speed in a finite time.

A load that grows with the square of the speed that it drives, v' = c v^2, has v = 1 / (c (t* - t)):
no step leads to t*, whatever its size.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from dataclasses import dataclass, field

from models.errors import CrankcheckError, few
from models.scene import Scene

SHARE = 0.9
"""Of the time of a motion that is lost: what is faster after it is held against what was before."""
MANY = 100.0
"""That over which its speed has grown since then, where it grows without bound."""
FEW = 0.05
"""Edges over time in so many steps are not why they are short."""


@dataclass
class Pace:
    """How fast a motion was at the ends of its steps: the largest up to each of them, and the
    last; ``edges`` are the numbers of steps that edges over time end."""

    times_s: list[float] = field(default_factory=list)
    largest: list[float] = field(default_factory=list)
    last: float = 0.0
    edges: list[int] = field(default_factory=list)

    def note(self, time_s: float, speed: float) -> None:
        """The start of the motion, or the end of a step."""
        self.times_s.append(time_s)
        self.largest.append(max(speed, self.largest[-1]) if self.largest else speed)
        self.last = speed

    def end_at_edge(self) -> None:
        """Say that the last step ended at an edge over time."""
        self.edges.append(self.made)

    @property
    def made(self) -> int:
        """How many steps there are."""
        return len(self.times_s) - 1

    def lasted_s(self, count: int) -> float:
        """How long the last ``count`` steps took [s]; infinite where there are not so many, or
        where it is edges over time that made them short."""
        first = self.made - count
        if first < 0 or len(self.edges) - bisect_right(self.edges, first) > FEW * count:
            return math.inf
        return self.times_s[-1] - self.times_s[first]

    def check_runaway(self, scene: Scene, lost_s: float) -> None:
        """Raises CrankcheckError for a motion that is lost at ``lost_s`` [s], if that is because
        its speed goes to infinity.

        It is held against the largest speed before: a motion that turns back is slow for a while.
        """
        before = self.largest[bisect_right(self.times_s, SHARE * lost_s) - 1]
        if not self.last > MANY * before:
            return
        over = [load for load in scene.loads.values() if load.over != "time"]
        named = few([f"loads.{load.name} over {load.over}" for load in over], 6) or "what acts"
        raise CrankcheckError(
            f"{scene.name}: it runs away: at about {lost_s:.4g} s its speed goes to infinity, and "
            f"is over {MANY:g} times what it was up to {SHARE * lost_s:.3g} s; {named} drives it "
            f"ever faster: give a time of {SHARE * lost_s:.2g} s or less, or a load that does not "
            "grow faster than the speed or the way that it goes by"
        )
