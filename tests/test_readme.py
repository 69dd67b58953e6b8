"""The README is true: every command in it runs, and prints what stands below it.

A block of ``console`` starts with ``$ command``; below it stands what the command prints
(`tests.worlds.documents`).
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.worlds.command import PYTHON
from tests.worlds.documents import blocks, commands, follows, ran, same, words

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
SCRIPTS = blocks(README, "python")


def test_readme_is_true_from_top_to_bottom(tmp_path: Path) -> None:
    """One after the other in one folder, as a reader would: later commands use what earlier ones
    left."""
    faults = []
    for command, shown, code in commands(README):
        done = ran(words(command), tmp_path)
        if done.returncode != code:
            faults.append(f"$ {command}\nexit {done.returncode}\n{done.stdout}{done.stderr}")
        printed = [line.rstrip() for line in done.stdout.splitlines()]
        if fault := follows([line.rstrip() for line in shown], printed):
            faults.append(f"$ {command}\n{fault}")
    for script in SCRIPTS:
        done = ran([PYTHON, "-c", script], tmp_path)
        if done.returncode != 0:
            faults.append(f"{script}\n{done.stderr}")
    assert not faults, "\n\n".join(faults)


def test_readme_shows_commands() -> None:
    assert len(commands(README)) >= 3
    assert len(SCRIPTS) >= 3


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
