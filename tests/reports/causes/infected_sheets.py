"""Sheets with a fault in them, and what is told of them."""

from functools import cache
from itertools import cycle

import numpy as np

from models.files.reading import load_scene
from reports.causes.cause import Cause
from reports.causes.find import causes
from tests.worlds.plantings import PLANTINGS
from tests.worlds.sheets import Sheet, sheet

SCENES = ("slider-crank-central", "fourbar-lecture-1", "sixbar-watt")
FAULTS = [name for name, each in PLANTINGS.items() if each.names]
TURN_ABOUT = dict(zip(FAULTS, cycle(SCENES), strict=False))
"""The scene of each fault that is planted once."""
CLEAR = 3.0
"""Times its limit that the error of a planted fault is at least."""
OF_POINTS = {"all_lengths", "points_of_a_tilted_camera"}
"""Faults that fewer than eight channels hardly ever have places for; each channel costs."""


def infected(fault: str, scene: str, seed: int = 0, **options: object) -> tuple[Sheet, list[str]]:
    """The first sheet of a scene, from a seed on, that a fault can be planted in and is seen in."""
    planting = PLANTINGS[fault]
    for number in range(60):
        rng = np.random.default_rng([seed, number, *fault.encode()])
        told = {"even": planting.even or rng.random() < 0.6, **options}
        planted = planting.plant(sheet(load_scene(scene), rng, **told), rng)
        if planted is None:
            continue
        shares = [each.worst / each.limit for each in planted[0].case.excerpts.values()]
        if not planting.names or max(shares) > CLEAR:
            return planted
    raise LookupError(f"{fault} can not be planted in {scene}")


@cache
def diagnosed(fault: str) -> tuple[Sheet, list[str], tuple[Cause, ...]]:
    """A sheet with a fault, the columns that have it, and the causes that are told of it."""
    most = 8 if fault in OF_POINTS else 5
    planted, columns = infected(fault, TURN_ABOUT[fault], rows=300, most=most)
    return planted, columns, tuple(causes(planted.case))
