"""How many windows an integration makes, and when it is told that they are too many."""

from __future__ import annotations

from analytic.multibody.runaway import Pace
from models.errors import CrankcheckError
from models.scene import Scene

MOST_WINDOWS = 50_000
"""A thousand seconds of a crank's length of a tenth of a metre take half of them, and minutes."""
FIRST_WINDOWS, FAR = 300, 4.0
"""After so many it is told how many all take, and refused where they are so many times too many."""


def check_count(scene: Scene, until_s: float, pace: Pace) -> None:
    """Raises CrankcheckError where the time takes more windows than can be worked out."""
    made, now_s = pace.made, pace.times_s[-1]
    lasted_s = pace.lasted_s(FIRST_WINDOWS)
    if (until_s - now_s) * FIRST_WINDOWS > FAR * MOST_WINDOWS * lasted_s:
        pace.check_runaway(scene, now_s)
    ahead = made * until_s / now_s
    if made >= MOST_WINDOWS or (made >= FIRST_WINDOWS and ahead > FAR * MOST_WINDOWS):
        raise CrankcheckError(
            f"{scene.name}: free for {until_s:g} s, of which {now_s:.3g} s took "
            f"{made} windows of the integration; at most {MOST_WINDOWS} are made: give a time "
            f"of {now_s * MOST_WINDOWS / made:.2g} s or less"
        )
