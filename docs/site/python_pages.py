"""The reference of Python, from the docstrings: of the public face, and of the code of the theory.

Pages say which object stands where (`::: name`); mkdocstrings writes the rest.
"""

from __future__ import annotations

import importlib
import inspect
import re
from collections.abc import Iterable, Mapping
from pathlib import Path

import crankcheck
from crankcheck import engine, testing

THEORY = "analytic"
OTHERS = ("models", "sim", "reports")
REFERENCE = re.compile(r"\]\[((?:analytic|models|sim|reports|crankcheck)[\w.]*)\]")
SHORT_REFERENCE = re.compile(r"\[`?((?:analytic|models|sim|reports|crankcheck)[\w.]*)`?\]\[\]")


def face_page() -> str:
    """All of `import crankcheck`: functions, what they give, errors; tests; engines."""
    names = [name for name in crankcheck.__all__ if not name.startswith("_")]
    things = {name: getattr(crankcheck, name) for name in names}
    functions = [name for name in names if inspect.isroutine(things[name])]
    errors = [name for name in names if _is_error(things[name])]
    rest = [name for name in names if name not in {*functions, *errors}]
    known = set(names)
    own = [name for name in engine.__all__ if name not in known]
    as_above = ", ".join(f"`{name}`" for name in engine.__all__ if name in known)
    sections = {
        "Functions": _entries("crankcheck", functions),
        "What they take and give": _entries("crankcheck", rest),
        "Errors": _entries("crankcheck", errors),
        "crankcheck.testing": _entries("crankcheck.testing", testing.__all__),
        "crankcheck.engine": f"Also {as_above}, as above.\n\n" + _entries("crankcheck.engine", own),
    }
    return "\n\n".join(f"## {title}\n\n{entries}" for title, entries in sections.items()) + "\n"


def _is_error(thing: object) -> bool:
    return isinstance(thing, type) and issubclass(thing, Exception)


def _entries(module: str, names: Iterable[str]) -> str:
    return "\n\n".join(f"::: {module}.{name}" for name in names)


def theory_rooms(root: Path) -> list[str]:
    """The rooms of the theory, and its files that are one of their own."""
    found = [*(root / THEORY).glob("*/__init__.py"), *(root / THEORY).glob("*.py")]
    return sorted(
        path.parent.name if path.name == "__init__.py" else path.stem
        for path in found
        if path.parent.name != THEORY or path.name != "__init__.py"
    )


def theory_page(room: str) -> str:
    """One room with all its modules, functions and classes, and their code."""
    name = f"{THEORY}.{room}"
    return f"# {name} {{: #{name} }}\n\n{_module(name, code=True)}\n"


def theory_index(rooms: Iterable[str]) -> str:
    """A table of the rooms, with the first line of what they say."""
    rows = [
        f"| [{THEORY}.{room}]({THEORY}/{room}.md) | {_first_line(f'{THEORY}.{room}')} |"
        for room in rooms
    ]
    return "\n".join(["| room | what |", "|---|---|", *rows]) + "\n"


def _first_line(module: str) -> str:
    told = inspect.getdoc(importlib.import_module(module)) or ""
    return " ".join(told.split("\n\n")[0].split()).replace("|", r"\|")


def others_page(pages: Mapping[str, str]) -> str:
    """The modules beside the theory that pages refer to."""
    modules = {home(name) for page in pages.values() for name in references(page)}
    shown = sorted(name for name in modules if name.split(".")[0] in OTHERS)
    return "\n\n".join(f"## {name}\n\n{_module(name, code=True, level=3)}" for name in shown) + "\n"


def references(page: str) -> set[str]:
    """The dotted names of our code that a page refers to."""
    return {*REFERENCE.findall(page), *SHORT_REFERENCE.findall(page)}


def home(name: str) -> str:
    """The module that a dotted name is in, "" where there is none of it."""
    parts = name.split(".")
    for count in range(len(parts), 0, -1):
        module = ".".join(parts[:count])
        try:
            there: object = importlib.import_module(module)
        except ModuleNotFoundError:
            continue
        for part in parts[count:]:
            there = getattr(there, part, None) or _annotated(there, part)
        return module if there is not None else ""
    return ""


def _annotated(owner: object, name: str) -> object:
    """A field of a class that has no default stands in its annotations only."""
    return getattr(owner, "__annotations__", {}).get(name)


def _module(name: str, *, code: bool, level: int = 2) -> str:
    options = {
        "show_root_heading": "false",
        "show_root_toc_entry": "false",
        "show_submodules": "true",
        "show_source": str(code).lower(),
        "heading_level": str(level),
    }
    lines = "\n".join(f"      {key}: {value}" for key, value in options.items())
    return f"::: {name}\n    options:\n{lines}"
