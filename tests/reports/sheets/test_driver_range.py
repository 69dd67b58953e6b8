"""Driver angles of a sheet: what can be assembled among them."""

from __future__ import annotations

import numpy as np

from models.files import load_scene
from reports.sheets.driver_range import assembled


def test_singular_angles_are_left_out_one_by_one() -> None:
    degrees = np.array([0.0, 45.0, 90.0, 120.0])
    possible = assembled(load_scene("tangent"), np.radians(degrees))
    assert possible.tolist() == [True, True, False, True]
