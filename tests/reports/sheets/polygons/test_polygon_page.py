"""What the page of polygons holds; `tests.reports.page` opens it."""

from __future__ import annotations

import base64
import json
import re

import numpy as np
import pytest

from analytic.drawings.drawn_polygons import draw_polygons
from analytic.drawings.placed_mechanism import DriverState, PlacedMechanism
from models.errors import CrankcheckError
from models.files import load_scene
from reports.sheets.polygons.polygon_instant import placed_at_angle
from reports.sheets.polygons.polygon_page import INSTANTS, polygon_page


def embedded(page: str) -> dict:
    match = re.search(r'id="embedded-polygons">(.*?)</script>', page)
    return json.loads(match[1])  # type: ignore[no-any-return]  # an object, as it was written


def unpacked(packed: dict) -> np.ndarray:
    whole = np.frombuffer(base64.b64decode(packed["base64"]), "<i2").astype(float)
    whole[whole == -32768] = np.nan
    return whole.reshape(-1, packed["samples"]) * np.array(packed["scales"])[:, None]


def test_the_page_holds_the_polygons_of_each_instant() -> None:
    placed = placed_at_angle(load_scene("slotted-lever"), 50.0)
    own = embedded(polygon_page(placed))
    at = own["home"]
    assert own["drawing"]["told"]["at"][at] == pytest.approx(50.0)
    drawn = draw_polygons(placed.scene, placed.driver)
    for embedded_one, polygon in zip(
        own["polygons"], (drawn.velocity, drawn.acceleration), strict=True
    ):
        rows = unpacked(embedded_one["rows"])[:, at].reshape(-1, 4)
        assert [one["name"] for one in embedded_one["vectors"]] == [v.name for v in polygon.vectors]
        exact = np.array([[*v.start, *v.end] for v in polygon.vectors])
        assert rows == pytest.approx(exact, abs=2e-4 * np.abs(rows).max())


def test_of_a_link_that_does_not_turn_the_page_has_rates_of_exactly_0() -> None:
    own = embedded(polygon_page(placed_at_angle(load_scene("scotch-yoke"), 50.0)))
    rows = unpacked(own["links"]["rows"])
    number = own["links"]["names"].index("yoke")
    assert np.all(rows[2 * number : 2 * number + 2] == 0.0)


def test_a_speed_of_ones_own_is_that_of_the_whole_turn() -> None:
    placed = placed_at_angle(load_scene("fourbar-swing"), 90.0, 3.0)
    own = embedded(polygon_page(placed, steady=True))
    assert own["drawing"]["told"]["at"][-1] - own["drawing"]["told"]["at"][0] == pytest.approx(
        360.0
    )
    assert len(own["drawing"]["told"]["at"]) == INSTANTS


def test_a_driver_that_goes_through_no_turn_is_refused() -> None:
    scene = load_scene("fourbar-double-rocker")
    with pytest.raises(CrankcheckError):
        polygon_page(PlacedMechanism.of(scene, DriverState(1.0, 1.0)), steady=True)
