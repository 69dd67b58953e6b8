"""One thread for linear algebra in the command and its workers, unless the user says how many."""

from __future__ import annotations

import os
import subprocess
import sys
from contextlib import closing

import pytest

from reports.workers.isolated import Isolated, Limits
from reports.workers.one_thread import CHOICES, THREADS, one_thread
from tests.worlds.programs import ROOT


@pytest.mark.parametrize("name", CHOICES)
def test_what_the_user_says_stays(name: str) -> None:
    variables = {name: "3"}
    one_thread(variables)
    assert variables == {name: "3"}


def test_a_worker_has_one_thread(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in CHOICES:
        monkeypatch.delenv(name, raising=False)
    with closing(Isolated[str | None](Limits(900.0))) as isolated:
        assert isolated.call(os.getenv, THREADS) == "1"
    assert THREADS not in os.environ  # this process is the user's own
    monkeypatch.setenv(THREADS, "2")
    with closing(Isolated[str | None](Limits(900.0))) as isolated:
        assert isolated.call(os.getenv, THREADS) == "2"


def test_the_command_asks_before_numpy_is_imported() -> None:
    program = (
        "import os, sys, crankcheck.__main__ as command, reports.workers.one_thread as own\n"
        "def seen(variables):\n"
        "    print('numpy' in sys.modules, variables is os.environ)\n"
        "own.one_thread = seen\n"
        "sys.argv = ['crankcheck', '--version']\n"
        "command.main()\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.stdout.splitlines()[0] == "False True", done.stderr
