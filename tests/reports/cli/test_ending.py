"""How the command ends when it is not by a verdict: one line and a code that tells whose fault."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from reports.cli import app
from reports.cli.broken_package import broken_package
from tests.worlds.command import COMMAND, PYTHON, script

ROOT = Path(__file__).parents[3]
SOLVE = "solve fourbar-lecture-1"
HAS_FULL = pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")
POSIX = pytest.mark.skipif(sys.platform == "win32", reason="a POSIX shell is needed")


def shell(command: str, **environment: str) -> tuple[int, str, str]:
    """Exit code, output and complaint of ``crankcheck`` in a shell line."""
    done = subprocess.run(
        command.replace("crankcheck", COMMAND),
        shell=True,
        executable="/bin/sh",
        capture_output=True,
        check=False,
        timeout=60,
        env=os.environ | environment,
    )
    return done.returncode, done.stdout.decode("utf-8"), done.stderr.decode("utf-8")


@POSIX
@HAS_FULL
@pytest.mark.parametrize("args", [SOLVE, "export tangent", "scenes", "--help"])
def test_a_full_disk_behind_the_output_is_told_in_one_line(args: str) -> None:
    code, _, complaint = shell(f"crankcheck {args} > /dev/full")
    assert complaint.count("\n") == 1
    assert "standard output can not be written: No space left on device" in complaint
    assert code == 2


@POSIX
def test_a_closed_output_is_told_in_one_line() -> None:
    code, _, complaint = shell(f"crankcheck {SOLVE} >&-")
    assert complaint.count("\n") == 1
    assert "standard output is closed" in complaint
    assert code == 2


@POSIX
def test_a_reader_that_leaves_is_no_verdict() -> None:
    code, _, complaint = shell(f"(crankcheck {SOLVE} --turns 200; echo $? >&2) | head -n 1")
    assert (code, complaint) == (0, "141\n")


@POSIX
def test_a_reader_of_the_help_that_leaves_is_no_verdict() -> None:
    code, _, complaint = shell("(crankcheck --help; echo $? >&2) | true")
    assert (code, complaint) == (0, "141\n")


SWALLOWED = """
import signal, sys
from models.errors import EngineError
from reports import cli
from reports.cli.commands import listing

def cut_short(*_):
    try:
        signal.raise_signal(signal.SIGINT)
    except BaseException:
        raise EngineError("engine mujoco: not installed")

listing.scenes = cut_short
sys.argv = ["crankcheck", "scenes"]
cli.main()
"""


@POSIX
def test_an_import_that_ctrl_c_cut_short_is_no_missing_engine() -> None:
    done = subprocess.run(
        [PYTHON, "-P", "-c", script(SWALLOWED)],
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
    )
    assert (done.returncode, done.stderr) == (130, "crankcheck: interrupted\n")


@POSIX
def test_a_terminal_of_ascii_shows_an_escape(tmp_path: Path) -> None:
    scene = tmp_path / "scene.toml"
    text = (ROOT / "models/scenes/kinematics/tangent.toml").read_text(encoding="utf-8")
    scene.write_text(text.replace('source = "', 'source = "\\u0110\\u1ed9ng '), encoding="utf-8")
    code, output, complaint = shell(f"crankcheck solve {scene}", PYTHONIOENCODING="ascii")
    assert (code, complaint) == (0, "")
    assert r"\u0110\u1ed9ng" in output


@pytest.fixture
def broken(monkeypatch: pytest.MonkeyPatch) -> None:
    """A command with a fault of its own."""

    def fault(*_: object) -> object:
        raise ZeroDivisionError("division\nby zero")

    monkeypatch.setattr("reports.cli.commands.listing.scenes", fault)
    monkeypatch.setenv("CRANKCHECK_TRACEBACK", "")


def crank(*args: str) -> Result:
    return CliRunner().invoke(app, list(args), catch_exceptions=False)


@pytest.mark.usefixtures("broken")
def test_a_fault_of_crankcheck_is_no_verdict_and_asks_to_be_reported() -> None:
    result = crank("scenes")
    assert result.exit_code == 70
    (line,) = result.stderr.splitlines()
    assert line.startswith("crankcheck: internal error: ZeroDivisionError: division; please report")
    assert "--traceback" in line


@pytest.mark.usefixtures("broken")
def test_the_traceback_is_shown_where_it_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    assert "Traceback" in crank("--traceback", "scenes").stderr
    monkeypatch.setenv("CRANKCHECK_TRACEBACK", "1")
    assert "Traceback" in crank("scenes").stderr


def test_the_help_says_what_every_exit_code_means() -> None:
    text = " ".join(crank("--help").output.replace("│", " ").split())
    for part in ("0 all within", "1 out of", "2 bad input", "70 a fault", "130 interrupted", "141"):
        assert part in text


@POSIX
@pytest.mark.parametrize(
    ("args", "variable", "value", "words"),
    [
        ("verify tangent", "MUJOCO_GL", "foo", "mujoco can not be imported here: .*MUJOCO_GL: foo"),
        (
            "view tangent -o OUT",
            "MPLBACKEND",
            "foo",
            "matplotlib can not be imported here: .*foo",
        ),
        ("solve tangent", "NUMPY_MADVISE_HUGEPAGE", "foo", "numpy can not be imported here: .*foo"),
        ("scenes", "COLUMNS", "9" * 5000, ""),
        ("scenes", "COLUMNS", "\u00b2", ""),
        ("scenes", "COLUMNS", "1000000000", ""),
    ],
)
def test_a_variable_that_makes_no_sense_is_no_fault_of_crankcheck(
    args: str, variable: str, value: str, words: str, tmp_path: Path
) -> None:
    line = f"crankcheck {args.replace('OUT', str(tmp_path / 'out.png'))}"
    code, _, complaint = shell(line, **{variable: value})
    assert code == (2 if words else 0)
    assert complaint.count("\n") == bool(words)
    assert re.search(words, complaint)


def test_a_fault_in_what_a_package_is_asked_for_is_one_of_ours() -> None:
    with pytest.raises(ValueError, match="Expecting value") as raised:
        json.loads("[")
    assert broken_package(raised.value) == ""
