"""`crankcheck explain`: rules, clauses, and a cell whose parts are found a second way."""

import math
import re

import numpy as np
import pytest

import crankcheck
from reports.contract.clauses import CLAUSES
from reports.judge.known import KnownFailure
from reports.judge.rules import RULES
from reports.requests.explain import HELPS
from tests.worlds.command_line import crank, flat, refused, told
from tests.worlds.tiers import slow

CELL = "explain fourbar-lecture-1 --engine mujoco --steps-per-turn 360"


@pytest.mark.parametrize("name", [*RULES, "cc110", "EC52"])
def test_a_rule_or_a_clause_says_why_and_what_helps(name: str) -> None:
    output = flat(told(f"explain {name}"))
    entry = {**RULES, **CLAUSES}[name.upper()]
    assert f"{entry.id}: {flat(entry.title)}" in output
    assert flat(entry.cure) in output
    reason = getattr(getattr(entry, "tolerance", None), "reason", "")
    assert flat(reason) in output


REFUSED = {
    "explain CC13": "no such rule, clause or scene; did you mean CC1",
    "explain fourbar-lectur --engine mujoco": "did you mean fourbar-lecture-",
    "explain 77": "see `crankcheck scenes`",
    "explain shaper": "--engine is missing: name the one that runs shaper",
    "explain CC110 --engine mujoco": "--engine: for a scene, and CC110 is none",
    "explain shaper --engine mujoca": "mujoco",
    "explain shaper --engine mujoco --profile tunde": "tuned",
}


@pytest.mark.parametrize("line", REFUSED)
def test_an_unknown_name_is_refused_with_near_ones(line: str) -> None:
    refused(crank(*line.split()), REFUSED[line])


NUMBER = r"([-+]?\d[\d.]*(?:e-?\d+)?)"
ADDED = ("drive", "model floor", "discretisation")


def parts_in(output: str) -> dict[str, float]:
    """The numbers of the printed parts, two digits each."""
    found = {part: re.search(rf"  {part} {NUMBER}[ :]", output) for part in HELPS}
    return {part: float(each[1]) for part, each in found.items() if each}


def test_the_parts_of_a_cell_are_those_of_runs_and_solutions() -> None:
    """As shipped: the drive by solving at the logged angles, the floor by a run at a sixteenth of
    the step; and what is no part of the error stands apart from it."""
    output = told(f"{CELL} --profile as-shipped")
    parts, digits = parts_in(output), 0.06
    assert parts.keys() == HELPS.keys()
    added, others = output.split("no part of it: ")
    assert parts_in(added).keys() == {*ADDED}
    assert parts_in(others).keys() == HELPS.keys() - {*ADDED}
    options = {"steps_per_turn": 360, "turns": 2}
    run = crankcheck.run("fourbar-lecture-1", "mujoco", "as-shipped", **options)
    crank_rad = run.motion.links["crank"].theta
    reference = crankcheck.solve("fourbar-lecture-1", time_s=run.motion.time_s)
    off = np.abs(np.unwrap(crank_rad) - reference.links["crank"].theta).max()
    assert parts["drive"] < 10.0 * off + 1e-12
    gaps = max(np.abs(gap).max() for gap in run.gaps.values())
    assert parts["closure"] == pytest.approx(gaps / 0.25, rel=digits)  # the coupler is the longest
    lag_s = (run.velocity_time_s - run.motion.time_s)[0]
    assert parts["sampling phase"] == pytest.approx(lag_s / run.dt_s, rel=digits)
    finer = crankcheck.check(
        "fourbar-lecture-1", "mujoco", "as-shipped", steps_per_turn=5760, converge=False
    )
    assert parts["model floor"] == pytest.approx(finer.errors.worst("angle").pure, rel=0.3)
    whole = crankcheck.compare("fourbar-lecture-1", run).errors.worst("angle").pure
    assert sum(parts[part] for part in ADDED) == pytest.approx(whole, rel=digits)
    first = added.splitlines()[2]
    assert first.startswith(f"  {max(ADDED, key=parts.__getitem__)} ")
    assert "profile tuned has integrator = RK4" in output
    assert "limit that binds: CC" in output


def test_a_tuned_cell_has_no_floor_but_one_that_is_not_excluded_and_no_other_settings() -> None:
    output = flat(told(CELL))
    assert "not excluded by these steps" in output
    assert "model floor" not in output
    assert "of which discretisation" in output
    assert "profile tuned has" not in output


def test_a_known_failure_is_named_with_its_reason(monkeypatch: pytest.MonkeyPatch) -> None:
    known = KnownFailure(
        scene="fourbar-lecture-1", engine="mujoco", profile="as-shipped",
        reason="its joints give way", rules=dict.fromkeys(RULES, math.inf),
    )  # fmt: skip
    monkeypatch.setattr("reports.requests.explain.known_of", lambda *_: [known])
    output = flat(told(f"{CELL} --profile as-shipped"))
    assert "known failure: " in output
    assert "known: its joints give way" in output


@slow("seconds: a run that diverges, and the shipped file")
def test_a_cell_of_the_shipped_known_failures_says_so_with_its_reason() -> None:
    output = flat(told("explain shaper-cutting --engine pymunk"))
    assert "tuned, dt 0.002778 s: known known failure: CC101, known: its iterations" in output
    assert "ended: diverged" in output
    assert "of which" not in output
