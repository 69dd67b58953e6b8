"""What is said of a motion that comes to an infinite speed in a finite time.

A load that grows with the square of the speed that it drives, v' = c v^2, has v = 1 / (c (t* - t)):
no step leads to t*, whatever its size.
"""

from __future__ import annotations

from models.errors import CrankcheckError, few
from models.scene import Scene

SHARE = 0.9
"""Of the time of a motion that is lost: from then on its speed is looked at."""
MANY = 100.0
"""That over which it has grown since then, where it grows without bound."""


def check_runaway(scene: Scene, lost_s: float, grown: float) -> None:
    """Raises CrankcheckError for a motion that is lost at ``lost_s`` [s], where its speed has
    ``grown`` so many times since `SHARE` of that time, if that is why."""
    if not grown > MANY:
        return
    over = [load for load in scene.loads.values() if load.over != "time"]
    named = few([f"loads.{load.name} over {load.over}" for load in over], 6) or "what acts"
    raise CrankcheckError(
        f"{scene.name}: it runs away: at about {lost_s:.4g} s its speed goes to infinity, and has "
        f"grown {grown:.1g} times since {SHARE * lost_s:.3g} s; {named} drives it ever faster: "
        f"give a time of {SHARE * lost_s:.2g} s or less, or a load that does not grow faster than "
        "the speed or the way that it goes by"
    )
