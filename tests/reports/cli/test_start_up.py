"""The command starts fast, and loads nothing that it does not need."""

from __future__ import annotations

import json
import subprocess

import pytest

from tests.worlds.command import PYTHON

HEAVY = ("mujoco", "pymunk", "pandas", "numpy", "matplotlib", "pyarrow", "openpyxl", "scipy")
SCRIPT = """
import json, sys, time
began = time.process_time()
from crankcheck.__main__ import main
sys.argv = ["crankcheck", *{args!r}]
try:
    main()
except SystemExit as end:
    code = end.code
spent = time.process_time() - began
print(json.dumps([code, spent, sorted(name for name in {heavy!r} if name in sys.modules)]))
"""


def start(*args: str) -> tuple[int, float, list[str], str]:
    """Exit code, processor time [s], heavy packages loaded, and the output."""
    script = SCRIPT.format(args=list(args), heavy=HEAVY)
    done = subprocess.run(
        [PYTHON, "-P", "-c", script], capture_output=True, text=True, check=True, timeout=60
    )
    *output, last = done.stdout.splitlines()
    code, spent, loaded = json.loads(last)
    return code or 0, spent, loaded, "\n".join(output)


@pytest.mark.parametrize("args", [["--help"], ["verify", "--help"], ["solve", "-h"], ["--version"]])
def test_help_is_shown_in_half_a_second_and_loads_no_engine(args: list[str]) -> None:
    code, spent, loaded, output = start(*args)
    assert code == 0
    assert loaded == []
    assert "crankcheck" in output
    for _ in range(2):  # a machine with much to do may take longer, once
        spent = spent if spent < 0.5 else start(*args)[1]
    assert spent < 0.5


def test_the_help_names_every_command() -> None:
    *_, output = start("--help")
    for command in ("verify", "solve", "export", "scenes", "engines", "view", "--version"):
        assert command in output


def test_the_reference_is_solved_without_an_engine() -> None:
    code, _, loaded, output = start("solve", "fourbar-lecture-1", "--at-deg", "90")
    assert code == 0
    assert "4.6761490" in output
    assert not {"mujoco", "pymunk", "matplotlib", "scipy"} & set(loaded)


def test_a_users_mistake_ends_with_2_and_no_traceback_in_a_real_process() -> None:
    done = subprocess.run(
        [PYTHON, "-P", "-m", "crankcheck", "verify", "fourbar-lectur-1"],
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
    )
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
    assert done.stderr.count("\n") == 1
