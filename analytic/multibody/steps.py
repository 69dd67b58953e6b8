"""The steps that an integration has made."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

from scipy.integrate import OdeSolution  # type: ignore[import-untyped]  # ships no stubs

from analytic.multibody.runaway import Pace
from analytic.multibody.singular_passage import SingularPassage
from models.array import Array
from models.errors import CrankcheckError

MOST_STEPS = 1_000_000
FIRST_STEPS, FAR = 2_000, 2.0
"""After so many it is told how many all take, and refused where they are so many times too many."""

CROWD = 200
"""The last steps, which tell how many all would take if they stay as short."""


@dataclass
class Steps:
    """The steps of an integration: their ``pace`` with the times between them, and what is within
    each; ``clear_s`` is the time since which nothing has jumped. ``careful`` if a change point may
    be near, ``tried`` the smallest singular value from which on a passage through it was looked for
    in vain."""

    pace: Pace
    until_s: float
    within: list[Callable[[Array], Array]] = field(default_factory=list)
    passages: list[SingularPassage] = field(default_factory=list)
    clear_s: float = 0.0
    careful: bool = False
    tried: float = math.inf

    def add(self, end_s: float, within: Callable[[Array], Array], speed: float) -> None:
        self.pace.note(end_s, speed)
        self.within.append(within)

    @property
    def times(self) -> list[float]:
        return self.pace.times_s

    @property
    def solution(self) -> OdeSolution:
        return OdeSolution(self.times, self.within)

    @property
    def crowded(self) -> bool:
        """Whether the time that is left would take too many steps, as short as the last ones; it is
        looked at now and then."""
        made, now_s = self.pace.made, self.times[-1]
        if made < CROWD or made % CROWD:
            return False
        return (self.until_s - now_s) * CROWD > FAR * MOST_STEPS * self.pace.lasted_s(CROWD)

    def check_count(self, name: str, now_s: float) -> None:
        """Raises CrankcheckError where the time of a scene takes more steps than can be made."""
        made = len(self.times)
        ahead = made * self.until_s / now_s
        if made > MOST_STEPS or (made >= FIRST_STEPS and ahead > FAR * MOST_STEPS):
            raise CrankcheckError(
                f"{name}: free for {self.until_s:g} s, of which "
                f"{now_s:.3g} s took {made} steps of the integration; at most {MOST_STEPS} are "
                "made, and a load that is switched by the motion may hold it in place, or a "
                f"spring or damper is too stiff: give a time of {now_s * MOST_STEPS / made:.2g} s "
                "or less, or a softer one"
            )
