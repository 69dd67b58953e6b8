"""Spelling of users' own engines, and their import by it.

`package.module:ATTRIBUTE` names any object that can be imported, also from the working folder of
the command; an installed package names its own in the entry points of `GROUP`.
"""

from __future__ import annotations

import importlib
import os
import re
import sys
import traceback
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from models.errors import EngineError, cut, suggestion
from sim.engine import Engine

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

GROUP = "crankcheck.engines"
"""Group of entry points."""
SPELLING = re.compile(r"[^\W\d]\w*(\.[^\W\d]\w*)*:[^\W\d]\w*(\.[^\W\d]\w*)*")
WRITTEN = "package.module:ATTRIBUTE"
"""Form of a spelling."""


def installed() -> list[EntryPoint]:
    """List the entry points of engines, of all packages installed here."""
    from importlib.metadata import entry_points  # whose import takes longer than all else here

    here = entry_points(group=GROUP)
    return sorted(set(here), key=lambda point: (point.name, point.value))


def spelling_of(point: EntryPoint) -> str:
    """Return the module and attribute of an entry point."""
    return f"{point.module}:{point.attr}"


def only_one(name: str, points: Iterable[EntryPoint]) -> EntryPoint:
    """Return the entry point of that name. Raises EngineError where two packages have it."""
    named = {spelling_of(point): point for point in points if point.name == name}
    if len(named) > 1:
        raise EngineError(
            f"engine {name}: two installed packages have one of that name: {' and '.join(named)}; "
            "remove one of them, or rename its entry point and its engine"
        )
    return next(iter(named.values()))


def found(spelling: str) -> object:
    """Import the object of a spelling.

    Raises
    ------
    EngineError
        A text that is no spelling, a module that is missing or cannot be imported (with the place
        of the failure), a missing attribute, with near names.
    """
    if not SPELLING.fullmatch(spelling):
        raise EngineError(f"engine {cut(spelling)!r}: write it {WRITTEN}")
    module, _, attribute = spelling.partition(":")
    value: object = _imported(spelling, module)
    for name in attribute.split("."):
        if not hasattr(value, name):
            raise EngineError(
                f"engine {spelling}: {module} has no {name}; "
                + suggestion(name, _public(value), "it has")
            )
        value = getattr(value, name)
    return value


def _public(value: object) -> list[str]:
    """Return suggestions: the engines of an object, or else all its public names."""
    names = [name for name in dir(value) if not name.startswith("_")]
    return [n for n in names if isinstance(getattr(value, n, None), Engine)] or names


def _imported(spelling: str, module: str) -> object:
    """Import the module. Raises EngineError in one line for any failure."""
    try:
        with _working_folder():
            importlib.invalidate_caches()  # it may have been written a moment ago
            return importlib.import_module(module)
    except (Exception, SystemExit) as error:
        if isinstance(error, ModuleNotFoundError) and f"{module}.".startswith(f"{error.name}."):
            raise EngineError(
                f"engine {spelling}: no module {error.name}, neither installed nor in "
                f"{Path.cwd()}; {suggestion(module, _modules(), 'modules there:')}"
            ) from None
        raise EngineError(
            f"engine {spelling}: {module} can not be imported: {failure(error)}; mend that first"
        ) from None


def failure(error: BaseException) -> str:
    """Describe an error and its place in one line."""
    text = cut(str(error).partition("\n")[0], 300)
    frames = traceback.extract_tb(error.__traceback__)
    own = [frame for frame in frames if not frame.filename.startswith("<frozen ")]
    place, line = (own[-1].filename, own[-1].lineno) if own else ("", None)
    if isinstance(error, SyntaxError) and error.filename:
        text, place, line = error.msg, error.filename, error.lineno
    return f"{type(error).__name__}: {text}" + (f" ({Path(place).name}, line {line})" * bool(place))


def _modules() -> Iterator[str]:
    """Yield the modules and packages in the working folder."""
    for path in sorted(Path.cwd().iterdir()):
        if path.suffix == ".py" or (path / "__init__.py").is_file():
            yield path.stem


@contextmanager
def _working_folder() -> Iterator[None]:
    """Put the working folder first during an import, as for `python -m pytest`; afterwards it is
    last, so that nothing in it hides later imports."""
    try:
        here = str(Path.cwd())
    except OSError:  # it is gone
        yield
        return
    sys.path.insert(0, here)
    try:
        yield
    finally:
        sys.path.remove(here)
        if not any(os.path.abspath(each or here) == here for each in sys.path):  # noqa: PTH100 - as sys.path has it
            sys.path.append(here)
