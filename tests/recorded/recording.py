"""Which lines each test reaches: a plugin of pytest and of coverage, for `make record`.

Every process of a run is measured, those that tests start too (`COVERAGE_PROCESS_START` names the
settings that `settings` writes). A line is noted for the test that ran it. What is made once and
shared, by a fixture of a wider scope or a cache, has a name of its own, and each test that gets it
is noted as its user: it reaches these lines as well. (PYTEST_DONT_REWRITE: coverage is first to
import this file.)
"""

import contextlib
import functools
import itertools
import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

import coverage
import pytest

ROOT = Path(__file__).parents[2]
PACKAGES = ("models", "analytic", "sim", "reports", "crankcheck")
OURS = (*PACKAGES, "tests")
SHARED = "shared:"
USES = "uses-{}.jsonl"
SECONDS = "seconds-{}.jsonl"
ALIVE_S = 3.0
"""How long a child that is to be killed may take to write its lines first."""
_stack: list[str] = []
"""Whose lines are noted now, the innermost last; empty in a child, which has one name for all."""
_uses: set[tuple[str, str]] = set()
_numbers = itertools.count()
_lru_cache = functools.lru_cache
_kill = subprocess.Popen.kill


def settings(folder: Path, root: Path = ROOT, files: Iterable[str] = ()) -> Path:
    """Write the settings of coverage into the folder, for all our files of a checkout, or these."""
    include = "".join(f"\n    {root / file}" for file in files or (f"{each}/*" for each in OURS))
    path = folder / "settings.ini"
    path.write_text(
        f"[run]\nparallel = True\nsigterm = True\ndata_file = {folder / '.coverage'}\n"
        "context = ${PYTEST_CURRENT_TEST-}\nplugins = tests.recorded.recording\n"
        "disable_warnings = no-data-collected, no-ctracer\n"
        f"include ={include}\n",
        encoding="utf-8",
    )
    return path


def coverage_init(reg: object, options: object) -> None:
    """Coverage calls this in every process that it measures."""
    subprocess.Popen.kill = _killed  # type: ignore[method-assign]  # a record of a killed child
    functools.lru_cache = _noted_cache  # type: ignore[assignment]  # as below
    functools.cache = _noted_cache(maxsize=None)  # type: ignore[assignment]  # as below


def _killed(program: subprocess.Popen[Any]) -> None:
    """End a child by a signal that lets it write its lines, before the one that does not."""
    if program.returncode is None and sys.platform != "win32":
        program.terminate()
        with contextlib.suppress(subprocess.TimeoutExpired):
            program.wait(ALIVE_S)
    _kill(program)


@contextlib.contextmanager
def _noted_as(name: str) -> Iterator[None]:
    """Lines of the block belong to that name."""
    _stack.append(name)
    _switch()
    try:
        yield
    finally:
        _stack.pop()
        _switch()


def _switch() -> None:
    if (measured := coverage.Coverage.current()) is not None and _stack:
        measured.switch_context(_stack[-1])


def _noted_cache(maxsize: object = 128, typed: bool = False) -> Any:
    """`functools.lru_cache`, that keeps with each answer under which name it was made."""
    if callable(maxsize):
        return _noted_cache()(maxsize)

    def decorated(function: Callable[..., object]) -> Callable[..., object]:
        if str(function.__module__).partition(".")[0] not in OURS:
            return _lru_cache(maxsize, typed)(function)  # type: ignore[arg-type]  # as it came

        @_lru_cache(maxsize, typed)  # type: ignore[arg-type]  # as it came
        def made(*args: object, **options: object) -> tuple[object, str]:
            name = f"{SHARED}{os.getpid()}:{next(_numbers)}:{function.__qualname__}"
            if not _stack:
                return function(*args, **options), name
            user = _stack[-1]
            with _noted_as(name):
                try:
                    return function(*args, **options), name
                except BaseException:  # no answer is kept that would name who used it
                    _uses.add((user, name))
                    raise

        @functools.wraps(function)
        def shared(*args: object, **options: object) -> object:
            answer, name = made(*args, **options)
            if _stack:
                _uses.add((_stack[-1], name))
            return answer

        for name in ("cache_clear", "cache_info", "cache_parameters"):
            setattr(shared, name, getattr(made, name))
        return shared

    return decorated


def pytest_configure() -> None:
    _stack.append("start")


@pytest.hookimpl(wrapper=True)
def pytest_fixture_setup(
    fixturedef: pytest.FixtureDef[Any], request: pytest.FixtureRequest
) -> Iterator[None]:
    if fixturedef.scope == "function":
        return (yield)
    with _noted_as(_of_fixture(fixturedef)):
        return (yield)


def _of_fixture(fixture: pytest.FixtureDef[Any]) -> str:
    return f"{SHARED}{os.getpid()}:{fixture.baseid}:{fixture.argname}"


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Iterator[None]:
    known = getattr(item, "_fixtureinfo", None)
    for fixture in itertools.chain(*(known.name2fixturedefs.values() if known else ())):
        if fixture.scope != "function":
            _uses.add((item.nodeid, _of_fixture(fixture)))
    with _noted_as(item.nodeid):
        return (yield)


def pytest_runtest_logreport(report: pytest.TestReport) -> None:
    if not hasattr(report, "node"):  # by the process that ran it, not by the one that prints it
        _add(SECONDS, [[report.nodeid, report.when, report.duration, report.outcome]])


def pytest_sessionfinish() -> None:
    _add(USES, _uses)


def _add(file: str, rows: Iterable[object]) -> None:
    folder = Path(os.environ["COVERAGE_PROCESS_START"]).parent
    with (folder / file.format(os.getpid())).open("a", encoding="utf-8") as stream:
        stream.writelines(json.dumps(row) + "\n" for row in rows)
