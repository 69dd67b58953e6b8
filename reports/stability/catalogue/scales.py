"""The same four-bar small and large, far from the origin, and turned."""

from __future__ import annotations

import math
from functools import partial

from models.files.reading import load_scene
from models.moved_scene import moved, rotated, scaled
from reports.stability.case import Case, Trial

SOURCE = "fourbar-lecture-1"
LONGEST_M = 0.3


def _sized(longest_m: float) -> Trial:
    return Trial(scaled(load_scene(SOURCE), longest_m / LONGEST_M))


def _offset(lengths: float) -> Trial:
    scene = load_scene(SOURCE)
    return Trial(moved(scene, (lengths * scene.longest_m, -0.7 * lengths * scene.longest_m)))


def _turned(angle_deg: float) -> Trial:
    return Trial(rotated(load_scene(SOURCE), math.radians(angle_deg)))


_case = partial(
    Case,
    source=SOURCE,
    truth="closed form; a mechanism does not know where it stands, nor how large it is",
    expected="the same error as a pure number",
)
_size = partial(_case, parameter="longest link", unit="m", trial=_sized)
CASES = (
    _size(name="small", title="Smaller and smaller", values=(1.0, 0.1, 1e-2, 1e-3, 1e-4)),
    _size(name="large", title="Larger and larger", values=(1.0, 10.0, 100.0, 1e3, 1e4)),
    _case(
        name="far-away",
        title="Far from the origin",
        parameter="distance over the longest link",
        values=(1.0, 1e3, 1e6, 1e8, 1e10),
        trial=_offset,
    ),
    _case(
        name="turned",
        title="The plane turned",
        parameter="angle",
        unit="deg",
        values=(0.0, 30.0, 45.0, 90.0, 137.0, 180.0, 270.0),
        trial=_turned,
        scale="linear",
    ),
)
