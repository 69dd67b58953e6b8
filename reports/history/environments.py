"""An environment for one version of an engine: made once, complete or not there at all."""

import hashlib
import os
import platform
import re
import shutil
import sys
import sysconfig
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import version as installed_version
from pathlib import Path

from packaging.version import InvalidVersion, Version

from models.errors import CrankcheckError, cut
from reports.output.write import write
from reports.workers.signals import Runner
from sim.registry import declaration

COMPLETE = "complete.txt"
LEAK = re.compile(
    "CONDA_PREFIX|VIRTUAL_ENV|__PYVENV_LAUNCHER__|PYTHON(HOME|PATH)|"
    "PIP_(CONSTRAINT|NO_DEPS|PREFIX|PYTHON|ROOT|TARGET|USER)|"
    "UV_(CONSTRAINT|OVERRIDE|PROJECT_ENVIRONMENT|PYTHON|SYSTEM_PYTHON|TARGET)"
)
"""Variables that would put packages of another environment in front of a new one's, install into
another place, or keep the engine at another version."""


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
        return f"{declaration(self.engine).distribution}=={self.version}"


def wanted(engine: str, texts: Sequence[str]) -> list[EngineVersion]:
    """Return the versions that a user named, each once, the oldest first. Raises CrankcheckError
    for a text that is no version."""
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
    """Return the command uv, on the path or beside this Python; None without one."""
    return shutil.which("uv") or shutil.which("uv", path=str(Path(sys.executable).parent))


def python_of(folder: Path) -> Path:
    """Return the interpreter of an environment."""
    return folder / ("Scripts/python.exe" if os.name == "nt" else "bin/python")


def place(cache: Path, asked: EngineVersion) -> Path:
    """Return the folder of an environment: another for every Python and every numpy."""
    python = platform.python_version()
    build = (sysconfig.get_config_var("SOABI"), platform.machine(), sys.base_prefix)
    short = hashlib.sha256(repr(build).encode()).hexdigest()[:8]
    name = f"{asked.name}-python-{python}-numpy-{held_numpy()}-{short}"
    return cache / "environments" / name


def held_numpy() -> str:
    """Return the version of numpy that runs now, which every version of the engine is run with."""
    return installed_version("numpy")


def commands(
    uv: str | None, folder: Path, asked: EngineVersion, constraint: Path
) -> list[list[str]]:
    """Return the commands that make an environment, and install engine and dependencies into it.

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
    """Return the environment variables without those that lead a new environment astray."""
    return {name: text for name, text in variables.items() if not LEAK.fullmatch(name.upper())}


def ready(cache: Path, asked: EngineVersion, uv: str | None, run: Runner) -> Path:
    """Return the interpreter of the version's environment, which is made if it is not there yet.

    An environment counts as there once it is complete: the rest of a killed install is made again.

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
    """Check the version in the new interpreter. Raises NotMeasuredError."""
    package = declaration(asked.engine).distribution
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
                f"place of {asked.version}: check the settings of pip or uv"
            )
        )


def _clear(folder: Path) -> None:
    """Remove the rest of an environment. Raises CrankcheckError."""
    if not folder.exists():
        return
    try:
        shutil.rmtree(folder)
    except OSError as error:
        raise CrankcheckError(
            f"{folder}: left over, and can not be removed: {error.strerror or error}; remove it "
            "by hand, or choose another --cache"
        ) from None


