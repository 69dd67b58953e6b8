"""The hard cases: each has a truth that stands at all of its values, and says what is right."""

from __future__ import annotations

import re
from itertools import pairwise

import numpy as np
import pytest

from analytic.kinematics import solve
from reports.stability.catalogue import CATALOGUE, GROUPS
from tests.worlds.tiers import few

DRIVEN = [
    (name, value)
    for name, case in CATALOGUE.items()
    for value in case.values
    if case.judge == "follow"
]
HARDEST = {(name, CATALOGUE[name].values[-1]) for name, _ in DRIVEN}
MOST_SAMPLES = 20_000


def test_every_group_of_the_catalogue_has_cases_of_its_own() -> None:
    assert len(GROUPS) == 15
    assert sum(len(cases) for cases in GROUPS.values()) == len(CATALOGUE)


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
    stride = max(trial.steps // MOST_SAMPLES, 1)
    time_s = trial.dt_s * np.arange(0, trial.steps + 1, stride)
    motion = solve(trial.scene, time_s)
    for link, bound in zip(motion.links.values(), motion.bound.links.values(), strict=True):
        for series in (link.theta, link.omega, link.alpha):
            assert np.isfinite(series).all()
        assert not np.isnan(bound.alpha).any()
        assert np.max(bound.theta) < 1e-3
    for point in motion.points.values():
        assert np.isfinite(point.acceleration).all()
