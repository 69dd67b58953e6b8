"""The command `crankcheck` as a process of its own, and what runs beside it.

It is that of this environment; the variable CRANKCHECK_COMMAND names another, such as that of a
wheel installed elsewhere (`tests/test_wheel.py`).
"""

from __future__ import annotations

import os
import re
import sys
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
