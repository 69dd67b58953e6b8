"""`crankcheck stability --baseline`: what counts as worse, and what is within doubt or rounding."""

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import pytest

from reports.stability.baseline import changes, is_worse
from reports.stability.grading import CATALOGUE
from reports.stability.matrix import Critical, Graded, Matrix, Outcome, to_json
from sim.engine import Setting
from sim.registry import engine
from tests.worlds.command_line import crank, crank_alone, flat, refused

CASE = replace(CATALOGUE["grashof-excess"], values=(1e-2, 1e-3, 1e-4), labels=()).facts()


def matrix(
    outcomes: Mapping[float, tuple[Outcome, float]],
    holds: float,
    fails: float,
    case: str = CASE.name,
) -> Matrix:
    """A run of the one case, with outcome and error at each value, and its critical value."""
    line = (case, "pymunk", "tuned")
    runs = tuple(
        Graded(*line, value, f"{value:g}", outcome, "", error=error)
        for value, (outcome, error) in outcomes.items()
    )
    critical = Critical(*line, holds, fails, "ok", "", "")
    return Matrix({}, (replace(CASE, name=case),), runs, (critical,))


GOOD: Mapping[float, tuple[Outcome, float]] = {
    1e-2: ("ok", 1e-4),
    1e-3: ("ok", 9.9e-3),
    1e-4: ("degraded", 0.1),
}
OLD = matrix(GOOD, 5e-4, 4.8e-4)
WORSE: Mapping[str, tuple[Matrix, str]] = {
    "a value that held": (
        matrix({**GOOD, 1e-3: ("degraded", 0.02)}, 5e-4, 4.8e-4),
        "at 0.001 [m] ok before, degraded now",
    ),
    "a failed one that fails more gravely": (
        matrix({**GOOD, 1e-4: ("diverged", math.nan)}, 5e-4, 4.8e-4),
        "at 1e-4 [m] degraded before, diverged now",
    ),
    "a critical value, by more than both ranges": (
        matrix(GOOD, 5.5e-4, 5.3e-4),
        "critical value [m] holds 5e-4, fails 4.8e-4 before, holds 5.5e-4, fails 5.3e-4 now",
    ),
    "a critical value that is none any more": (
        matrix(GOOD, math.nan, 1e-2),
        "critical value [m] holds 5e-4, fails 4.8e-4 before, fails 0.01 now",
    ),
}
EQUAL: Mapping[str, Matrix] = {
    "the same": OLD,
    "ranges that touch": matrix(GOOD, 5.2e-4, 5e-4),
    "an error over the class by rounding": matrix(
        {**GOOD, 1e-3: ("degraded", 1.01e-2)}, 5e-4, 4.8e-4
    ),
    "another name of the same failure": matrix({**GOOD, 1e-4: ("drifts", 0.1)}, 5e-4, 4.8e-4),
    "values that only one run has": matrix({**GOOD, 5.1e-4: ("crashed", math.nan)}, 5e-4, 4.8e-4),
}


@pytest.mark.parametrize("what", WORSE)
def test_what_got_worse_is_named_and_its_reverse_is_better(what: str) -> None:
    new, text = WORSE[what]
    (found,) = changes(OLD, new)
    assert (found.word, found.line, found.text) == ("worse", OLD_LINE, text)
    (back,) = changes(new, OLD)
    assert back.word == "better"
    assert not is_worse([back])


OLD_LINE = (CASE.name, "pymunk", "tuned")


@pytest.mark.parametrize("what", EQUAL)
def test_what_doubt_and_rounding_explain_is_no_change(what: str) -> None:
    assert changes(OLD, EQUAL[what]) == []
    assert changes(EQUAL[what], OLD) == []


def test_cases_of_one_run_and_those_that_changed_are_not_compared() -> None:
    wide = matrix({1e-3: ("crashed", math.nan)}, math.nan, 1e-2)
    wide = replace(wide, cases=(replace(CASE, within=0.5),))
    other = matrix(GOOD, 5e-4, 4.8e-4, case="heavy-rocker")
    for new, texts in ((wide, ["the case is another one now"]), (other, ["not run now", "new"])):
        found = changes(OLD, new)
        assert [each.text for each in found] == texts
        assert not is_worse(found)


LINE = ("stability", "coarse-step", "--engine", "pymunk", "--profile", "tuned", "--jobs", 1)


def test_the_gate_is_open_for_itself_and_shut_for_a_weaker_profile(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Both runs in one process, whose profile is weakened between them."""
    assert crank_alone(*LINE, "-o", tmp_path).exit_code == 0
    again = crank_alone(*LINE, "--baseline", tmp_path)
    assert again.exit_code == 0, again.output
    assert "NOT WORSE: 0 worse, 0 better" in again.stdout
    held = engine("pymunk").profiles
    weak = {**held["tuned"].settings, "error_bias": Setting(0.9, "slow")}
    monkeypatch.setitem(held, "tuned", replace(held["tuned"], settings=weak))
    worse = crank_alone(*LINE, "--baseline", tmp_path / "stability.json")
    assert worse.exit_code == 1, worse.output
    assert "worse coarse-step pymunk tuned: at 360 ok before, " in flat(worse.stdout)
    assert "worse coarse-step pymunk tuned: critical value holds 42.7, fails" in flat(worse.stdout)


def test_what_can_not_be_compared_is_refused_before_the_run(tmp_path: Path) -> None:
    refused(crank(*LINE, "--baseline", tmp_path), "no stability.json in it")
    refused(crank(*LINE, "--baseline", tmp_path, "--at", 90), "--at and --baseline: one value")
    (tmp_path / "old.json").write_text(to_json(OLD), encoding="utf-8")
    refused(
        crank(*LINE, "--baseline", tmp_path / "old.json"),
        "holds no case, engine and profile that is to run now, but grashof-excess pymunk tuned",
    )


def test_an_earlier_run_whose_case_is_gone_from_its_file_is_refused(tmp_path: Path) -> None:
    text = to_json(matrix(GOOD, 5e-4, 4.8e-4, case="coarse-step"))
    path = tmp_path / "old.json"
    path.write_text(text.replace('"name": "coarse-step"', '"name": "gone"'), encoding="utf-8")
    refused(crank(*LINE, "--baseline", path), "'coarse-step' is not among its cases")
