"""Run a command on a scene file and see all that it did: how it ended, said, wrote and called."""

import contextlib
import cProfile
import csv
import os
import re
import sys
import tempfile
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import get_args
from unittest import mock

from typer.main import get_command
from typer.testing import CliRunner

from analytic.free import integration
from sim.engine import Status

ACTING = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069\ud800-\udfff]")
"""What a terminal obeys, or what turns the order of its letters round."""
UNSEEN = re.compile(ACTING.pattern[:-1] + "\u00ad\u061c\u200b-\u200f\u2060\ufeff]")
"""These, and what only hides: in a message about a name, nobody would see fault with it."""
MESSAGE = re.compile(r"^crankcheck: \S.*[:,;] \S", re.DOTALL)
LONGEST = 20_000
"""Characters of a message; a user reads a few lines."""
WRITES = os.O_WRONLY | os.O_RDWR | os.O_CREAT
ALLOWED = re.compile(r"/dev/(null|tty)$|.*[/.]matplotlib\b|.*/__pycache__/[^/]+\.pyc(\.\d+)?$")
"""What may be written elsewhere: the fonts that Matplotlib has found, and what Python keeps of a
module that is imported for the first time."""
TABLES = {
    "out/errors.parquet",
    *(f"out/verify.{kind}" for kind in ("csv", "html", "json", "junit.xml")),
}
VERIFY = "verify FILE --turns 0.2 -o OUT"
COMMANDS = (
    *[VERIFY] * 8, "verify FILE --turns 0.2 -o OUT --drive servo",
    "verify FILE --steps-per-turn 1e15 --turns 1e-13 -o OUT",
    "verify FILE --steps-per-turn 8 --turns 10 --no-convergence", "verify FILE --dt 1e-300",
    "verify FILE --dt 1e300 --turns 1e300", "solve FILE", "solve FILE --at-deg 90",
    "solve FILE --at-deg 1e300", "solve FILE --turns 1e300",
    "solve FILE --turns 3 --steps-per-turn 100 -o OUT.csv", "solve FILE --duration 0.05 --steps 4",
    "solve FILE --duration 1e300", "solve FILE -o OUT.xlsx", "export FILE",
    "export FILE --close C -o OUT.xml", "view FILE -o OUT.png")  # fmt: skip
"""What files are tried with."""
_SHORT = "--turns 0.12 --no-convergence --profile tuned -o OUT"
LET_GO = (
    "solve FILE",
    "solve FILE --duration 0.05 --steps 4",
    "solve FILE -o OUT.csv",
    "view FILE -o OUT.png",
)
"""What files of mechanisms that are let go for a moment are tried with."""
ELASTIC = (
    "solve FILE",
    "solve FILE --elements 2 --forces -o OUT.csv",
    "solve FILE --linear --modes 2 -o OUT.html",
    "vibration FILE --modes 2",
    "vibration FILE --modes 1 --speeds 2:20:5 -o OUT",
    "export FILE",
    f"verify FILE --engine mujoco {_SHORT} --segments 4",
)
"""What files of mechanisms with elastic links are tried with."""
ELASTIC_QUICK = (
    "solve FILE --elements 2 --forces -o OUT.csv",
    "vibration FILE --modes 2",
    "export FILE",
)
"""The shortest of these."""
MOST_WINDOWS = 200
"""Of an integration: as many as a user may wait for take minutes."""
MOMENT = "solve FILE --duration 0.01 --steps 4"
QUICK = (
    f"verify FILE --engine mujoco {_SHORT}",
    f"verify FILE --engine pymunk {_SHORT}",
    "solve FILE --turns 0.1 -o OUT.csv",
    "solve FILE --at-deg 90",
    "export FILE",
)
"""The same in a fraction of the time."""


def fitting(raw: bytes, command: str) -> str:
    """The command, or one for a moment in its place where a shipped mechanism is free, which may
    take its time for all of its motion."""
    is_free, works = b'"free"' in raw, command.startswith(("solve", "view"))
    return MOMENT if is_free and works else command


@dataclass(frozen=True)
class Ended:
    """How a command ended, with an exception that it let out, warnings of Python and numpy, files
    that it left or wrote elsewhere, outcomes of its cells, calls of functions (0 where nobody
    counted), and the memory [byte] before and at its peak."""

    code: int
    escaped: str
    output: str
    errors: str
    warnings: tuple[str, ...]
    files: tuple[str, ...]
    elsewhere: tuple[str, ...]
    outcomes: tuple[str, ...]
    calls: int
    before: int
    peak: int

    @property
    def faults(self) -> list[str]:
        """What no file may bring about."""
        found = [f"warning: {text}" for text in self.warnings]
        found += [f"wrote {path}" for path in self.elsewhere]
        said = self.output + self.errors
        if self.escaped:
            found.append(f"escaped: {self.escaped}")
        if self.code not in (0, 1, 2):
            found.append(f"exit code {self.code}")
        if "Traceback" in said or "internal error" in said:
            found.append("a traceback")
        if acting := ACTING.search(self.output) or UNSEEN.search(self.errors):
            found.append(f"a character that acts: {acting[0]!r}")
        if self.code == 2 and not MESSAGE.search(self.errors):
            found.append("exit code 2 without a message")
        if len(self.errors) > LONGEST:
            found.append(f"a message of {len(self.errors)} characters")
        if self.code != 2 and self.errors:
            found.append("messages of a run")
        if "out/verify.csv" in self.files and set(self.files) != TABLES:
            found.append(f"files {self.files}")
        if strange := set(self.outcomes).difference({*get_args(Status), "branch-changed"}):
            found.append(f"outcomes {strange}")
        return found


