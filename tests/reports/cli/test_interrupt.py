"""Ctrl-C and SIGTERM in a real run with worker processes, at any time and several times; and Ctrl-C
from the first line of ours that Python runs to the last."""

import sys
from pathlib import Path

import pytest

from tests.worlds.command import COMMAND, PYTHON, ends, script
from tests.worlds.programs import Start
from tests.worlds.tiers import few, slow, slowly

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals to a group are POSIX")

SCRIPT = """
import os, signal, sys, threading, time
from crankcheck.__main__ import main

event, name, number = {moment!r}
left = [None] * number

def again():
    for _ in range({times}):
        {kill}
        time.sleep(0.1)

def hear(what, arguments):
    if what == event and name in str(arguments[0]) and left:
        left.pop()
        if not left:
            threading.Thread(target=again, daemon=True).start()

if __name__ == "__main__":
    sys.addaudithook(hear)
    sys.argv = ["crankcheck", *{arguments!r}]
    main()
"""
GROUP = "os.killpg(os.getpgid(0), signal.SIGINT)"
ALONE = "os.kill(os.getpid(), signal.SIGTERM)"
Moment = tuple[str, str, int]
"""An event that Python tells of, part of its first argument, and the how manieth it is."""
IMPORTS: Moment = ("import", "numpy", 1)
FIRST_STARTS: Moment = ("subprocess.Popen", "python", 1)
SECOND_STARTS: Moment = ("subprocess.Popen", "python", 2)
BRIEF = ("verify", "fourbar-lecture-1", "-o", "out")
"""Work that comes to its end."""
DEAF = ("sh", "-c", 'trap "" INT; exec "$@"', "sh")
"""Starts a program that ignores Ctrl-C, as `nohup` and a script's background do."""


def ended(
    start: Start, folder: Path, kill: str, moment: Moment, times: int, *, deaf: bool = False
) -> tuple[int, str, str]:
    """Exit code, output and complaint of a run that is told to end at a moment, so many times."""
    arguments = BRIEF if deaf else LONG
    code = script(SCRIPT.format(kill=kill, moment=moment, times=times, arguments=arguments))
    (folder / "run.py").write_text(code, encoding="utf-8")
    running = start(*(DEAF if deaf else ()), PYTHON, "-P", folder / "run.py", cwd=folder)
    # The pipes end when the last process that holds them does: no worker outlives the command.
    output, complaint = running.communicate()
    return running.returncode, output, complaint


FIRST_ANSWER: Moment = ("pickle.find_class", "reports.judge.cell", 1)
LONG = ("verify", "--turns", "4", "--jobs", "2", "-o", "out")
"""Some ten seconds of work, which ends in its first moments."""


ENDED = {"interrupted": (GROUP, 4, 130), "terminated": (ALONE, 2, 143)}
"""How it is told to end, how many times, and the exit code."""


@pytest.mark.parametrize(
    "case",
    few(
        [
            *(("interrupted", at) for at in (IMPORTS, FIRST_STARTS, SECOND_STARTS, FIRST_ANSWER)),
            *(("terminated", at) for at in (FIRST_STARTS, FIRST_ANSWER)),
        ],
        [("interrupted", SECOND_STARTS)],
        "at one moment of three that workers have; an import and SIGTERM itself are below",
    ),
)
def test_a_signal_ends_the_workers_with_one_line_and_nothing_written(
    programs: Start, tmp_path: Path, case: tuple[str, Moment]
) -> None:
    kill, times, exit_code = ENDED[case[0]]
    code, output, complaint = ended(programs, tmp_path, kill, case[1], times)
    assert complaint.splitlines() == [f"crankcheck: {case[0]}"]
    assert (code, output) == (exit_code, "")
    assert not (tmp_path / "out").exists()


@slow("a second with a shell that ignores it, as `nohup` does; a process that does is below")
def test_ctrl_c_stays_ignored_where_the_parent_ignores_it(programs: Start, tmp_path: Path) -> None:
    code, _, complaint = ended(programs, tmp_path, GROUP, IMPORTS, times=2, deaf=True)
    assert (code, complaint) == (0, "")
    assert (tmp_path / "out" / "verify.csv").exists()


