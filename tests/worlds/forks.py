"""Ends of the command in processes that share one start and its imports, by `os.fork`."""

from __future__ import annotations

import subprocess
from collections.abc import Mapping
from pathlib import Path

from tests.worlds.command import PYTHON, script

SCRIPT = """
import atexit, os, signal, sys, time
from crankcheck.__main__ import main
from models.errors import EngineError
from reports.cli.commands import listing, solve
from reports.workers import signals

def strike(*_):
    os.kill(os.getpid(), signal.SIGINT)

for name, code in {codes!r}.items():
    if not os.fork():
        for number, kind in ((1, "out"), (2, "err")):
            os.dup2(os.open(f"{{name}}.{{kind}}", os.O_WRONLY | os.O_CREAT), number)
        sys.argv = ["crankcheck", "scenes"]
        exec(code, globals())
        main()
        sys.exit(0)
    print(os.waitstatus_to_exitcode(os.wait()[1]), flush=True)
"""
End = tuple[int, str, str]


def ends(codes: Mapping[str, str], folder: Path) -> dict[str, End]:
    """Exit code, output and complaint of `crankcheck scenes`, by the name of the code that runs
    before it, which may make another command of it: it knows the names in `SCRIPT`."""
    command = [PYTHON, "-P", "-c", script(SCRIPT.format(codes=dict(codes)))]
    done = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, text=True, check=True)

    def said(name: str, kind: str) -> str:
        return (folder / f"{name}.{kind}").read_text(encoding="utf-8")

    ended = zip(codes, map(int, done.stdout.split()), strict=True)
    return {name: (code, said(name, "out"), said(name, "err")) for name, code in ended}
