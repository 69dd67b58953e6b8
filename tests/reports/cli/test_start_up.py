"""The command starts fast, and loads nothing that it does not need."""

from __future__ import annotations

import json
import subprocess
from functools import cache

import pytest

from tests.worlds.command import PYTHON
from tests.worlds.tiers import few, slow

HEAVY = ("mujoco", "pymunk", "pandas", "numpy", "matplotlib", "pyarrow", "openpyxl", "scipy")
SCRIPT = """
import cProfile, json, sys
counter = cProfile.Profile()
if {counted}:
    counter.enable()
from crankcheck.__main__ import main
sys.argv = ["crankcheck", *{args!r}]
try:
    main()
except SystemExit as end:
    code = end.code
counter.disable()
calls = sum(entry.callcount for entry in counter.getstats())
print(json.dumps([code, calls, sorted(name for name in {heavy!r} if name in sys.modules)]))
"""
MOST_CALLS = 800_000
"""Of functions, those of imports among them: a third of a second."""


@cache
def start(*args: str, counted: bool = True) -> tuple[int, int, list[str], str]:
    """Exit code, calls of functions, heavy packages loaded, and the output."""
    script = SCRIPT.format(args=list(args), heavy=HEAVY, counted=counted)
    done = subprocess.run([PYTHON, "-P", "-c", script], capture_output=True, text=True, check=True)
    *output, last = done.stdout.splitlines()
    code, calls, loaded = json.loads(last)
    return code or 0, calls, loaded, "\n".join(output)


@pytest.mark.parametrize(
    "line",
    few(
        ["--help", "verify --help", "solve -h", "--version"],
        ["--help"],
        "the same imports as of the others",
    ),
)
def test_help_is_shown_after_few_calls_and_loads_no_engine(line: str) -> None:
    code, calls, loaded, output = start(*line.split())
    assert code == 0
    assert loaded == []
    assert "crankcheck" in output
    assert calls < MOST_CALLS


def test_the_help_names_every_command() -> None:
    *_, output = start("--help")
    for command in ("verify", "solve", "export", "scenes", "engines", "view", "--version"):
        assert command in output


def test_the_reference_is_solved_without_an_engine() -> None:
    code, _, loaded, output = start("solve", "fourbar-lecture-1", "--at-deg", "90", counted=False)
    assert code == 0
    assert "4.6761490" in output
    assert not {"mujoco", "pymunk", "matplotlib", "scipy"} & set(loaded)


@slow("a start, for what test_refusals.py has in the process of the tests")
def test_a_users_mistake_ends_with_2_and_no_traceback_in_a_real_process() -> None:
    line = [PYTHON, "-P", "-m", "crankcheck", "verify", "fourbar-lectur-1"]
    done = subprocess.run(line, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
    assert done.stderr.count("\n") == 1
