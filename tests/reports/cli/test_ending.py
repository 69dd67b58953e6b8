"""How the command ends when it is not by a verdict: one line and a code that tells whose fault."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from reports.cli.broken_package import broken_package
from reports.output.console import forget_odd_sizes
from tests.worlds.command import COMMAND
from tests.worlds.command_line import crank, flat
from tests.worlds.forks import End, ends
from tests.worlds.tiers import slowly

ROOT = Path(__file__).parents[3]
SOLVE = "solve fourbar-lecture-1"
SECOND = "a start of a process, for what goes through the same lines"
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
        env=os.environ | environment,
    )
    return done.returncode, done.stdout.decode("utf-8"), done.stderr.decode("utf-8")


FULL = 'os.dup2(os.open("/dev/full", os.O_WRONLY), 1); sys.argv = {line!r}.split()'
ASCII = """
os.environ["COLUMNS"] = "9" * 5000  # a size of the terminal that is none
sys.stdout.reconfigure(encoding="ascii")
sys.argv = "crankcheck solve scene.toml".split()
"""
SWALLOWED = """
def cut_short(*_):
    try:
        signal.raise_signal(signal.SIGINT)
    except BaseException:
        raise EngineError("engine mujoco: not installed")

listing.scenes = cut_short
"""
FILLED = (SOLVE, "export tangent", "scenes", "--help")


@pytest.fixture(scope="module")
def ended(tmp_path_factory: pytest.TempPathFactory) -> dict[str, End]:
    """Ends of the command, by name."""
    folder = tmp_path_factory.mktemp("ends")
    text = (ROOT / "models/scenes/kinematics/tangent.toml").read_text(encoding="utf-8")
    text = text.replace('source = "', 'source = "\\u0110\\u1ed9ng ')
    (folder / "scene.toml").write_text(text, encoding="utf-8")
    full = {line: FULL.format(line=f"crankcheck {line}") for line in FILLED}
    return ends({**full, "ascii": ASCII, "swallowed": SWALLOWED}, folder)


@POSIX
@HAS_FULL
@pytest.mark.parametrize("line", FILLED)
def test_a_full_disk_behind_the_output_is_told_in_one_line(
    line: str, ended: dict[str, End]
) -> None:
    code, _, complaint = ended[line]
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
    code, _, complaint = shell(f"(crankcheck {SOLVE} --turns 100; echo $? >&2) | head -n 1")
    assert (code, complaint) == (0, "141\n")


@POSIX
def test_a_reader_of_the_help_that_leaves_is_no_verdict() -> None:
    code, _, complaint = shell("(crankcheck --help; echo $? >&2) | true")
    assert (code, complaint) == (0, "141\n")


@POSIX
def test_an_import_that_ctrl_c_cut_short_is_no_missing_engine(ended: dict[str, End]) -> None:
    assert ended["swallowed"] == (130, "", "crankcheck: interrupted\n")


@POSIX
def test_a_terminal_of_ascii_shows_an_escape(ended: dict[str, End]) -> None:
    code, output, complaint = ended["ascii"]
    assert (code, complaint) == (0, "")
    assert r"\u0110\u1ed9ng" in output


LONG = "division " * 50


@pytest.fixture
def broken(monkeypatch: pytest.MonkeyPatch) -> None:
    """A command with a fault of its own."""

    def fault(*_: object) -> object:
        raise ZeroDivisionError(f"{LONG}\nby zero")

    monkeypatch.setattr("reports.cli.commands.listing.scenes", fault)
    monkeypatch.setenv("CRANKCHECK_TRACEBACK", "")


@pytest.mark.usefixtures("broken")
def test_a_fault_of_crankcheck_is_no_verdict_and_asks_to_be_reported() -> None:
    result = crank("scenes")
    assert result.exit_code == 70
    (line,) = result.stderr.splitlines()
    told = f"crankcheck: internal error: ZeroDivisionError: {LONG[:300]}; please report"
    assert line.startswith(told)
    assert "--traceback" in line


@pytest.mark.usefixtures("broken")
def test_the_traceback_is_shown_where_it_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    assert "Traceback" in crank("--traceback", "scenes").stderr
    monkeypatch.setenv("CRANKCHECK_TRACEBACK", "1")
    assert "Traceback" in crank("scenes").stderr


def test_the_help_says_what_every_exit_code_means() -> None:
    text = flat(crank("--help").output)
    for part in ("0 all within", "1 out of", "2 bad input", "70 a fault", "130 interrupted", "141"):
        assert part in text


@POSIX
@pytest.mark.parametrize(
    ("args", "variable", "package"),
    [
        ("solve tangent", "NUMPY_MADVISE_HUGEPAGE", "numpy"),
        slowly("verify tangent", "MUJOCO_GL", "mujoco", reason=SECOND),
        slowly("view tangent -o OUT", "MPLBACKEND", "matplotlib", reason=SECOND),
    ],
)
def test_a_variable_of_a_package_is_no_fault_of_crankcheck(
    args: str, variable: str, package: str, tmp_path: Path
) -> None:
    line = f"crankcheck {args.replace('OUT', str(tmp_path / 'out.png'))}"
    code, _, complaint = shell(line, **{variable: "foo"})
    assert code == 2
    assert complaint.count("\n") == 1
    assert re.search(f"{package} can not be imported here: .*foo", complaint)


ODD_SIZES = ["9" * 5000, "\u00b2", "1000000000", "0", "-80", ""]


@pytest.mark.parametrize("value", ODD_SIZES)
def test_a_size_of_the_terminal_that_is_none_is_left_out(
    value: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", value)
    monkeypatch.setenv("LINES", "24")
    forget_odd_sizes()
    assert "COLUMNS" not in os.environ
    assert os.environ["LINES"] == "24"


@POSIX
@pytest.mark.parametrize("value", [slowly(value, reason=SECOND) for value in ODD_SIZES[:3]])
def test_an_odd_size_of_the_terminal_is_no_fault_of_crankcheck(value: str) -> None:
    code, _, complaint = shell("crankcheck scenes", COLUMNS=value)
    assert (code, complaint) == (0, "")


def test_a_fault_in_what_a_package_is_asked_for_is_one_of_ours() -> None:
    with pytest.raises(ValueError, match="Expecting value") as raised:
        json.loads("[")
    assert broken_package(raised.value) == ""
