"""The README is true: every command in it runs, and prints what stands below it.

A block of ``console`` starts with ``$ command``; below it stands what the command prints
(`tests.worlds.pages`).
"""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import pytest

from reports.selftest.trial import FAULTS
from reports.stability.grading import CATALOGUE
from tests.worlds.command import PYTHON
from tests.worlds.pages import blocks, commands, follows, ran, same, threads, words
from tests.worlds.tiers import slowly

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
SCRIPTS = blocks(README, "python")
THREADS = threads([command for command, _, _ in commands(README)], SCRIPTS)
LONG: dict[str, str] = {
    "crankcheck run fourbar-lecture-1 --engine mujoco --turns 1 -o log.csv": "15 s: a sweep, shown "
    "in every way; each is tested by its room",
    "crankcheck selftest": "26 s: every fault is planted by tests/reports/selftest",
    "crankcheck stability grashof-excess n-fourbar": "10 s: every case runs in tests/reports",
    "crankcheck advise --dt 1/60 --speed 10 --target 1e-3": "6 s: tests/reports/advise",
    "crankcheck verify --free fourbar-pulse --profile tuned": "3 s: tests/reports/cli",
    "crankcheck solve shaper-cutting --forces --figures figs": "2 s: tests/reports/figures",
}
"""Commands that take their time, and where else what they do is tested."""


def _thread(steps: list[str]) -> object:
    """Commands and scripts that use what earlier ones of them leave."""
    name = re.sub(r"\s+", " ", steps[0])[:60]
    reason = LONG.get(steps[0])
    return slowly(steps, reason=reason, id=name) if reason else pytest.param(steps, id=name)


@pytest.mark.parametrize("steps", [_thread(steps) for steps in THREADS])
def test_readme_is_true(steps: list[str], tmp_path: Path) -> None:
    """One after the other in one folder, as a reader would: later commands use what earlier ones
    left. What uses nothing of the others is tried by itself, beside them."""
    shown = {command: (lines, code) for command, lines, code in commands(README)}
    faults = []
    for step in steps:
        if step in SCRIPTS:
            done = ran([PYTHON, "-c", step], tmp_path)
            if done.returncode != 0:
                faults.append(f"{step}\n{done.stderr}")
            continue
        lines, code = shown[step]
        done = ran(words(step), tmp_path)
        if done.returncode != code:
            faults.append(f"$ {step}\nexit {done.returncode}\n{done.stdout}{done.stderr}")
        printed = [line.rstrip() for line in done.stdout.splitlines()]
        if fault := follows([line.rstrip() for line in lines], printed):
            faults.append(f"$ {step}\n{fault}")
    assert not faults, "\n\n".join(faults)


def test_every_command_of_the_readme_is_tried_once() -> None:
    tried = sorted(step for steps in THREADS for step in steps)
    assert tried == sorted([*(command for command, _, _ in commands(README)), *SCRIPTS])
    assert len(set(tried)) == len(tried)
    assert min(len(commands(README)), len(SCRIPTS)) >= 3
    assert not set(LONG) - {steps[0] for steps in THREADS}


def test_the_readme_counts_all_faults_that_are_planted_and_hard_cases_that_run_unnamed() -> None:
    of = Counter(fault.kind for fault in FAULTS.values())
    motions = of["motion"]
    driven = sum(case.way == "driven" for case in CATALOGUE.values())
    counts = (
        f"plants {motions} faults",
        f" {motions} of {motions} faults caught by the named rule ",
        f"plants {of['forces']} faults of force",
        f"plants {of['free']} faults of dynamics",
        f"`selftest --elastic` plants {of['elastic']} faults",
        f"in them, and {of['beam']} in beams",
        f"The whole catalogue, {driven} families",
    )
    assert [words for words in counts if words not in " ".join(README.split())] == []


def test_what_uses_a_file_comes_after_what_writes_it() -> None:
    told = ["run a -o log.csv", "solve", "judge a log.csv", "sweep b -o out", "diff out out"]
    scripts = ["read('log.csv')", "read('out/cells')", "print('about')"]
    assert threads(told, scripts) == [
        ["run a -o log.csv", "judge a log.csv", "read('log.csv')"],
        ["solve"],
        ["sweep b -o out", "diff out out", "read('out/cells')"],
        ["print('about')"],
    ]


def test_the_two_commands_stand_in_the_readme_and_in_the_makefile() -> None:
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    for target in ("verify", "test"):
        assert f"make {target}" in README
        assert re.search(rf"^{target}:", makefile, flags=re.MULTILINE)


@pytest.mark.parametrize(
    ("shown", "printed", "agree"),
    [
        ("rocker 4.676 rad", "rocker  4.676 rad", True),
        ("rocker 4.676 rad", "rocker 4.677 rad", False),
        ("ok rocker 4.676", "ok  rocker 4.700", True),
        ("ok rocker 4.676", "ok  rocker 5.700", False),
        ("rocker 1", "coupler 1", False),
        ("rocker ... rad", "rocker 4.677 rad", True),
        ("rocker ... rad", "rocker 4.677 deg", False),
    ],
)
def test_comparison_sees_differences(shown: str, printed: str, agree: bool) -> None:
    assert same(shown, printed) is agree
