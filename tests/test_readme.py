"""The README is true: every command in it runs, and prints what stands below it.

A block of ``console`` starts with ``$ command``; below it stands what the command prints. A line
of ``...`` stands for any lines. Words and numbers must be the same, but for the rows of a verdict:
their numbers, which processors may move a little, must agree to 10 %.
"""

from __future__ import annotations

import math
import re
import shlex
import subprocess
from pathlib import Path

import pytest

from tests.worlds.command import COMMAND, PYTHON

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"```console\n(.*?)```", README, flags=re.DOTALL)
SCRIPTS = re.findall(r"```python\n(.*?)```", README, flags=re.DOTALL)
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def commands() -> list[tuple[str, list[str], int]]:
    """Each command with the lines that should follow, and the exit code stated by ``$ echo $?``."""
    found: list[tuple[str, list[str], int]] = []
    for block in BLOCKS:
        for part in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
            command, *lines = part.rstrip("\n").split("\n")
            if command == "echo $?":
                last = found.pop()
                found.append((last[0], last[1], int(lines[0])))
            else:
                found.append((command, lines, 0))
    return found


def same(shown: str, printed: str) -> bool:
    """The same words, and numbers that agree."""
    words, other = NUMBER.split(shown), NUMBER.split(printed)
    if [" ".join(w.split()) for w in words] != [" ".join(w.split()) for w in other]:
        return False
    tolerance = 0.1 if shown.lstrip().startswith(("ok ", "OUT ")) else 0.0
    pairs = zip(NUMBER.findall(shown), NUMBER.findall(printed), strict=True)
    return all(a == b or math.isclose(float(a), float(b), rel_tol=tolerance) for a, b in pairs)


def follows(shown: list[str], printed: list[str]) -> str:
    """Empty where ``printed`` reads as ``shown``; else the first line that does not."""
    at, free = 0, False
    for line in shown:
        if line.strip() == "...":
            free = True
            continue
        ahead = range(at, len(printed)) if free else range(at, min(at + 1, len(printed)))
        hit = next((i for i in ahead if same(line, printed[i])), None)
        if hit is None:
            near = printed[at] if at < len(printed) else "(end)"
            return f"README says\n  {line}\nthe command prints\n  {near}"
        at, free = hit + 1, False
    return ""


def test_readme_is_true_from_top_to_bottom(tmp_path: Path) -> None:
    """One after the other in one folder, as a reader would: later commands use what earlier ones
    left."""
    faults = []
    for command, shown, code in commands():
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


def words(command: str) -> list[str]:
    """The command, with the programs of this environment."""
    name, *rest = shlex.split(command)
    programs = {
        "crankcheck": COMMAND,
        "python": PYTHON,
    }
    return [programs.get(name, name), *rest]


def ran(command: list[str], folder: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, capture_output=True, text=True, cwd=folder, check=False)


def test_readme_shows_commands() -> None:
    assert len(commands()) >= 3
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
    ],
)
def test_comparison_sees_differences(shown: str, printed: str, agree: bool) -> None:
    assert same(shown, printed) is agree
