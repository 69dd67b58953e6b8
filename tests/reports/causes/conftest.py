"""Sheets with a fault in them, and what is told of them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from models.files import load_scene
from tests.worlds.plantings import PLANTINGS
from tests.worlds.sheets import Sheet, sheet

Infected = Callable[..., tuple[Sheet, list[str]]]
CLEAR = 3.0
"""Times its limit that the error of a planted fault is at least."""


@pytest.fixture(scope="session")
def infected() -> Infected:
    """The first sheet of a scene, from a seed on, that a fault can be planted in and is seen in."""

    def plant(fault: str, scene: str, seed: int = 0, **options: object) -> tuple[Sheet, list[str]]:
        planting = PLANTINGS[fault]
        for number in range(60):
            rng = np.random.default_rng([seed, number, *fault.encode()])
            told = {"even": planting.even or rng.random() < 0.6, **options}
            planted = planting.plant(sheet(load_scene(scene), rng, **told), rng)
            if planted is None:
                continue
            case = planted[0].case
            shares = [each.worst / each.limit for each in case.excerpts.values()]
            if not planting.names or max(shares) > CLEAR:
                return planted
        raise LookupError(f"{fault} can not be planted in {scene}")

    return plant