LONGEST = 200
URL = re.compile(r"\b[a-z][a-z0-9+.]*://[^\s'\"`)>,]+", re.IGNORECASE)
HOST_OF_URL = re.compile(r"://(?:[^/@\s]*@)?(\[[^\]]*\]|[^/:\s'\"`)>,]+)")
HOST = re.compile(r"host='([^']+)'")
OFFERED = re.compile(r"requirement (\S+?)==(\S+) \(from versions: ([^)]*)\)")
REFUSED = re.compile(r"there is no version of (\S+?)==(\S+?)(?:,| and|$)")
NO_WHEEL = re.compile(r"(\S+?)==(\S+) has no (?:usable )?wheels")
NETWORK = re.compile(
    "connection broken|Failed to establish|Max retries exceeded|Failed to fetch|dns error|"
    "error sending request|Network is unreachable|Name or service not known|name resolution"
)
CAUSE = re.compile(
    "refused|unreachable|resolution|lookup address|not known|timed out|certificate|"
    "Tunnel connection failed|Unauthorized|Forbidden"
)
NUMBERED = re.compile(r"\[Errno -?\d+\]|\(os error \d+\)")
NOISE = ("WARNING:", "Looking in", "[notice]", "hint:", "DEPRECATION", "Traceback", "Using Python")


def reason(*outputs: str) -> str:
    """Return the one line that matters in the output of pip or uv."""
    text = _named("\n".join(outputs))
    flat = " ".join(text.split())
    if NETWORK.search(flat):
        return _network(text)
    if match := OFFERED.search(flat):
        return _not_offered(match[1], match[2], match[3].split(", "))
    if match := REFUSED.search(flat) or NO_WHEEL.search(flat):
        return _not_offered(match[1], match[2], ())
    return shortened(_telling(text) or "the installer gave no reason")


def shortened(text: str) -> str:
    """Return one line of bounded length."""
    return cut(" ".join(text.split()), LONGEST)


def _named(output: str) -> str:
    """Return the output without hosts, URLs and line drawing."""
    hosts = {*HOST_OF_URL.findall(output), *HOST.findall(output)}
    text = URL.sub("the package index", output)
    for host in sorted(hosts, key=len, reverse=True):
        text = text.replace(host, "the package index")
    return re.sub("[\u2500-\u257f\u25b6\u00d7]", " ", text)


def _network(text: str) -> str:
    """Say that the package index did not answer, and why as far as known."""
    lines = [line.strip() for line in text.splitlines() if CAUSE.search(line)]
    parts = [part for line in lines[-1:] for part in re.split(r": (?=\S)", line)]
    cause = "".join([part for part in parts if CAUSE.search(part)][-1:])
    cause = NUMBERED.sub("", cause).strip(" ')]")
    return shortened("the package index could not be reached" + (f" ({cause})" if cause else ""))


def _not_offered(name: str, version: str, offered: Iterable[str]) -> str:
    """Say that there is no such version for this Python; and which are near."""
    near = _nearest(version, offered)
    python = ".".join(platform.python_version_tuple()[:2])
    here = f"Python {python} on {platform.system()} {platform.machine()}"
    what = f"no {name} {version} is offered as a wheel for {here}"
    return what + (f"; near it: {', '.join(near)}" if near else "")


def _nearest(version: str, offered: Iterable[str]) -> list[str]:
    """Return the two offered versions below one, and the one above."""
    try:
        asked = Version(version)
        others = sorted(Version(text.strip()) for text in offered if text != "none")
    except InvalidVersion:
        return []
    below = [other for other in others if other < asked][-2:]
    above = [other for other in others if other > asked][:1]
    return [str(each) for each in (*below, *above)]


def _telling(text: str) -> str:
    """Return pip's first error; uv's cause, which says more than its error; else the last line."""
    lines = [line.strip() for line in text.splitlines()]
    lines = [line for line in lines if line and not line.startswith(NOISE)]
    for number, line in enumerate(lines):
        if line.startswith("ERROR:"):
            return line.removeprefix("ERROR:").strip()
        if cause := re.match(r"(?:[Cc]ause(?:d by)?: *)?(Because .*)", line):
            return " ".join([cause[1], *lines[number + 1 :]])
    causes = [line for line in lines if re.match("cause(d by)?:", line, re.IGNORECASE)]
    last = causes[-1:] or lines[-1:]
    return re.sub(r"(?i)^(error|caused by|cause): *", "", last[0]) if last else ""