def attempt(
    made: bytes | Callable[[Path], object],
    *arguments: str,
    name: str = "scene.toml",
    counted: bool = False,
) -> Ended:
    """Run the command with ``arguments`` on a file of these bytes, or made by that, in a folder of
    its own. ``FILE`` and ``OUT`` are the file and the folder for what it writes. Calls are
    ``counted`` on demand, as that slows down what calls much."""
    _forget_peak()
    before = _peak()
    with tempfile.TemporaryDirectory() as folder:
        home = Path(folder).resolve()
        (home / "work").mkdir()
        _ = made(home / name) if callable(made) else (home / name).write_bytes(made)
        given = [f"../{name}" if each == "FILE" else each for each in arguments]
        given = [re.sub("^OUT", "../out", each) for each in given]
        counter = cProfile.Profile()
        with (
            contextlib.chdir(home / "work"),
            _native_errors(home / "native") as native,
            _watched(home) as elsewhere,
            mock.patch.object(integration, "MOST_WINDOWS", MOST_WINDOWS),
            warnings.catch_warnings(record=True) as caught,
            counter if counted else contextlib.nullcontext(),
        ):
            warnings.simplefilter("always")
            code, escaped, output, errors = _run(given)
        files = [str(path.relative_to(home)) for path in home.rglob("*") if path.is_file()]
        left = sorted(set(files) - {name, "native"})
        return Ended(
            code=code,
            escaped=escaped,
            output=output,
            errors=errors + native(),
            warnings=tuple(f"{one.filename}:{one.lineno} {one.message}" for one in caught),
            files=tuple(left),
            elsewhere=(*elsewhere, *(file for file in left if not file.startswith("out"))),
            outcomes=_outcomes(home / "out" / "verify.csv"),
            calls=sum(entry.callcount for entry in counter.getstats()),
            before=before,
            peak=_peak(),
        )


def _run(arguments: Sequence[str]) -> tuple[int, str, str, str]:
    """Exit code, an exception that got out, and what went to the standard output and error."""
    code, escaped = 0, ""
    with CliRunner().isolation(color=True) as (output, errors, _):
        try:
            _command()(arguments)
        except SystemExit as end:
            code = end.code if isinstance(end.code, int) else int(end.code is not None)
        except Exception as error:
            escaped = f"{type(error).__name__}: {error}"
        said = [stream.getvalue().decode() for stream in (output, errors)]
    return code, escaped, said[0], said[1]


@cache
def _command() -> Callable[[Sequence[str]], object]:
    """The command line, built once: that takes longer than to refuse a file."""
    from reports.cli import app

    return get_command(app)


def _outcomes(path: Path) -> tuple[str, ...]:
    if not path.exists():
        return ()
    with path.open(encoding="utf-8", newline="") as file:
        return tuple(row["status"] for row in csv.DictReader(file))


@contextlib.contextmanager
def _native_errors(path: Path) -> Iterator[Callable[[], str]]:
    """What native code writes to the standard error, which Python does not see."""
    before = os.dup(2)
    with path.open("wb") as file:
        os.dup2(file.fileno(), 2)
    try:
        yield lambda: path.read_text(encoding="utf-8", errors="replace")
    finally:
        os.dup2(before, 2)
        os.close(before)


@dataclass
class _Listener:
    """The paths that Python opens for writing, renames or removes, while it is switched on."""

    on: bool = False
    paths: list[Path] = field(default_factory=list)

    def hear(self, event: str, arguments: Sequence[object]) -> None:
        if not self.on:
            return
        if event == "open":
            path, _, flags = arguments
            if isinstance(path, str | bytes) and isinstance(flags, int) and flags & WRITES:
                self.paths.append(Path(os.fsdecode(path)).absolute())
        elif event in ("os.rename", "os.symlink", "os.remove", "os.rmdir"):
            paths = [one for one in arguments if isinstance(one, str | bytes)]
            self.paths += [Path(os.fsdecode(path)).absolute() for path in paths]


@cache
def _listener() -> _Listener:
    """The one of this process: a hook stays."""
    listener = _Listener()
    sys.addaudithook(listener.hear)
    return listener


@contextlib.contextmanager
def _watched(home: Path) -> Iterator[list[str]]:
    """What was written outside of ``home`` and is there still, known at the end of the block."""
    listener = _listener()
    elsewhere: list[str] = []
    listener.paths, listener.on = [], True
    try:
        yield elsewhere
    finally:
        listener.on = False
        for path in map(Path.resolve, listener.paths):
            aside = path.is_relative_to(Path(tempfile.gettempdir()).resolve())
            gone = aside and not path.is_file()  # a file of the moment, where such files belong
            if not gone and not path.is_relative_to(home) and not ALLOWED.match(str(path)):
                elsewhere.append(str(path))


def _forget_peak() -> None:
    """Let the system count the peak of memory from now on."""
    with contextlib.suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5", encoding="ascii")


def _peak() -> int:
    """The most memory that was held at once since [byte]; 0 where the system does not say."""
    try:
        status = Path("/proc/self/status").read_text(encoding="ascii")
    except OSError:
        return 0
    return 1024 * int(status.partition("VmHWM:")[2].split()[0])