START = """
import os, signal, sys
module, number, program, *arguments = sys.argv[1:]
left = [None] * int(number)
begun = []

def ours(name):
    return name.removeprefix("crankcheck.")

def hear(event, details):
    if event == "import" and details[0] == "crankcheck":
        begun.append(1)
    elif event == "import" and begun and left and module in (ours(details[0]), "*"):
        left.pop()
        if not left:
            os.kill(os.getpid(), signal.SIGINT)

sys.addaudithook(hear)
if program == "-m":
    import runpy
    sys.argv, sys.orig_argv[1:] = ["-m", *arguments], ["-m", "crankcheck", *arguments]
    runpy.run_module("crankcheck", run_name="__main__", alter_sys=True)
else:
    sys.argv = [program, *arguments]
    exec(compile(open(program).read(), program, "exec"), {"__name__": "__main__"})
"""
"""The command, as `python -m` and the program of the wheel start it, with Ctrl-C at an import."""
SOLVE = ("solve", "fourbar-lecture-1", "--at-deg", "90")


def started(module: str, number: int, program: str, start: Start) -> tuple[int, str]:
    """Exit code and complaint where Ctrl-C comes at the import of a module, or at the how manieth
    of all."""
    running = start(PYTHON, "-P", "-c", script(START), module, number, program, *SOLVE)
    _, complaint = running.communicate()
    return running.returncode, complaint


@pytest.mark.parametrize(
    ("module", "program"),
    [
        *((each, COMMAND) for each in ("reports.cli", "reports.cli.application")),
        slowly("numpy", COMMAND, reason="half a second: its workers are interrupted above"),
        ("reports.cli", "-m"),
    ],
    ids=["before the command line", "in it", "after it", "as a module"],
)
def test_ctrl_c_in_an_import_ends_in_one_line(module: str, program: str, programs: Start) -> None:
    assert started(module, 1, program, programs) == (130, "crankcheck: interrupted\n")


@slow("a hundred starts: no import is left out but 16 of 17")
@pytest.mark.parametrize("program", [COMMAND, "-m"], ids=["crankcheck", "-m"])
def test_ctrl_c_at_any_import_ends_in_one_line(program: str, programs: Start) -> None:
    for number in range(1, 10_000, 17):
        code, complaint = started("*", number, program, programs)
        if code == 0:
            break
        assert (code, complaint) == (130, "crankcheck: interrupted\n"), number
    assert number > 500
    assert complaint == ""


def test_the_command_hears_ctrl_c_in_one_line_from_its_first_import_on(programs: Start) -> None:
    code = "import crankcheck, signal; signal.raise_signal(signal.SIGINT)"
    named = f"import sys; sys.argv = ['bin/crankcheck']; {code}"
    command, plain = (programs(PYTHON, "-P", "-c", each) for each in (named, code))
    assert command.communicate()[1] == "crankcheck: interrupted\n"
    assert "KeyboardInterrupt" in plain.communicate()[1]  # a script that imports it, as ever


ENDS = {
    "lost": """
class Dies:
    __del__ = strike

def lost(*_):
    Dies()
    time.sleep(3600.0)

ScenesRequest.run = lost
""",
    "swallowed": """
def swallowed(*_):
    signals.PATIENCE_S = 0.1
    try:
        strike()
    except BaseException:
        time.sleep(3600.0)

ScenesRequest.run = swallowed
""",
    "slow": """
signals.PATIENCE_S = 0.1
atexit.register(time.sleep, 3600.0)
ScenesRequest.run = strike
""",
    "terminated": "ScenesRequest.run = lambda *_: os.kill(os.getpid(), signal.SIGTERM)",
    "ignored": "signal.signal(signal.SIGINT, signal.SIG_IGN); ScenesRequest.run = strike",
    "told": "ScenesRequest.run = lambda *_: setattr(sys.stdout, 'flush', strike)",
    "finished": "ScenesRequest.run = lambda *_: [atexit.register(strike), 0][1]",
}


def test_a_signal_is_neither_lost_nor_told_with_a_traceback(tmp_path: Path) -> None:
    told = (130, "", "crankcheck: interrupted\n")
    assert ends(ENDS, tmp_path) == {
        **dict.fromkeys(("lost", "swallowed", "slow", "told"), told),
        **dict.fromkeys(("ignored", "finished"), (0, "", "")),
        "terminated": (143, "", "crankcheck: terminated\n"),
    }
