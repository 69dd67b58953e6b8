"""The command starts fast, and loads nothing that it does not need; where it does not end by a
verdict, it ends with one line and a code that tells whose fault that is."""

import json
import os
import re
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest

from reports.cli.application import broken_package
from reports.output.console import forget_odd_sizes
from tests.worlds.command import COMMAND, PYTHON, End, ends
from tests.worlds.command_line import crank, flat, told
from tests.worlds.tiers import few, slow, slowly

ROOT = Path(__file__).parents[3]
SOLVE = "solve fourbar-lecture-1"
POSIX = pytest.mark.skipif(sys.platform == "win32", reason="a POSIX shell is needed")


def shell(command: str, **environment: str) -> tuple[int, str, str]:
    """Exit code, output and complaint of ``crankcheck`` in a shell line."""
    line = ["/bin/sh", "-c", command.replace("crankcheck", COMMAND)]
    done = subprocess.run(line, capture_output=True, env=os.environ | environment, check=False)
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

ScenesRequest.run = cut_short
"""
FILLED = (SOLVE, "--help")
"""What prints by itself, and what a package prints."""
FILLED_AS_WELL = ("export tangent", "scenes")


@pytest.fixture(scope="module")
def ended(tmp_path_factory: pytest.TempPathFactory) -> dict[str, End]:
    folder = tmp_path_factory.mktemp("ends")
    text = (ROOT / "models/scenes/kinematics/tangent.toml").read_text(encoding="utf-8")
    text = text.replace('source = "', 'source = "\\u0110\\u1ed9ng ')
    (folder / "scene.toml").write_text(text, encoding="utf-8")
    full = {line: FULL.format(line=f"crankcheck {line}") for line in FILLED}
    return ends({**full, "ascii": ASCII, "swallowed": SWALLOWED}, folder)


NO_SPACE = "standard output can not be written: No space left on device"


def check_told(end: End, fault: str) -> None:
    code, _, complaint = end
    assert complaint.count("\n") == 1
    assert re.search(fault, complaint)
    assert code == 2


@POSIX
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")
@pytest.mark.parametrize("line", FILLED)
def test_a_full_disk_behind_the_output_is_told(line: str, ended: dict[str, End]) -> None:
    check_told(ended[line], NO_SPACE)


@slow("a process more: commands that print as solve does")
@POSIX
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")
def test_so_is_it_of_other_commands(tmp_path: Path) -> None:
    full = {line: FULL.format(line=f"crankcheck {line}") for line in FILLED_AS_WELL}
    for end in ends(full, tmp_path).values():
        check_told(end, NO_SPACE)


def test_a_closed_output_and_a_variable_that_breaks_a_package_are_told() -> None:
    check_told(shell(f"crankcheck {SOLVE} >&-"), "standard output is closed")
    end = shell("crankcheck solve tangent", NUMPY_MADVISE_HUGEPAGE="foo")
    check_told(end, "numpy can not be imported here: .*foo")


@POSIX
@pytest.mark.parametrize(
    "line",
    [
        slowly(f"{SOLVE} --turns 100; X | head -n 1", reason="a second: after the first line"),
        "--help; X | true",
    ],
)
def test_a_reader_that_leaves_is_no_verdict(line: str) -> None:
    code, _, complaint = shell(f"(crankcheck {line.replace('X', 'echo $? >&2)')}")
    assert (code, complaint) == (0, "141\n")


@POSIX
def test_ascii_is_escaped_and_a_cut_import_is_no_missing_engine(ended: dict[str, End]) -> None:
    assert ended["swallowed"] == (130, "", "crankcheck: interrupted\n")
    code, output, complaint = ended["ascii"]
    assert (code, complaint) == (0, "")
    assert r"\u0110\u1ed9ng" in output


@pytest.mark.parametrize(("text", "shown"), [("x" * 450, "x" * 300), ("a\nb", "a")])
def test_a_fault_of_crankcheck_asks_to_be_reported(
    text: str, shown: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fault(*_: object) -> object:
        raise ZeroDivisionError(text)

    monkeypatch.setattr("reports.requests.export.ScenesRequest.run", fault)
    monkeypatch.setenv("CRANKCHECK_TRACEBACK", "")
    result = crank("scenes")
    assert result.exit_code == 70
    (line,) = result.stderr.splitlines()
    said = f"crankcheck: internal error: ZeroDivisionError: {shown}; please report"
    assert line.startswith(said)
    assert "--traceback" in line
    assert "Traceback" in crank("--traceback", "scenes").stderr
    monkeypatch.setenv("CRANKCHECK_TRACEBACK", "1")
    assert "Traceback" in crank("scenes").stderr


@pytest.mark.parametrize("value", ["9" * 5000, "\u00b2", "1000000000", "0", "-80", ""])
def test_an_odd_size_of_a_terminal_is_left_out(value: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", value)
    monkeypatch.setenv("LINES", "24")
    forget_odd_sizes()
    assert "COLUMNS" not in os.environ
    assert os.environ["LINES"] == "24"


def test_a_fault_in_what_a_package_is_asked_for_is_one_of_ours() -> None:
    with pytest.raises(ValueError, match="Expecting value") as raised:
        json.loads("[")
    assert broken_package(raised.value) == ""


HEAVY = (
    "mujoco", "pymunk", "pandas", "numpy", "matplotlib", "pyarrow", "openpyxl", "scipy", "flint",
)  # fmt: skip
COUNTED = """
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
    script = COUNTED.format(args=list(args), heavy=HEAVY, counted=counted)
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


def test_the_help_names_commands_and_says_what_every_exit_code_means() -> None:
    codes = ("0 all within", "1 out of", "2 bad input", "70 a fault", "130 interrupted", "141")
    said = flat(told("--help"))
    assert [part for part in ("verify", "engines", *codes) if part not in said] == []


def test_the_reference_is_solved_without_an_engine() -> None:
    code, _, loaded, output = start("solve", "fourbar-lecture-1", "--at-deg", "90", counted=False)
    assert code == 0
    assert "4.6761490" in output
    assert not {"mujoco", "pymunk", "matplotlib", "scipy", "flint"} & set(loaded)
