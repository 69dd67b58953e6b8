"""What the page of a construction holds; `tests.reports.page` opens it."""

from __future__ import annotations

import json
import math
import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from analytic.synthesis.construction import Circle, Curve, Dot, Segment, Step
from analytic.synthesis.design import Proposal
from reports.drawing.shape import turn_of
from reports.sheets.constructions.construction_page import INSTANTS, MOVES, construction_page
from reports.sheets.constructions.construction_view import ConstructionView
from reports.sheets.constructions.positions_on_way import positions_on_way
from tests.reports.sheets.constructions.constructed import (
    burmester_curves,
    rocker_by_angle,
    three_positions,
)


def embedded(page: str) -> dict[str, Any]:
    match = re.search(r'id="embedded-construction">(.*?)</script>', page)
    return json.loads(match[1])  # type: ignore[no-any-return]  # an object, as it was written


@pytest.mark.parametrize("make", [three_positions, rocker_by_angle, burmester_curves])
def test_the_page_holds_every_step_and_its_words(make: Any) -> None:
    proposal: Proposal = make()
    page = construction_page(proposal)
    words = re.findall(r"<li><button type=\"button\">(.*?)</button></li>", page)
    assert words == [*(step.words for step in proposal.steps), MOVES]
    for step, drawn in zip(proposal.steps, embedded(page)["steps"], strict=True):
        for element, own in zip(step.elements, drawn, strict=True):
            if isinstance(element, Dot):
                place = [element.place.real, element.place.imag]
                assert own["at"] == pytest.approx(place, rel=1e-5, abs=1e-12)
                assert own["letter"] == element.letter
            if isinstance(element, Segment) and not element.beyond:
                (ends,) = own["lines"]
                length = math.dist(ends[:2], ends[2:])
                assert length == pytest.approx(abs(element.end - element.start), rel=1e-5)
            if isinstance(element, Circle):
                places = np.concatenate(own["lines"]).reshape(-1, 2)
                away = np.hypot(*(places - (element.centre.real, element.centre.imag)).T)
                assert away == pytest.approx(element.radius, rel=1e-5)
            if isinstance(element, Curve):
                assert own["look"].startswith("curve-")
                assert own["lines"]


def test_the_motion_meets_each_position_where_the_page_stops() -> None:
    view = ConstructionView.of(three_positions())
    motion = turn_of(view.examined.scene, INSTANTS)
    theta = motion.links["input"].theta
    for at, position in zip(positions_on_way(view, motion), view.examined.positions, strict=True):
        assert at is not None
        here = np.interp(at, np.arange(INSTANTS), theta)
        assert math.remainder(here - position.driver_rad, math.tau) == pytest.approx(0.0, abs=1e-9)


def test_a_position_that_the_driver_can_not_lead_to_is_no_stop_and_told() -> None:
    page = construction_page(burmester_curves())
    own = embedded(page)
    assert None in own["at"]
    assert own["at"][0] is not None
    assert len(own["poses"]) == 4
    assert "It has a fault: circuit defect." in page


def test_the_asked_link_stands_in_each_pose() -> None:
    own = embedded(construction_page(three_positions()))
    view = ConstructionView.of(three_positions())
    for pose, placed in zip(own["poses"], view.placements, strict=True):
        assert placed is not None
        assert len(pose["links"]) == 1
        ends = np.concatenate([placed.points["C"], placed.points["D"]])
        assert pose["links"][0] == pytest.approx(list(ends), rel=1e-5)


def test_hostile_words_are_text() -> None:
    proposal = three_positions()
    evil = "</script><script>window.hacked=1</script><img src=x>"
    steps = (*proposal.steps, Step(evil, (Dot(0j, evil),)))
    page = construction_page(replace(proposal, steps=steps, doubt=evil, chosen={evil: evil}))
    assert "<img" not in page
    assert "<script>window" not in page


def test_what_is_chosen_is_told() -> None:
    assert "Chosen: O2 from the middle of B1 B2, 0.3 m." in construction_page(rocker_by_angle())
