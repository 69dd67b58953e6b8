"""A scene where something is asked of it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from analytic.kinematics import solve_driven
from analytic.lectures.synthesis.asked import PrecisionPosition, names_of
from models.motion import Motion
from models.scene import Scene


def asked_motion(scene: Scene, positions: Sequence[PrecisionPosition]) -> Motion:
    """The scene at the driver's angles of positions (P,), of what is asked alone.

    Raises
    ------
    ReachError
        An angle at which it can not be assembled.
    """
    links, points, sliders = names_of(positions)
    return solve_driven(
        scene,
        np.array([position.driver_rad for position in positions]),
        np.ones(1),
        np.zeros(1),
        links=links,
        points=points,
        sliders=sliders,
        bound=False,
    )
