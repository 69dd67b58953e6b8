"""The engines by name, and what each offers; nothing of it is loaded before it is asked for."""

import importlib
import os
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from types import ModuleType
from typing import Literal, cast

from models.errors import EngineError
from sim.engine import Engine
from sim.own_engine.known import own_engine
from sim.own_engine.spelling import installed

ENGINES: Mapping[str, str] = {
    "mujoco": "..mujoco",
    "pymunk": "..pymunk",
    "exudyn": "..exudyn",
}
"""Name to folder. To add an engine, add its folder, with a `Declaration`, and a line here."""
FIRST = next(iter(ENGINES))
"""The one that is taken where one is enough, and none was named."""
Capability = Literal["snippet", "knobs", "remedies", "spoiler", "viewer", "reader", "force_recipe"]
"""What an engine may lack."""


class BrokenEngineError(EngineError):
    """An engine that is installed, and fails when it is imported."""


@dataclass(frozen=True)
class Declaration:
    """What stands in the folder of an engine; its ``__init__`` has it as ``DECLARATION``.

    ``package`` is what Python imports, ``install`` what pip calls it; an ``extra`` is no part of a
    plain install of crankcheck, and runs where it is named. The adapter is the value ``ENGINE`` of
    the file ``engine``; each of what it ``offers`` has a file of that name too, with a value of
    that name in capitals: a `SnippetWriter`, `SearchSpace`, `Remedies`, `Spoiler`, `Viewer`,
    `Reader` or `ForceRecipe`.
    """

    package: str
    install: str
    offers: tuple[Capability, ...] = ()
    extra: bool = False


OWN = Declaration("", "", extra=True)
"""What is declared of an engine that is not ours."""


@dataclass(frozen=True)
class Availability:
    """Whether an engine can be used here: its version, or the command that installs it; why not,
    where it is installed."""

    name: str
    version: str | None
    install: str
    broken: str = ""


def declaration(name: str) -> Declaration:
    """What an engine's folder holds; one that is not ours has its adapter alone. Raises
    EngineError, with near names, for an unknown one."""
    if name not in ENGINES:
        own_engine(name, ENGINES)
        return OWN
    return cast(Declaration, importlib.import_module(ENGINES[name], __package__).DECLARATION)


def usual() -> list[str]:
    """The engines that run where none is named: those that a plain install brings."""
    return [name for name in ENGINES if not declaration(name).extra]


def engine(name: str) -> Engine:
    """The engine of that name: one of ours, or of an installed package that has it in its entry
    points; or of the spelling `package.module:ATTRIBUTE`, by whose name it is known from then on.

    Raises
    ------
    EngineError
        No such engine (the message suggests near names), or its package is not installed, or can
        not be imported here; or what is there is no engine, or has the name of another.
    """
    if name not in ENGINES:
        return own_engine(name, ENGINES)
    return cast(Engine, _loaded(name, "engine"))


def capability(name: str, what: Capability) -> object:
    """What an engine offers beside its adapter.

    Raises
    ------
    EngineError
        As `engine` does, and where the engine does not offer it: the message says which ones do.
    """
    if what not in declaration(name).offers:
        others = " or ".join(offering(what))
        cure = f"use {others}" if others else "no engine has one"
        raise EngineError(f"engine {name}: it has no {what}; {cure}")
    return _loaded(name, what)


def offering(what: Capability) -> list[str]:
    """The engines that offer it, installed or not."""
    return [name for name in ENGINES if what in declaration(name).offers]


def _loaded(name: str, part: str) -> object:
    """The value that a file in the folder of an engine is there for."""
    package = declaration(name).package
    try:
        module = importlib.import_module(f"{ENGINES[name]}.{part}", __package__)
    except Exception as error:
        _refuse_broken(name, package)
        if not isinstance(error, ImportError | AttributeError):
            raise
        # What a half-removed package leaves of an engine is a module that lacks attributes.
        lacking = error.name if isinstance(error, ImportError) else _module_name(error.obj)
        if (lacking or package).split(".")[0] != package:
            raise
        raise EngineError(f"engine {name}: not installed; {install_command(name)}") from None
    return getattr(module, part.upper())


def _refuse_broken(name: str, package: str) -> None:
    """Import the package of an engine by itself: what fails in that is no fault of ours. Raises
    BrokenEngineError for a package that is there, and fails."""
    try:
        importlib.import_module(package)
    except Exception as error:
        if isinstance(error, ModuleNotFoundError) and error.name == package:
            return  # what imports it says what to do
        why = f"{type(error).__name__}: {str(error).partition(chr(10))[0][:300]}"
        named = [f"{key}={value}" for key, value in os.environ.items() if package.upper() in key]
        cure = f"look at {', '.join(named)}, or install it again" if named else "install it again"
        raise BrokenEngineError(
            f"engine {name}: {package} can not be imported here: {why}; {cure}: "
            f"{install_command(name)}"
        ) from None


def _module_name(value: object) -> str:
    """The name of a module, or of that of a class or value; empty where nothing is known."""
    if isinstance(value, ModuleType):
        return value.__name__
    home = getattr(value, "__module__", None) or type(value).__module__
    return "" if value is None else str(home)


def install_command(name: str) -> str:
    """The command that installs an engine's package."""
    return f"{sys.executable} -m pip install {declaration(name).install}"


def available() -> tuple[Availability, ...]:
    """All engines of ours, installed or not."""
    return tuple(_available(name, install_command(name), BrokenEngineError) for name in ENGINES)


def applying_beams() -> list[str]:
    """The installed engines of ours that have beams of their own."""
    return [one.name for one in available() if one.version and engine(one.name).applies_beams]


def brought() -> tuple[Availability, ...]:
    """The engines that other installed packages bring, by their entry points; what is wrong with
    one that can not be used is said."""
    names = dict.fromkeys(point.name for point in installed())
    return tuple(_available(name, "", EngineError) for name in names)


def _available(name: str, install: str, told: type[EngineError]) -> Availability:
    """Whether an engine can be used; what is wrong with it is said of errors of these kinds."""
    try:
        return Availability(name, engine(name).version(), install)
    except EngineError as error:
        return Availability(name, None, install, str(error) if isinstance(error, told) else "")
