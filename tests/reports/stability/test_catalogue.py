"""The hard cases: each has a truth that stands at all of its values, and says what is right;
drivers near a limit position, and elastic links."""

import math
import re
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from analytic.kinematics import reach, solve
from models.scene import Driver
from models.scene.hard import slider_crank_by_piston, slotted_lever
from models.scene.laws import Oscillating
from reports.stability.case import Trial
from reports.stability.error_series import nearest
from reports.stability.grading import CATALOGUE, graded
from reports.stability.matrix import Graded
from tests.worlds.command_line import crank_alone, flat
from tests.worlds.tiers import few

DRIVEN = [
    (name, value)
    for name, case in CATALOGUE.items()
    for value in case.values
    if case.judge == "follow"
]
HARDEST = {(name, CATALOGUE[name].values[-1]) for name, _ in DRIVEN} - {
    ("triad-excess", 1e-6), ("coupler-near-limit", 0.01)
}  # fmt: skip
"""Without two of half a second and more, which the triad near its limit is like."""


@pytest.mark.parametrize("name", CATALOGUE)
def test_a_case_says_what_is_made_hard_and_what_is_right(name: str) -> None:
    case = CATALOGUE[name]
    facts = case.facts()
    assert re.fullmatch(r"[a-z][a-z0-9-]+", name)
    assert all((facts.title, facts.source, facts.truth, facts.expected, facts.parameter))
    assert len(set(facts.labels)) == len(facts.labels)
    assert [float(text) for text in facts.labels] == list(case.values)
    rising = case.values[-1] > case.values[0]
    assert all((b > a) == rising for a, b in pairwise(case.values))


@pytest.mark.parametrize("name_and_value", few(DRIVEN, HARDEST, "easier than the hardest"), ids=str)
def test_the_reference_survives_every_case(name_and_value: tuple[str, float]) -> None:
    """No number is missing, no warning is given (they are errors), and the bound is a bound."""
    name, value = name_and_value
    trial = CATALOGUE[name].trial(value)
    stride = max(trial.steps // 20_000, 1)
    time_s = trial.dt_s * np.arange(0, trial.steps + 1, stride)
    motion = solve(trial.scene, time_s)
    for link, bound in zip(motion.links.values(), motion.bound.links.values(), strict=True):
        for series in (link.theta, link.omega, link.alpha):
            assert np.isfinite(series).all()
        assert not np.isnan(bound.alpha).any()
        assert np.max(bound.theta) < 1e-3
    for point in motion.points.values():
        assert np.isfinite(point.acceleration).all()


def run_of(name: str, value: float, engine: str = "mujoco", profile: str = "tuned") -> Graded:
    return graded(CATALOGUE[name], engine, profile, value, draw=False)[0]


NEAR = ("triad-near-limit", "piston-near-limit", "coupler-near-limit")


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
    if name in NEAR:  # the end of its range, as near as the case says
        trial = CATALOGUE[name].trial(1.0)
        driven = trial.scene.driver.law.at(trial.dt_s * np.arange(trial.steps + 1))[0].max()
        limit = float(driven) + {"piston-near-limit": 1e-3}.get(name, math.radians(1.0))
        assert min(abs(end - limit) for span in reach(trial.scene) for end in span) < 1e-9


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


def test_an_engine_that_has_no_such_drive_is_a_row_with_a_reason() -> None:
    """By a block in a lever, as by a cylinder; by a piston along a line that is neither x nor y."""
    law = Oscillating(centre_rad=0.22, amplitude_rad=0.05, frequency_rad_s=10.0)
    driver = Driver("block B", law, base="lever", slider="B")
    in_guide = replace(slotted_lever("guided", 0.1, 0.2, source="x"), driver=driver)
    slope = slider_crank_by_piston("sloping", 0.1, 0.3, source="x", amplitude_m=0.09)
    slope = replace(slope, sliders={"C": replace(slope.sliders["C"], direction_rad=0.3)})
    for engine, scene in (("pymunk", in_guide), ("exudyn", slope)):
        trial = Trial(scene)
        case = replace(CATALOGUE["piston-near-limit"], trial=lambda _, trial=trial: trial)
        found, drawn = graded(case, engine, "tuned", 1.0, draw=True)
        assert found.outcome == "unsupported"
        assert "drive" in found.reason
        assert drawn is None
        assert graded(case, "mujoco", "tuned", 1.0, draw=False)[0].outcome == "ok"


def test_how_near_a_block_is_to_its_pivot_is_said() -> None:
    for value, sine in ((1e-6, pytest.approx(0.005, abs=0.005)), (1.0, pytest.approx(1 / 3, 3e-4))):
        trial = CATALOGUE["swinging-lever"].trial(value)
        motion = solve(trial.scene, np.arange(1441) * trial.dt_s, bound=False)
        assert nearest(trial.scene, motion) == sine


def test_an_error_falls_with_the_step_squared_and_what_diverges_says_which_would_do() -> None:
    coarse, fine = (run_of("elastic-step", steps, "pymunk").error for steps in (720.0, 1440.0))
    assert coarse / fine == pytest.approx(4.0, rel=0.2)
    run = run_of("elastic-stiff", 100.0)
    assert run.outcome == "diverged"
    assert "steps a turn, or fewer segments" in run.reason


def test_one_value_is_shown_from_the_command_line() -> None:
    words = ["stability", "elastic-step", "--at", "360", "--profile", "tuned"]
    done, held = (crank_alone(*words, "--engine", engine) for engine in ("pymunk", "mujoco"))
    assert (done.exit_code, held.exit_code) == (1, 0), held.output
    told = flat(done.output)
    assert "a deflection, over the largest, is off by 0.029" in told
    assert "error of the deflection, over the largest: 0.0" in told
