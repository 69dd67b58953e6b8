"""`crankcheck selftest` from the command line: table, files, exit codes, mistakes."""

from __future__ import annotations

import io
import json
from pathlib import Path

import pandas as pd
import pytest
from rich.console import Console
from typer.testing import Result

from reports.judge.rules import RULES
from reports.judge.rules.rule import Evidence, Finding
from reports.selftest.all_faults import FAULTS
from reports.selftest.table import show
from reports.selftest.trial import FaultTrial, Verdict, healthy
from tests.worlds.command_line import crank, flat, refused

ENGINES = ("mujoco", "pymunk")


def selftest(*faults: str, **options: object) -> Result:
    """The command with some of the faults, and options of it."""
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
    assert "pymunk" not in text.replace("numpy", "")
    assert "model check" not in text
    assert set(pd.read_csv(tmp_path / "some.csv")["engine"]) == {"mujoco"}


def test_few_faults_are_shown_with_what_the_rule_says() -> None:
    result = selftest("gravity-left-on", engine="pymunk")
    text = flat(result.output)
    assert "caught gravity-left-on: gravity, of which the scene has none" in text
    assert "gravity is (0.0, -9.81), not (0.0, 0.0) m/s^2" in text
    assert "9.81 m/s^2 CC101* any" in text
    assert "* by the model check: the run is refused before its first step" in result.output
    assert "1 of 1 fault caught" in result.output


def test_a_blind_rule_lets_its_faults_escape_and_ends_with_1(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    sharp = RULES["CC107"]

    class Blind:
        id, title, explanation, cure = sharp.id, sharp.title, sharp.explanation, sharp.cure

        def check(self, evidence: Evidence) -> Finding | None:
            return Finding(self.id, "pass", "all is well")

    monkeypatch.setitem(RULES, "CC107", Blind())
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


def test_faults_of_free_motion_tell_their_runs(tmp_path: Path) -> None:
    file = tmp_path / "free.json"
    result = selftest("torque-reversed", engine="pymunk", json=file)
    assert result.exit_code == 0, result.output
    text = flat(result.output)
    assert "ok torque-reversed a torque turns the other way CC127 yes" in text
    assert "Profile tuned, let go: fourbar-pulse 1 ms, 1.5 s." in text
    assert "steps a turn" not in text
    content = json.loads(file.read_text())
    assert content["settings"]["free"]["fourbar-pulse"] == {"dt_s": 1e-3, "steps": 1500}
    assert "turns" not in content["settings"]


@pytest.mark.parametrize(
    ("words", "parts"),
    [
        ("--fault gravity-left", ["'gravity-left'", "did you mean gravity-left-on"]),
        ("--fault qqq", ["'qqq'", "use engine-other, engine-renamed"]),
        ("--fault first-order --engine mujoco", ["planted in pymunk only", "mujoco"]),
        ("--forces --free", ["--forces with --free", "ask for one of them"]),
        ("--engine mujoko", ["'mujoko'", "did you mean mujoco"]),
        ("--csv /nowhere/at/all.csv", ["--csv", "no folder"]),
    ],
)
def test_what_can_not_be_planted_ends_with_2(words: str, parts: list[str]) -> None:
    refused(crank("selftest", *words.split()), *parts)


@pytest.fixture(scope="module")
def every_fault() -> list[Verdict]:
    """A verdict on each fault, with sizes as wide as they come; one escapes, one is lost."""
    found = []
    for fault in FAULTS.values():
        finding = Finding(fault.rule, "fail", "seen")
        least = fault.size if fault.whole or fault.shown or not fault.size else 1.2345e-12
        places = [
            FaultTrial(scene, engine, finding, (fault.rule,), (), least)
            for scene in fault.scenes
            for engine in fault.engines
        ]
        found.append(Verdict(fault.name, tuple(places), sound=True))
    found[2] = Verdict(found[2].name, (), sound=False, lost="no end within 600 s")
    lost = FaultTrial("fourbar-lecture-1", "mujoco", None, ("CC101", "CC103"), ("CC114",), None)
    found[5] = Verdict(found[5].name, (lost, *found[5].places[1:]), sound=True)
    return found


def shown(found: list[Verdict], width: int) -> str:
    stream = io.StringIO()
    sound = [healthy("fourbar-lecture-1", engine) for engine in ENGINES]
    show(Console(file=stream, width=width), sound, found, ENGINES, {"crankcheck": "1"})
    return stream.getvalue()


@pytest.mark.parametrize("width", [80, 100])
def test_the_table_fits_the_terminal_with_nothing_clipped(
    every_fault: list[Verdict], width: int
) -> None:
    text = shown(every_fault, width)
    assert max(len(line.rstrip()) for line in text.splitlines()) <= width
    assert "\u2026" not in text
    rows = {(row[1], word.rstrip("*")) for row in map(str.split, text.splitlines())
            for word in row[1:]}  # fmt: skip
    assert {(fault.name, fault.rule) for fault in FAULTS.values()} <= rows
    assert f"{len(FAULTS) - 2} of {len(FAULTS)} faults caught" in text
    assert "no end within 600 s" in text
    assert "with a size of 0 there fail: CC114" in flat(text)
    assert "escapes" in text
    if width == 100:  # there a fault takes one line
        table = text.partition("from on")[2].partition("faults caught")[0]
        lines = [line for line in table.splitlines()[2:] if line.strip()][:-1]  # heads and count
        assert len(lines) == len(FAULTS) + len({fault.group for fault in FAULTS.values()})
