"""The mechanism as it stands in each of its precision positions."""

from __future__ import annotations

import itertools
import math

import numpy as np

from analytic.circuits.arcs import SignedScene
from analytic.kinematics import solve_driven
from analytic.lectures.drawings.placed_mechanism import DriverState, PlacedMechanism
from analytic.lectures.synthesis.asked import PrecisionPosition
from analytic.lectures.synthesis.examine import UNMET, Examined
from models.errors import ReachError
from models.scene import Scene
from reports.lectures.drawing.sheets.driver_range import sense_of_law


def placements_of(examined: Examined) -> tuple[PlacedMechanism | None, ...]:
    """The mechanism in each position, on the branch that meets it, even where the driver can not
    lead there; None where it can not be assembled at the driver's angle."""
    return tuple(_placed(examined.scene, position) for position in examined.positions)


def _placed(scene: Scene, position: PrecisionPosition) -> PlacedMechanism | None:
    """On the scene's own branches where these meet the position, else on those that are nearest."""
    signed = SignedScene.of(scene)
    every = (
        signed.with_signs(signs) for signs in itertools.product((1, -1), repeat=len(signed.dyads))
    )
    least, best = math.inf, None
    for one in (scene, *every):
        off, placed = _standing(one, position)
        if off < least:
            least, best = off, placed
        if least <= UNMET:
            break
    return best


def _standing(scene: Scene, position: PrecisionPosition) -> tuple[float, PlacedMechanism | None]:
    """How far off a position a scene is, and how it stands there."""
    theta, one = np.array([position.driver_rad]), np.ones(1)
    try:
        motion = solve_driven(scene, theta, one, 0.0 * one, bound=False)
    except ReachError:
        return math.inf, None
    state = DriverState(position.driver_rad, sense_of_law(scene))
    off = float(position.off(motion, scene.longest_m)[0])
    return off, PlacedMechanism.standing(scene, motion, state)
