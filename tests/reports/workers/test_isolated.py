"""Processes apart: what they may take, what ends them, and what is told of that; many at a time;
one thread for linear algebra in each, unless the user says how many; and other programs."""

import os
import signal
import subprocess
import sys
import threading
import time
from contextlib import closing
from pathlib import Path
from typing import Any, ClassVar

import psutil
import pytest

from models.errors import CrankcheckError, SceneError
from reports.workers import CHOICES, THREADS, one_thread
from reports.workers import isolated as isolation
from reports.workers.isolated import FEW, Isolated, Limits, Lost, as_they_end, run_all
from reports.workers.signals import Stopped, run_child
from tests.worlds import jobs
from tests.worlds.programs import ROOT, until

LIMIT_S = 900.0
"""That of a job, which no job here takes."""


def test_a_child_that_keeps_memory_is_replaced() -> None:
    with closing(Isolated[int](Limits(LIMIT_S, 0.4))) as isolated:
        pids = {isolated.call(jobs.hold, 120_000_000) for _ in range(3)}
    assert not any(isinstance(pid, Lost) for pid in pids)
    assert len(pids) > 1


def test_the_time_limit_is_for_each_job(monkeypatch: pytest.MonkeyPatch) -> None:
    with closing(Isolated[None](Limits(0.3))) as isolated:
        assert isolated.call(time.sleep, 3600.0) == Lost("timeout", "no end within 0.3 s")
        monkeypatch.setattr(isolation.threading, "Timer", Noted)
        isolated.limits = Limits(LIMIT_S)
        for count in (1, 2):
            assert isolated.call(time.sleep, 0.0) is None
            assert [timer.interval for timer in Noted.made].count(LIMIT_S) == count
            assert all(timer.finished.is_set() for timer in Noted.made)


def test_the_time_of_compiling_is_no_part_of_a_jobs() -> None:
    with closing(Isolated[str](Limits(0.5))) as isolated:
        assert isolated.call(jobs.compile_long, 0.7, 0.0) == "compiled"
        late = isolated.call(jobs.compile_long, 0.1, 3600.0)
    assert late == Lost("timeout", "no end within 0.5 s")


class Noted(threading.Timer):
    """A timer that can be looked at."""

    made: ClassVar[list[threading.Timer]] = []

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        Noted.made.append(self)


class LastMoment(threading.Timer):
    """A timer that goes off when it is stopped, a little late, if it is that of a job."""

    def start(self) -> None:
        if self.interval != LIMIT_S:
            super().start()

    def cancel(self) -> None:
        if self.interval == LIMIT_S:
            self.interval = 0.1
            super().start()
        else:
            super().cancel()


