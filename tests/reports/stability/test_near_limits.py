"""Drivers that come near a limit position: where it is, and what is told of a run that is lost."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.kinematics import reach, solve
from models.errors import ReachError
from models.hard import slider_crank_by_piston, slotted_lever, triad_platform
from models.laws import Oscillating
from models.scene import Driver, Scene
from reports.stability.case import Trial
from reports.stability.catalogue import CATALOGUE
from reports.stability.catalogue.change_points import TRIAD_CRANK_M
from reports.stability.error_series import nearest
from reports.stability.grading import graded
from tests.worlds.tiers import few, slow

NEAR = ("triad-near-limit", "piston-near-limit", "coupler-near-limit")


def limit_of(name: str) -> float:
    """The place of the driver at which a case has its limit [rad or m]."""
    trial = CATALOGUE[name].trial(1.0)
    driven = trial.scene.driver.law.at(trial.dt_s * np.arange(trial.steps + 1))[0].max()
    return float(driven) + {"piston-near-limit": 1e-3}.get(name, math.radians(1.0))


@pytest.mark.parametrize(
    "name", few(NEAR, {"piston-near-limit"}, "ranges of a coupler and a triad take longer")
)
def test_the_driver_comes_as_near_to_the_end_of_its_range_as_the_case_says(name: str) -> None:
    ends = [end for span in reach(CATALOGUE[name].trial(1.0).scene) for end in span]
    limit = limit_of(name)
    assert min(abs(end - limit) for end in ends) < 1e-9


@pytest.mark.parametrize(
    "name",
    few([*NEAR, "triad-excess"], {"piston-near-limit"}, "the same law; a triad takes a second"),
)
def test_what_is_harder_is_nearer_to_a_singular_position(name: str) -> None:
    case, sines = CATALOGUE[name], []
    for value in case.values:
        trial = case.trial(value)
        motion = solve(trial.scene, np.linspace(0.0, trial.scene.driver.law.period_s, 7201))
        sines.append(min(float(sine.min()) for sine in motion.conditioning.values()))
        assert max(float(np.max(each.theta)) for each in motion.bound.links.values()) < 1e-11
    # As the root of what is left, for a limit is a fold.
    powers = np.diff(np.log(sines)) / np.diff(np.log(case.values))
    assert powers[-1] == pytest.approx(0.5, abs=0.06)


@slow("a second: the hardest value of triad-excess would not turn with a shorter limit either")
def test_a_longer_crank_than_the_longest_that_turns_does_not_turn() -> None:
    time_s = np.linspace(0.0, 0.7, 2000)
    solve(triad_platform("turns", TRIAD_CRANK_M - 1e-6, source="x"), time_s, bound=False)
    with pytest.raises(ReachError, match="limit position"):
        solve(triad_platform("turns-not", TRIAD_CRANK_M + 1e-6, source="x"), time_s, bound=False)


def test_a_triad_that_goes_over_to_another_assembly_is_named() -> None:
    found, _ = graded(CATALOGUE["triad-near-limit"], "mujoco", "as-shipped", 0.01, draw=False)
    assert found.outcome == "branch-changed"


def test_a_lost_run_of_a_driven_slider_is_told_in_metres_and_drawn() -> None:
    case = CATALOGUE["piston-near-limit"]
    assert case.facts().driver_unit == "m"
    found, drawn = graded(case, "mujoco", "as-shipped", 1.0, draw=True)
    assert found.outcome == "branch-changed"
    assert 0.2 < found.at_driver_rad < 0.4
    told = drawn.drawing["told"]
    assert (told["joint"], told["unit"]) == ("slider C", "m")  # type: ignore[index]  # as embedded
    place = np.asarray(told["at"])  # type: ignore[index]  # as above
    assert (place > 0.2).all()
    assert (place < 0.4).all()


def in_a_moving_guide() -> Scene:
    """A crank that is driven by a block in a lever, as by a cylinder."""
    scene = slotted_lever("lever-by-block", 0.1, 0.2, source="x")
    law = Oscillating(centre_rad=0.22, amplitude_rad=0.05, frequency_rad_s=10.0)
    return replace(scene, driver=Driver("block B", law, base="lever", slider="B"))


def along_a_slope() -> Scene:
    """A slider-crank that is driven by its piston along a line that is neither x nor y."""
    scene = slider_crank_by_piston("piston-on-slope", 0.1, 0.3, source="x", amplitude_m=0.09)
    return replace(scene, sliders={"C": replace(scene.sliders["C"], direction_rad=0.3)})


@pytest.mark.parametrize(
    ("engine", "scene"), [("pymunk", in_a_moving_guide()), ("exudyn", along_a_slope())]
)
def test_an_engine_that_cannot_do_a_driver_is_a_row_with_its_reason(
    engine: str, scene: Scene
) -> None:
    case = replace(CATALOGUE["piston-near-limit"], trial=lambda _: Trial(scene))
    found, drawn = graded(case, engine, "tuned", 1.0, draw=True)
    assert found.outcome == "unsupported"
    assert "drive" in found.reason
    assert drawn is None
    assert graded(case, "mujoco", "tuned", 1.0, draw=False)[0].outcome == "ok"


@pytest.mark.parametrize(
    ("case", "value", "least"),
    [("lever-through-pivot", 360.0, 0.01), ("swinging-lever", 1e-6, 0.01)],
)
def test_a_lever_whose_block_comes_to_its_pivot_is_said_to_be_near(
    case: str, value: float, least: float
) -> None:
    trial = CATALOGUE[case].trial(value)
    motion = solve(trial.scene, np.arange(1441) * trial.dt_s, bound=False)
    assert 0.0 <= nearest(trial.scene, motion) < least


def test_a_scene_far_from_singular_positions_is_said_to_be_far() -> None:
    trial = CATALOGUE["swinging-lever"].trial(1.0)
    motion = solve(trial.scene, np.arange(1441) * trial.dt_s, bound=False)
    assert nearest(trial.scene, motion) == pytest.approx(1.0 / 3.0, abs=1e-4)
