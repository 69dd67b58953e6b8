"""Mechanisms of other kinds than the linkages of the stranger, and parts of what may be logged."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache

import numpy as np

from models.files.reading import load_scene
from models.scene import Scene
from models.scene.hard import double_parallelogram
from reports.logs.channel import Channel
from tests.worlds.plantings import PLANTINGS
from tests.worlds.sheets import Sheet, sheet

KINDS: Mapping[str, Callable[[], Scene]] = {
    "slotted lever": lambda: load_scene("slotted-lever"),
    "Scotch yoke": lambda: load_scene("scotch-yoke"),
    "inverted slider-crank": lambda: load_scene("whitworth"),
    "swinging driver": lambda: load_scene("tangent"),
    "parallel links": lambda: double_parallelogram("parallel", source="three rockers"),
}
"""By kind, what makes a scene of it."""
PARTS: Mapping[str, Callable[[Channel], bool]] = {
    "all": lambda channel: True,
    "places": lambda channel: channel.kind.order == 0,
    "rates": lambda channel: channel.kind.order > 0,
    "without the crank": lambda channel: channel.of not in ("crank", "B"),
}
"""What of a log is there."""
SAMPLING: Mapping[str, tuple[int, float]] = {
    "plain": (180, 3.0),
    "coarse, many turns": (200, 29.0),
    "part of a turn": (150, 0.6),
}
"""Rows and turns."""


@cache
def scene_of(kind: str) -> Scene:
    return KINDS[kind]()


def infected(kind: str, fault: str, part: str, sampling: str, limit: float) -> Sheet | None:
    """The first log of a kind of mechanism with a fault that is seen in it, in a part of its
    channels; None where there is none."""
    rows, turns = SAMPLING[sampling]
    for number in range(8):
        rng = np.random.default_rng([number, *f"{kind}{fault}{part}{sampling}".encode()])
        scene = scene_of(kind)
        whole = sheet(scene, rng, rows=rows, turns=turns, even=number % 2 == 0, limit=limit)
        channels = {c: each for c, each in whole.channels.items() if PARTS[part](each)}
        if not channels:
            continue
        limits = {column: whole.limits[column] for column in channels}
        planted = PLANTINGS[fault].plant(replace(whole, channels=channels, limits=limits), rng)
        if planted is not None and (planted[0].case.out or not PLANTINGS[fault].names):
            return planted[0]
    return None
