"""`crankcheck recipe forces`: the program that it shows, and what it refuses."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.worlds.command_line import crank


def test_the_program_is_shown_or_written(tmp_path: Path) -> None:
    shown = crank("recipe", "forces", "--engine", "mujoco")
    assert shown.exit_code == 0
    compile(shown.stdout, "shown", "exec")
    path = tmp_path / "forces.py"
    told = crank("recipe", "forces", "--engine", "mujoco", "-o", path)
    assert told.exit_code == 0
    assert path.read_text(encoding="utf-8") == shown.stdout


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--engine", "mujoca"], "mujoca"),
        (["--engine", "mujoco", "--scene", "nowhere"], "nowhere"),
        (["--engine", "mujoco", "--scene", "tangent"], "takes? a scene of constant speed|driver"),
        (["--engine", "mujoco", "--profile", "best"], "best"),
        (["--engine", "mujoco", "--steps-per-turn", "0"], "found 0; give a number above 0"),
        (["--engine", "mujoco", "--steps-per-turn", "4"], "at least 8 are needed"),
        (["--engine", "mujoco", "--steps-per-turn", "1e300"], "1e\\+300.*300000 at\\s+most"),
        (["--engine", "mujoco", "--steps-per-turn", "inf"], "found inf"),
        (["--engine", "mujoco", "-o", "forces.txt"], "use .py"),
        ([], "Missing option '--engine'"),
    ],
)
def test_what_it_cannot_show_is_one_message_and_exit_2(
    options: list[str], message: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NO_COLOR", "1")
    done = crank("recipe", "forces", *options)
    assert done.exit_code == 2
    assert re.search(message, done.stderr + done.stdout), done.stderr
    assert "Traceback" not in done.stderr
