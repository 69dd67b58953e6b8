"""`crankcheck explain`: rules, clauses, and a cell whose parts are found a second way."""

import json
from pathlib import Path

import numpy as np
import pytest

import crankcheck
from reports.contract.clauses import CLAUSES
from reports.judge.rules import RULES
from reports.requests.explain import HELPS
from tests.worlds.command_line import crank, flat, refused, told

CELL = "explain fourbar-lecture-1 --engine mujoco --steps-per-turn 360"


@pytest.mark.parametrize("name", [*RULES, "cc110", "EC52"])
def test_a_rule_or_a_clause_says_why_and_what_helps(name: str) -> None:
    output = flat(told(f"explain {name}"))
    entry = {**RULES, **CLAUSES}[name.upper()]
    assert f"{entry.id} {entry.title}" in output
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


def test_the_parts_of_a_cell_are_those_of_runs_and_solutions(tmp_path: Path) -> None:
    """As shipped: the drive by solving at the logged angles, the phase by half a step of the
    reference's own motion, the floor by a run at a sixteenth of the step."""
    path = tmp_path / "a.json"
    output = flat(told(f"{CELL} --profile as-shipped --json", path))
    answer = json.loads(path.read_text())
    parts = answer["parts"]
    assert parts.keys() == HELPS.keys()
    options = {"steps_per_turn": 360, "turns": 2}
    run = crankcheck.run("fourbar-lecture-1", "mujoco", "as-shipped", **options)
    crank_rad = run.motion.links["crank"].theta
    lag_s = (run.velocity_time_s - run.motion.time_s)[0]
    reference = crankcheck.solve("fourbar-lecture-1", time_s=run.motion.time_s)
    off = np.abs(np.unwrap(crank_rad) - reference.links["crank"].theta).max()
    assert parts["drive"] < 10.0 * off + 1e-12
    gaps = max(np.abs(gap).max() for gap in run.gaps.values())
    assert parts["closure"] == pytest.approx(gaps / 0.25, rel=1e-9)  # the coupler is the longest
    moved = [
        np.abs(np.diff(link.omega)).max() / reference.links["crank"].omega[0]
        for link in reference.links.values()
    ]
    whole_steps = abs(lag_s) / run.dt_s
    assert parts["sampling phase"] == pytest.approx(whole_steps * max(moved), rel=0.3)
    finer = crankcheck.check(
        "fourbar-lecture-1", "mujoco", "as-shipped", steps_per_turn=5760, converge=False
    )
    assert parts["model floor"] == pytest.approx(finer.errors.worst("angle").pure, rel=0.3)
    assert parts["model floor"] + parts["discretisation"] == pytest.approx(
        crankcheck.compare("fourbar-lecture-1", run).errors.worst("angle").pure
    )
    largest = max(("drive", "model floor", "discretisation"), key=parts.get)
    assert f"{largest} is the largest part of the error: {HELPS[largest]}" in output
    assert "profile tuned has integrator = RK4" in output
    assert answer["limit that binds"].startswith("CC")


def test_a_tuned_cell_has_no_floor_but_one_that_is_not_excluded() -> None:
    output = flat(told(CELL))
    assert "not excluded by these steps" in output
    assert "model floor" not in output
    assert "discretisation is the largest part of the error: a shorter step" in output
