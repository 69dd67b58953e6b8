"""The command `crankcheck` as a process of its own, what runs beside it, and ends of it in
processes that share one start.

It is that of this environment; the variable CRANKCHECK_COMMAND names another, such as that of a
wheel installed elsewhere (`tests/test_wheel.py`).
"""

import os
import re
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

VARIABLE = "CRANKCHECK_COMMAND"
COMMAND = os.environ.get(VARIABLE) or str(Path(sys.executable).with_name("crankcheck"))
PYTHON = str(Path(COMMAND).with_name("python")) if VARIABLE in os.environ else sys.executable
"""The interpreter that runs the command. With ``-P`` it does not look into the working folder,
which in tests is the checkout."""


def script(text: str) -> str:
    """A program for that interpreter: a wheel has our modules in `crankcheck`."""
    if VARIABLE not in os.environ:
        return text
    ours = r"^(\s*from )(?=(models|analytic|sim|reports)\b)"
    return re.sub(ours, r"\1crankcheck.", text, flags=re.MULTILINE)


def shadows(folder: Path) -> Path:
    """The folder, with empty packages in it that are called as ours are."""
    for name in ("models", "analytic", "sim", "reports"):
        (folder / name).mkdir(parents=True)
        (folder / name / "__init__.py").touch()
    return folder


SCRIPT = """
import atexit, os, signal, sys, time
from crankcheck.__main__ import main
from models.errors import EngineError
from reports.requests import solve
from reports.requests.export import ScenesRequest
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
