"""How the smallest size is found, and what counts as caught."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import pytest

from reports.judge.rules import RULES
from reports.judge.rules.rule import Evidence, Finding, Level
from reports.selftest import trial
from reports.selftest.all_faults import FAULTS
from reports.selftest.fault import FOURBAR, Fault
from reports.selftest.unseen import UNSEEN
from reports.workers.isolated import Lost

SPIKE = FAULTS["spike"]
WHOLE = FAULTS["log-cut"]
OTHER_RULE = replace(SPIKE, rule="CC102")


@pytest.fixture(autouse=True)
def _fresh() -> Iterator[None]:
    """Nothing remembered of runs without a fault, before and after."""
    trial.healthy.cache_clear()
    yield
    trial.healthy.cache_clear()


class Stubborn:
    """A rule that always says the same."""

    title = explanation = cure = ""

    def __init__(self, rule: str, level: Level) -> None:
        self.id, self.level = rule, level

    def check(self, evidence: Evidence) -> Finding | None:
        return Finding(self.id, self.level, "as ever")


Plant = Callable[[Fault], trial.Verdict]


@pytest.fixture
def planted(monkeypatch: pytest.MonkeyPatch) -> Plant:
    """The verdict on a fault in one scene and engine."""

    def tried(fault: Fault, *, search: bool = True) -> trial.Verdict:
        monkeypatch.setitem(FAULTS, fault.name, replace(fault, scenes=(FOURBAR,)))
        return trial.tried(fault.name, ("mujoco",), search=search)

    return tried


@pytest.mark.parametrize("threshold", [3e-12, 4.4e-8, 9.99e-6])
def test_the_smallest_size_that_is_caught_is_found_to_a_tenth(threshold: float) -> None:
    tried: list[float] = []

    def caught(size: float) -> bool:
        tried.append(size)
        return size >= threshold

    assert threshold <= trial._least(SPIKE, caught) <= 1.1 * threshold
    assert len(tried) < 15


@pytest.mark.parametrize("threshold", [1, 2, 7, 100, 309, 310])
def test_of_whole_sizes_a_whole_one_is_found(threshold: int) -> None:
    least = trial._least(WHOLE, lambda size: size >= threshold)
    assert threshold <= least <= max(threshold, 1.1 * threshold)
    assert least == round(least)


def test_what_is_caught_at_every_size_is_caught_from_0_on() -> None:
    assert trial._least(SPIKE, lambda _: True) == 0.0


def test_a_size_that_escapes_between_two_that_are_caught_bounds_the_search() -> None:
    least = trial._least(SPIKE, lambda size: size > 1e-7 or size < 1e-9)
    assert 1e-7 < least < 1.1e-7


def test_a_fault_is_caught_with_its_smallest_size(planted: Plant) -> None:
    verdict = planted(SPIKE)
    assert verdict.caught
    least = verdict.least("mujoco")
    assert 1e-7 < least < 1e-5
    for size, seen in ((least, True), (0.8 * least, False)):
        assert planted(replace(SPIKE, size=size), search=False).caught is seen


def test_a_fault_escapes_where_its_rule_is_blind(
    planted: Plant, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(RULES, "CC114", Stubborn("CC114", "pass"))
    verdict = planted(SPIKE)
    assert (verdict.caught, verdict.sound) == (False, True)
    assert verdict.places[0].finding is None
    assert verdict.least("mujoco") is None


def test_another_rule_that_fails_does_not_make_up_for_it(planted: Plant) -> None:
    verdict = planted(OTHER_RULE)
    assert "CC114" in verdict.places[0].failed
    assert not verdict.caught


def test_the_rule_must_say_the_words_that_it_should(planted: Plant) -> None:
    gravity = FAULTS["gravity-left-on"]
    assert planted(gravity).caught
    assert not planted(replace(gravity, says=("magnetism",))).caught


def test_a_rule_that_fails_without_any_fault_spoils_the_catch(
    planted: Plant, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(RULES, "CC105", Stubborn("CC105", "fail"))
    verdict = planted(FAULTS["joint-dropped"])
    assert verdict.places[0].finding is not None
    assert verdict.places[0].false == ("CC105",)
    assert (verdict.caught, verdict.sound) == (False, False)


def test_a_fault_that_is_there_at_size_0_is_not_caught(planted: Plant) -> None:
    verdict = planted(replace(SPIKE, plant=lambda _: SPIKE.plant(1e-5)))
    assert verdict.places[0].false == ("CC114", "CC118")
    assert (verdict.caught, verdict.sound) == (False, True)


def test_a_fault_that_ends_the_process_is_not_caught() -> None:
    verdict = trial._lost("spike", Lost("crashed", "the process ended with signal 11"))
    assert not verdict.caught
    assert verdict.lost == "the process ended with signal 11"
    assert verdict.least("mujoco") is None


def test_a_fault_that_plants_nothing_fails_and_says_so(planted: Plant) -> None:
    verdict = planted(replace(SPIKE, plant=FAULTS["joint-slips"].plant, size=0.0))
    assert not verdict.caught
    assert [place.nothing for place in verdict.places] == [True]
    assert [place.nothing for place in planted(OTHER_RULE).places] == [False]


def test_what_need_not_be_seen_and_plants_nothing_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    idle = replace(UNSEEN[0], plant=lambda _: UNSEEN[0].plant(0.0))
    monkeypatch.setattr(trial, "UNSEEN", (UNSEEN[0], idle))
    planted_, nothing = trial.passed_by(("mujoco",))
    assert (planted_.nothing, nothing.nothing) == ((), ("mujoco",))
