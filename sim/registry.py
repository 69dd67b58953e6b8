"""The engines by name; an engine's package is imported only when the engine is asked for."""

from __future__ import annotations

import difflib
import importlib
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from typing import cast

from models.errors import EngineError
from sim.engine import Engine

ENGINES: Mapping[str, str] = {
    "mujoco": "sim.mujoco.engine",
    "pymunk": "sim.pymunk.engine",
}
"""Name to module; each module has an ``ENGINE``. To add an engine, add a file and a line here."""


@dataclass(frozen=True)
class Availability:
    """Whether an engine can be used here: its version, or the command that installs it."""

    name: str
    version: str | None
    install: str


def engine(name: str) -> Engine:
    """The engine of that name.

    Raises
    ------
    EngineError
        No such engine (the message suggests near names), or its package is not installed.
    """
    if name not in ENGINES:
        near = difflib.get_close_matches(name, ENGINES, n=2, cutoff=0.4)
        hint = f"did you mean {' or '.join(near)}?" if near else f"there are {', '.join(ENGINES)}"
        raise EngineError(f"engine {name!r}: unknown; {hint}")
    try:
        module = importlib.import_module(ENGINES[name])
    except (ImportError, AttributeError) as error:
        # An AttributeError is what a half-removed package leaves of an engine.
        at_fault = isinstance(error, AttributeError) or (error.name or name).split(".")[0] == name
        if not at_fault:
            raise
        raise EngineError(f"engine {name}: not installed; {install_command(name)}") from None
    return cast(Engine, module.ENGINE)


def install_command(name: str) -> str:
    """The command that installs an engine's package."""
    return f"{sys.executable} -m pip install {name}"


def available() -> tuple[Availability, ...]:
    """All engines, installed or not."""
    found = []
    for name in ENGINES:
        try:
            version: str | None = engine(name).version()
        except EngineError:
            version = None
        found.append(Availability(name, version, install_command(name)))
    return tuple(found)
