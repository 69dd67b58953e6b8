"""Letting a driven mechanism go: where its law has it at time 0, and how fast."""

from __future__ import annotations

import math

import pytest

from models.files import load_scene
from models.released import Released, let_go


@pytest.mark.parametrize("name", ["fourbar-lecture-1", "fourbar-double-rocker", "slotted-lever"])
def test_it_begins_where_the_law_is_and_lasts_ten_of_its_turns(name: str) -> None:
    scene = load_scene(name)
    law, free = scene.driver.law, let_go(scene)
    assert free.is_free
    assert isinstance(free.driver.law, Released)
    assert free.driver.law.start_rad == pytest.approx(float(law.at(0.0)[0]))
    assert free.driver.law.speed_rad_s == pytest.approx(float(law.at(0.0)[1]))
    assert free.driver.law.duration_s == pytest.approx(10.0 * law.period_s)
    assert (free.links, free.branch, free.driver.link) == (
        scene.links,
        scene.branch,
        scene.driver.link,
    )


def test_what_is_let_go_already_stays_as_it_is_but_for_a_time_that_is_given() -> None:
    scene = load_scene("fourbar-swing")
    assert let_go(scene) is scene
    longer = let_go(scene, 12.0)
    assert longer.driver.law.period_s == 12.0
    assert longer.driver.law.offset_rad == math.fabs(scene.driver.law.offset_rad)
