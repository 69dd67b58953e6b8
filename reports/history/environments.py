"""An environment for one version of an engine: made once, complete or not there at all."""

from __future__ import annotations

import hashlib
import os
import platform
import re
import shutil
import sys
import sysconfig
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import version as installed_version
from pathlib import Path

from packaging.version import InvalidVersion, Version

from models.errors import CrankcheckError
from reports.history.install_errors import reason, shortened
from reports.output.write import write
from reports.workers.signals import Runner
from sim.registry import declaration

COMPLETE = "complete.txt"
LEAK = re.compile(
    "CONDA_PREFIX|VIRTUAL_ENV|__PYVENV_LAUNCHER__|PYTHON(HOME|PATH)|"
    "PIP_(CONSTRAINT|NO_DEPS|PREFIX|PYTHON|ROOT|TARGET|USER)|"
    "UV_(CONSTRAINT|OVERRIDE|PROJECT_ENVIRONMENT|PYTHON|SYSTEM_PYTHON|TARGET)"
)
"""Variables that would put packages of another environment in front of those of a new one, install
into another place, or hold the engine at another version."""


class NotMeasuredError(Exception):
    """A version that has no result; its text is the reason, one line."""


@dataclass(frozen=True)
class EngineVersion:
    """An engine at a version."""

    engine: str
    version: Version

    @property
    def name(self) -> str:
        return f"{self.engine}-{self.version}"

    @property
    def requirement(self) -> str:
        return f"{declaration(self.engine).install}=={self.version}"


def wanted(engine: str, texts: Sequence[str]) -> list[EngineVersion]:
    """The versions that a user named, each once, the oldest first. Raises CrankcheckError for a
    text that is no version."""
    versions = set()
    for text in texts:
        try:
            versions.add(Version(text))
        except ValueError:  # InvalidVersion, or a number of very many digits
            raise CrankcheckError(
                f"version {text[:80]!r}: not a version number; name released versions of "
                f"{engine}, such as 3.6.0"
            ) from None
    return [EngineVersion(engine, version) for version in sorted(versions)]


def uv_here() -> str | None:
    """The command uv, on the path or beside this Python; None without one."""
    return shutil.which("uv") or shutil.which("uv", path=str(Path(sys.executable).parent))


def python_of(folder: Path) -> Path:
    """The interpreter of an environment."""
    return folder / ("Scripts/python.exe" if os.name == "nt" else "bin/python")


def place(cache: Path, asked: EngineVersion) -> Path:
    """The folder of an environment: another for every Python and every numpy."""
    python = platform.python_version()
    build = (sysconfig.get_config_var("SOABI"), platform.machine(), sys.base_prefix)
    short = hashlib.sha256(repr(build).encode()).hexdigest()[:8]
    name = f"{asked.name}-python-{python}-numpy-{held_numpy()}-{short}"
    return cache / "environments" / name


def held_numpy() -> str:
    """The version of numpy that runs now: every version of the engine is run with this one."""
    return installed_version("numpy")


def commands(
    uv: str | None, folder: Path, asked: EngineVersion, constraint: Path
) -> list[list[str]]:
    """What makes an environment and installs an engine, with its own dependencies, into it.

    Wheels only: an engine that has to be compiled first would be another one on every machine.
    """
    wheels = ["--only-binary", ":all:", "--constraint", str(constraint), asked.requirement]
    python = str(python_of(folder))
    if uv:
        return [
            [uv, "venv", "--no-project", "--quiet", "--python", sys.executable, str(folder)],
            [uv, "pip", "install", "--quiet", "--python", python, *wheels],
        ]
    return [
        [sys.executable, "-m", "venv", str(folder)],
        [python, "-m", "pip", "install", "--quiet", "--no-input", *wheels],
    ]


def clean_variables(variables: Mapping[str, str] = os.environ) -> dict[str, str]:
    """The environment variables without those that lead a new environment astray."""
    return {name: text for name, text in variables.items() if not LEAK.fullmatch(name.upper())}


def ready(cache: Path, asked: EngineVersion, uv: str | None, run: Runner) -> Path:
    """The interpreter of the version's environment, which is made if it is not there yet.

    An environment counts as there once it is complete: what a killed install left is made anew.

    Raises
    ------
    NotMeasuredError
        It could not be installed, with the reason in one line.
    CrankcheckError
        The cache can not be written.
    """
    folder = place(cache, asked)
    python = python_of(folder)
    if (folder / COMPLETE).is_file() and python.is_file():
        return python
    _clear(folder)
    constraint = cache / "environments" / f"numpy-{held_numpy()}.txt"
    write(constraint, f"numpy=={held_numpy()}\n")
    for command in commands(uv, folder, asked, constraint):
        ended = run(command, clean_variables(), constraint.parent)
        if ended.code:
            _clear(folder)
            raise NotMeasuredError(f"not installed: {reason(ended.output, ended.complaint)}")
    _check(python, asked, run)
    write(folder / COMPLETE, f"{asked.requirement}\n")
    return python


def _check(python: Path, asked: EngineVersion, run: Runner) -> None:
    """Ask the new interpreter for the version that it finds. Raises NotMeasuredError."""
    package = declaration(asked.engine).install
    question = f"from importlib.metadata import version; print(version({package!r}))"
    ended = run([str(python), "-P", "-c", question], clean_variables(), None)
    answer = ended.output.strip()
    try:
        same = not ended.code and Version(answer) == asked.version
    except InvalidVersion:
        same = False
    if not same:
        raise NotMeasuredError(
            shortened(
                f"installed, but the new environment finds {answer or 'no ' + asked.engine} in "
                f"place of {asked.version}: look into the settings of pip or uv"
            )
        )


def _clear(folder: Path) -> None:
    """Take away what is left of an environment. Raises CrankcheckError."""
    if not folder.exists():
        return
    try:
        shutil.rmtree(folder)
    except OSError as error:
        raise CrankcheckError(
            f"{folder}: left over, and can not be taken away: {error.strerror or error}; "
            "remove it, or choose another --cache"
        ) from None
