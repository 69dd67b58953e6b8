"""`crankcheck recipe forces`: the program that it shows, and what it refuses."""

from __future__ import annotations

from pathlib import Path

from tests.worlds.command_line import crank


def test_the_program_is_shown_or_written(tmp_path: Path) -> None:
    shown = crank("recipe", "forces", "--engine", "mujoco")
    assert shown.exit_code == 0
    compile(shown.stdout, "shown", "exec")
    path = tmp_path / "forces.py"
    told = crank("recipe", "forces", "--engine", "mujoco", "-o", path)
    assert told.exit_code == 0
    assert path.read_text(encoding="utf-8") == shown.stdout
