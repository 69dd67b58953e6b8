"""How the smallest size is found, and what counts as caught; and `crankcheck selftest` from the
command line: table, files, exit codes, mistakes."""

import io
import json
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest
from rich.console import Console
from typer.testing import Result

from reports.judge.rules import RULES
from reports.judge.rules.rule import Evidence, Finding, Level
from reports.selftest import trial
from reports.selftest.fault import FOURBAR, Fault
from reports.selftest.table import show_faults
from reports.selftest.trial import FAULTS, FaultTrial, Verdict, healthy
from reports.selftest.unseen import UNSEEN
from reports.workers.isolated import Lost
from tests.worlds.command_line import crank, flat
from tests.worlds.tiers import slow

SPIKE = FAULTS["spike"]
OTHER_RULE = replace(SPIKE, rule="CC102")


class Stubborn:
    def __init__(self, rule: str, level: Level) -> None:
        sharp = RULES[rule]
        self.id, self.title, self.level = rule, sharp.title, level
        self.explanation, self.cure = sharp.explanation, sharp.cure

    def check(self, evidence: Evidence) -> Finding | None:
        return Finding(self.id, self.level, "as ever")


Plant = Callable[..., trial.Verdict]


@pytest.fixture
def planted(monkeypatch: pytest.MonkeyPatch) -> Iterator[Plant]:
    """The verdict on a fault in one scene and engine, with nothing remembered of runs without a
    fault, before and after."""

    def tried(fault: Fault, *, search: bool = True) -> trial.Verdict:
        monkeypatch.setitem(FAULTS, fault.name, replace(fault, scenes=(FOURBAR,)))
        return trial.tried(fault.name, ("mujoco",), search=search)

    trial.healthy.cache_clear()
    yield tried
    trial.healthy.cache_clear()


def test_the_smallest_size_that_is_caught_is_found_to_a_tenth_whatever_escapes_below_it() -> None:
    for threshold in (3e-12, 9.99e-6):
        tried: list[float] = []

        def caught(size: float, at: float = threshold, tried: list[float] = tried) -> bool:
            tried.append(size)
            return size >= at

        assert threshold <= trial._least(SPIKE, caught) <= 1.1 * threshold
        assert len(tried) < 15
    for whole in (1, 7, 310):
        least = trial._least(FAULTS["log-cut"], lambda size, at=whole: size >= at)
        assert whole <= least <= 1.1 * whole
        assert least == round(least)
    assert 1e-7 < trial._least(SPIKE, lambda size: size > 1e-7 or size < 1e-9) < 1.1e-7
    assert trial._least(SPIKE, lambda _: True) == 0.0


def test_a_fault_is_caught_with_its_smallest_size(planted: Plant) -> None:
    verdict = planted(SPIKE)
    assert verdict.caught
    least = verdict.least("mujoco")
    assert 1e-7 < least < 1e-5
    for size, seen in ((least, True), (0.8 * least, False)):
        assert planted(replace(SPIKE, size=size), search=False).caught is seen


def test_another_rule_or_other_words_do_not_make_up_for_it(planted: Plant) -> None:
    verdict = planted(OTHER_RULE)
    assert "CC114" in verdict.places[0].failed
    assert not verdict.caught
    gravity = FAULTS["gravity-left-on"]
    assert planted(gravity).caught
    assert not planted(replace(gravity, says=("magnetism",))).caught


def test_rules_that_fail_anyway_are_no_catch(
    planted: Plant, monkeypatch: pytest.MonkeyPatch
) -> None:
    verdict = planted(replace(SPIKE, plant=lambda _: SPIKE.plant(1e-5)))
    assert verdict.places[0].false == ("CC114", "CC118")
    assert (verdict.caught, verdict.sound) == (False, True)
    trial.healthy.cache_clear()
    monkeypatch.setitem(RULES, "CC105", Stubborn("CC105", "fail"))
    verdict = planted(FAULTS["joint-dropped"])
    assert verdict.places[0].finding is not None
    assert verdict.places[0].false == ("CC105",)
    assert (verdict.caught, verdict.sound) == (False, False)


def test_a_fault_that_ends_the_process_or_plants_nothing_is_not_caught(planted: Plant) -> None:
    verdict = trial._lost("spike", Lost("crashed", "the process ended with signal 11"))
    assert not verdict.caught
    assert verdict.lost == "the process ended with signal 11"
    assert verdict.least("mujoco") is None
    verdict = planted(replace(SPIKE, plant=FAULTS["joint-slips"].plant, size=0.0))
    assert not verdict.caught
    assert [place.nothing for place in verdict.places] == [True]
    assert [place.nothing for place in planted(OTHER_RULE).places] == [False]


def test_what_need_not_be_seen_and_plants_nothing_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    idle = replace(UNSEEN[0], plant=lambda _: UNSEEN[0].plant(0.0))
    both = replace(trial.RUNS["motion"], unseen=(UNSEEN[0], idle))
    monkeypatch.setitem(trial.RUNS, "motion", both)
    planted_, nothing = trial.passed_by(("mujoco",))
    assert (planted_.nothing, nothing.nothing) == ((), ("mujoco",))