def test_a_limit_that_ends_with_its_job_ends_no_other(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(isolation.threading, "Timer", LastMoment)
    with closing(Isolated[int](Limits(LIMIT_S))) as isolated:
        pids = [isolated.call(os.getpid) for _ in range(2)]
    assert not any(isinstance(pid, Lost) for pid in pids)
    assert len(set(pids)) == 2


def test_imports_are_no_memory_of_a_job(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = "held = bytearray(300_000_000)\ndef size():\n    return len(held)\n"
    (tmp_path / "large.py").write_text(text)
    monkeypatch.syspath_prepend(tmp_path)
    from large import size  # type: ignore[import-not-found]  # made just now

    with closing(Isolated[int](Limits(LIMIT_S, 0.2))) as isolated:
        assert isolated.call(size) == 300_000_000
        assert "out of memory" in str(isolated.call(bytearray, 300_000_000))


def test_what_was_raised_comes_with_the_place_where_it_was() -> None:
    with closing(Isolated[object](Limits(LIMIT_S))) as isolated:
        lost = isolated.call(jobs.fail)
        refused = isolated.call(jobs.refuse_scene, "scene.toml", ["one", "two"])
        odd, strange = isolated.call(jobs.be_odd), isolated.call(jobs.be_strange)
    assert isinstance(lost.error, ZeroDivisionError)
    assert "in fail" in lost.error.__notes__[0]
    assert isinstance(refused.error, SceneError)
    assert refused.error.faults == ("one", "two")
    assert odd == Lost("crashed", "OddError: 1 and 2")
    assert strange == Lost("crashed", "StrangeError: of a module that is there alone")
    assert odd.error is strange.error is None, "it cannot travel"
    (unused := Isolated[None](Limits())).close()
    for closed in (isolated, unused):
        assert closed.call(time.sleep, 0.0) == Lost("crashed", "the sweep was ended")


def test_a_child_that_does_not_start_in_time_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    with closing(Isolated[int](Limits())) as isolated:
        with monkeypatch.context() as patch:
            patch.setattr(isolation.threading, "Timer", AtOnce)
            assert isolated.call(os.getpid) == Lost("timeout", "no start within 60 s")
        assert isinstance(isolated.call(os.getpid), int)


class AtOnce(threading.Timer):
    """A timer that goes off where it is started."""

    def start(self) -> None:
        self.function()

    def join(self, timeout: float | None = None) -> None:
        """No thread was started."""


MANY = [*range(FEW + 2)]
MUCH = Limits(3600.0)


def lost(number: int, how: Lost) -> str:
    return f"{number}: {how.reason}"


def test_results_come_in_order_and_what_is_lost_or_takes_too_long_has_one_too() -> None:
    heard: list[str] = []
    results = run_all(jobs.unlucky, MANY, 2, MUCH, lost, heard.append)
    assert results == ["0", "1", "2: the engine ended its process (exit code 3)", "3", "4", "5"]
    assert sorted(heard) == sorted(results)
    wanted = ["3600: no end within 0.2 s"] * 2
    assert run_all(jobs.sleepy, [3600] * 2, 2, Limits(0.2), lost, apart=True) == wanted


def test_few_are_done_here_or_apart_where_they_must_be_and_what_one_raises_is_raised() -> None:
    here = str(os.getpid())
    assert run_all(jobs.where, MANY[:FEW], 2, MUCH, lost) == [here] * FEW
    assert run_all(jobs.where, MANY, 1, MUCH, lost) == [here] * len(MANY)
    assert here not in run_all(jobs.where, MANY[: FEW + 1], 2, MUCH, lost)
    results = run_all(jobs.unlucky, [1, 2], 1, MUCH, lost, apart=True)
    assert results == ["1", "2: the engine ended its process (exit code 3)"]
    with pytest.raises(CrankcheckError, match="no 3"):
        run_all(jobs.refuse, MANY, 2, MUCH, lost)


def test_at_the_end_all_children_are_ended_in_the_middle_of_their_work() -> None:
    def drive(child: Isolated[None], seconds: float) -> object:
        return child.call(time.sleep, seconds)

    others = set(psutil.Process().children())  # a browser that other tests have opened
    with closing(as_they_end(drive, [0.0, 600.0, 600.0], 2, MUCH)) as ends:
        assert next(ends) == (0, None)
        until(lambda: len({*psutil.Process().children()} - others) == 2)
    assert {*psutil.Process().children()} <= others
    assert list(as_they_end(drive, [], 0, MUCH)) == []  # nothing to do


def test_a_worker_has_one_thread_unless_the_user_says_more(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in CHOICES:
        monkeypatch.delenv(name, raising=False)
    for threads in ("1", "2"):
        with closing(Isolated[str | None](Limits(LIMIT_S))) as isolated:
            assert isolated.call(os.getenv, THREADS) == threads
        assert THREADS not in os.environ or threads == "2"  # this process is the user's own
        monkeypatch.setenv(THREADS, "2")
    for name in CHOICES:
        one_thread(variables := {name: "3"})
        assert variables == {name: "3"}


def test_the_command_asks_before_numpy_is_imported() -> None:
    program = (
        "import os, sys, crankcheck.__main__ as command, reports.workers as own\n"
        "def seen(variables):\n"
        "    print('numpy' in sys.modules, variables is os.environ)\n"
        "own.one_thread = seen\n"
        "sys.argv = ['crankcheck', '--version']\n"
        "command.main()\n"
    )
    command, pipes = [sys.executable, "-c", program], {"capture_output": True, "text": True}
    done = subprocess.run(command, cwd=ROOT, check=False, **pipes)
    assert done.stdout.splitlines()[0] == "False True", done.stderr


@pytest.fixture(autouse=True)
def importable(monkeypatch: pytest.MonkeyPatch) -> None:
    """The child imports the functions of the tests."""
    monkeypatch.syspath_prepend(ROOT)
    monkeypatch.setenv("PYTHONPATH", str(ROOT))


CHILD = """
import subprocess, sys
from pathlib import Path
from reports.workers.signals import leave_to_parent
if sys.argv[2] == "hears":
    leave_to_parent()
own = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(3600.0)"])
Path(sys.argv[1]).write_text(str(own.pid))
own.wait()
"""


@pytest.mark.skipif(sys.platform == "win32", reason="signals to a group are POSIX")
@pytest.mark.parametrize(
    ("patience_s", "hears", "how"),
    [(600.0, "hears", signal.SIGTERM), (0.01, "is deaf", signal.SIGKILL)],
)
def test_a_signal_ends_it_with_all_that_it_started(
    patience_s: float, hears: str, how: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A program that is told to end may take its time to do so, which here it does not need."""
    sign = tmp_path / "sign"
    children: list[subprocess.Popen[str]] = []

    def interrupted(child: subprocess.Popen[str]) -> tuple[str, str]:
        children.append(child)
        until(lambda: sign.exists() and sign.read_text() != "")
        raise Stopped(signal.SIGINT)

    monkeypatch.setattr(subprocess.Popen, "communicate", interrupted)
    command = [sys.executable, "-c", CHILD, str(sign), hears]
    with pytest.raises(Stopped):
        run_child(command, os.environ | {"PYTHONPATH": str(ROOT)}, patience_s=patience_s)
    (child,) = children
    assert child.returncode == -how
    for pipe in filter(None, (child.stdout, child.stderr)):
        pipe.close()
    until(lambda: ended(int(sign.read_text())))


def ended(process: int) -> bool:
    """Whether a process is gone, or is there in name only, as nobody has asked how it ended."""
    try:
        state = Path(f"/proc/{process}/stat").read_text(encoding="ascii").rpartition(")")[2]
    except (FileNotFoundError, ProcessLookupError):
        return True
    return state.split()[0] == "Z"
