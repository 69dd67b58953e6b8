"""The branch that a scene is on, whatever drives it and whatever groups it has.

As far as the driver goes both ways from where it stands at time 0; ends are found by looks, and
refined. A part in which the mechanism is open that is narrower than a look is passed over.
"""

from __future__ import annotations

import math

import numpy as np

from analytic.circuits.arcs import Arc, End
from analytic.prepared import Prepared, prepared
from analytic.reach import shortage
from models.scene import Scene

LOOKS = 1440
"""Looks at a turn of the driver."""
HALVINGS = 60


def own_arc(scene: Scene) -> Arc:
    """The driver's angles about its start [rad]; of a slider its place over the driver's scale.
    Raises ReachError where the scene can not be assembled at its start."""
    ready = prepared(scene)
    ready.chunk(np.array([ready.start]), 0.0, 0.0, None)
    low, high = (_end(ready, way) for way in (-1.0, 1.0))
    if low is None or high is None:
        return Arc(())
    return Arc((), low, high)


def _end(ready: Prepared, way: float) -> End | None:
    """The first driver angle from the start on, one way, beyond which it is open; None where there
    is none within a period."""
    most = max(ready.period, ready.looked_turns * math.tau)
    theta = ready.start + way * np.linspace(0.0, most, LOOKS * round(most / math.tau) + 1)
    opens = np.flatnonzero(shortage(ready.stretched, theta) > 0.0)
    if not opens.size:
        return None
    near, far = float(theta[max(opens[0] - 1, 0)]), float(theta[opens[0]])
    for _ in range(HALVINGS):
        middle = 0.5 * (near + far)
        if shortage(ready.stretched, np.array([middle]))[0] <= 0.0:
            near = middle
        else:
            far = middle
    beyond = ready.stretched(np.array([far])).shortage
    key = max(beyond, key=lambda name: float(np.max(np.nan_to_num(beyond[name], nan=np.inf))))
    return End(near, key)