def selftest(*faults: str, **options: object) -> Result:
    asked = [(f"--{name}", value) for name, value in options.items()]
    words = [*(("--fault", fault) for fault in faults), *asked]
    return crank("selftest", *(word for pair in words for word in pair))


def test_faults_that_are_caught_end_with_0_and_their_smallest_sizes(tmp_path: Path) -> None:
    result = selftest("jump", "nan-at-end", engine="mujoco", csv=tmp_path / "some.csv")
    assert result.exit_code == 0, result.output
    assert "2 of 2 faults caught by the named rule" in result.output
    text = flat(result.output)
    assert "no fault: fourbar-lecture-1, mujoco: all 17 rules pass" in text
    assert "ok jump an angle jumps, and stays 0.0001 rad CC107 4.2e-05" in text
    assert "ok nan-at-end the last angle is NaN CC109 yes" in text
    assert "Profile tuned, 360 steps a turn, 1 turn." in text
    assert "mujoco 4" in text
    assert set(pd.read_csv(tmp_path / "some.csv")["engine"]) == {"mujoco"}


def test_few_faults_are_shown_with_what_the_rule_says() -> None:
    result = selftest("gravity-left-on", engine="pymunk")
    text = flat(result.output)
    assert "caught gravity-left-on: gravity, of which the scene has none" in text
    assert "gravity is (0.0, -9.81), not (0.0, 0.0) m/s^2" in text
    assert "9.81 m/s^2 CC101* any" in text
    assert "* by the model check: the run is refused before its first step" in result.output
    assert "1 of 1 fault caught" in result.output


def test_a_blind_rule_lets_its_faults_go_and_ends_with_1(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(RULES, "CC107", Stubborn("CC107", "pass"))
    result = selftest("jump", "spike", engine="mujoco", jobs=1)
    assert result.exit_code == 1
    text = flat(result.output)
    assert "1 of 2 faults caught by the named rule" in text
    assert "ESCAPES jump: an angle jumps, and stays" in text
    assert "mujoco: CC107 velocity, differenced does not fail; failing: CC114" in text
    assert "OUT jump" in text
    assert "ok spike" in text


def test_files_hold_every_fault_in_every_place(tmp_path: Path) -> None:
    extra = tmp_path / "extra.json"
    result = selftest("jump", "wrong-branch", output=tmp_path / "out", json=extra)
    assert result.exit_code == 0
    table = pd.read_csv(tmp_path / "out" / "selftest.csv")
    assert table.groupby("fault").size().to_dict() == {"jump": 4, "wrong-branch": 4}
    assert table["caught"].all()
    assert (table.loc[table["fault"] == "jump", "from_size"] < 1e-4).all()
    assert table.loc[table["fault"] == "wrong-branch", "from_size"].isna().all()
    content = json.loads(extra.read_text())
    assert json.loads((tmp_path / "out" / "selftest.json").read_text()).keys() == content.keys()
    assert (content["caught"], content["escaped"]) == (2, [])
    assert content["settings"] == {"profile": "tuned", "steps_per_turn": 360, "turns": 1}
    assert {row["passes"] for row in content["without_a_fault"]} == {True}
    assert content["provenance"]["mujoco"].startswith("4")


@slow("a second and a half: sound free runs; its faults are planted in test_faults.py")
def test_faults_of_free_motion_tell_their_runs(tmp_path: Path) -> None:
    file = tmp_path / "free.json"
    result = selftest("energy-missing", engine="pymunk", json=file)
    assert result.exit_code == 0, result.output
    text = flat(result.output)
    assert "ok energy-missing no energy is in the log CC109 yes" in text
    assert "Profile tuned, free motion: fourbar-swing 0.4 ms, 1 s." in text
    assert "steps a turn" not in text
    content = json.loads(file.read_text())
    assert content["settings"]["free"]["fourbar-pulse"] == {"dt_s": 1e-3, "steps": 1500}
    assert "turns" not in content["settings"]


def test_the_table_of_every_fault_fits_and_tells_of_those_that_were_lost() -> None:
    stream = io.StringIO()
    place = FaultTrial(FOURBAR, "mujoco", None, ("CC101", "CC103"), ("CC114",), None)
    every = [Verdict(name, (place,), sound=True) for name in FAULTS]
    every[2] = Verdict(every[2].name, (), sound=False, lost="no end within 600 s")
    sound = [healthy(FOURBAR, "mujoco")]
    show_faults(Console(file=stream, width=80), sound, every, ("mujoco",), {"crankcheck": "1"})
    text = stream.getvalue()
    assert max(len(line.rstrip()) for line in text.splitlines()) <= 80
    assert "\u2026" not in text
    assert "no end within 600 s" in text
    assert "with a size of 0 there fail: CC114" in flat(text)
    assert "escapes" in text
