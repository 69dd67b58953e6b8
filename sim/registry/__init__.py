"""Registry of engines by name, and their capabilities; nothing is loaded before its use."""

import importlib
import os
import sys
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from importlib.util import find_spec
from types import ModuleType
from typing import Literal, cast

from models.errors import EngineError
from sim.engine import Engine, Precision
from sim.own_engine.known import own_engine
from sim.own_engine.watched import installed

ENGINES: Mapping[str, str] = {
    "mujoco": "..mujoco",
    "pymunk": "..pymunk",
    "exudyn": "..exudyn",
    "box2d": "..box2d",
    "rapier": "..rapier",
    "bullet": "..bullet",
    "drake": "..drake",
    "dart": "..dart",
    "simbody": "..simbody",
    "mjx": "..mjx",
    "mujoco-warp": "..mujoco_warp",
    "newton": "..newton",
}
"""Folders by name. A new engine needs its folder, with a `Declaration`, and a line here."""
FIRST = next(iter(ENGINES))
"""Default engine where one is enough."""
Capability = Literal[
    "snippet", "knobs", "remedies", "spoiler", "viewer", "reader", "force_recipe", "gradient"
]
"""Optional parts of an engine."""
Formulation = Literal[
    "soft constraints", "constraint impulses", "constraint equations", "by solver", "own"
]
"""Ways of holding a loop: by forces that give way; by impulses that correct velocities, once or in
sweeps; by the equations of the joints, solved in each step; another with each of its solvers; one
that is not known here."""


class BrokenEngineError(EngineError):
    """An installed engine that fails on import."""


@dataclass(frozen=True)
class Fewer:
    """Length of a verification, and its scenes where none is named, of an engine whose steps take
    long; ``batch_steps`` are the steps of a batch, None for ``turns`` of them."""

    steps_per_turn: float = 180.0
    turns: float = 1.0
    batch_steps: int | None = None
    scenes: tuple[str, ...] = ("fourbar-lecture-1", "slider-crank-offset", "slotted-lever")

    def lasts(self, *, in_batch: bool) -> str:
        """Return the length of a run in words."""
        short = in_batch and self.batch_steps
        return f"{self.batch_steps} steps in a batch" if short else f"{self.turns:g} turn"


@dataclass(frozen=True)
class Declaration:
    """Content of an engine's folder; its ``__init__`` has it as ``DECLARATION``.

    ``package`` is the name for Python's import, and for pip unless that has a ``pip_name``; an
    ``extra`` is no part of a plain install of crankcheck, and runs only by name. The adapter is the
    value ``ENGINE`` of the file ``engine``; each capability in ``offers`` has a file of its name
    too, with a value of that name in capitals: a `SnippetWriter`, `SearchSpace`, `Remedies`,
    `Spoiler`, `Viewer`, `Reader`, `ForceRecipe` or `Differentiated`. An engine that runs ``apart``
    may end its process: it gets one of its own. ``tried`` starts every version that was compared
    with the reference, ``wheels`` says for which systems there are any, where not for all.
    ``fewer`` is the default verification of an engine whose steps take long.
    """

    package: str
    offers: tuple[Capability, ...] = ()
    extra: bool = True
    formulation: Formulation = "own"
    precision: Precision = "double"
    apart: bool = False
    tried: str = ""
    wheels: str = ""
    pip_name: str = ""
    fewer: Fewer | None = None
    needs: tuple[str, ...] = ()

    @property
    def roots(self) -> set[str]:
        """Top-level modules without which the engine is not installed."""
        return {name.split(".")[0] for name in (self.package, *self.needs)}

    @property
    def distribution(self) -> str:
        """The name for pip."""
        return self.pip_name or self.package


OWN = Declaration("")
"""Declaration of a user's own engine."""


@dataclass(frozen=True)
class Availability:
    """Availability of an engine here: its version, or the command that installs it; the fault of a
    broken one."""

    name: str
    version: str | None
    install: str
    broken: str = ""

    @property
    def absence(self) -> str:
        """The reason why it does not run here."""
        return self.broken or f"not installed; {self.install}"


def declaration(name: str) -> Declaration:
    """Return the declaration of an engine's folder; a user's own engine has its adapter alone.
    Raises EngineError, with near names, for an unknown name."""
    if name not in ENGINES:
        own_engine(name, ENGINES)
        return OWN
    return cast(Declaration, importlib.import_module(ENGINES[name], __package__).DECLARATION)


def apart(names: Iterable[str]) -> bool:
    """True if any of the engines may end its process; so may all of users."""
    return any(name not in ENGINES or declaration(name).apart for name in names)


def usual() -> list[str]:
    """List the default engines: the engines of a plain install."""
    return [name for name in ENGINES if not declaration(name).extra]


def engine(name: str) -> Engine:
    """Return the engine of that name: shipped, or of an installed package that has it in its entry
    points; or of the spelling `package.module:ATTRIBUTE`, known by its own name from then on.

    Raises
    ------
    EngineError
        No such engine (the message suggests near names), or its package is not installed, or cannot
        be imported here; or the object is no engine, or has the name of another.
    """
    if name not in ENGINES:
        return own_engine(name, ENGINES)
    return cast(Engine, _loaded(name, "engine"))


def capability(name: str, what: Capability) -> object:
    """Return a capability of an engine beside its adapter.

    Raises
    ------
    EngineError
        As `engine`, and where the engine lacks it: the message lists the engines that have it.
    """
    if what not in declaration(name).offers:
        others = " or ".join(offering(what))
        cure = f"use {others}" if others else "no engine has one"
        raise EngineError(f"engine {name}: it has no {what}; {cure}")
    return _loaded(name, what)


def offering(what: Capability) -> list[str]:
    """List the engines with the capability, installed or not."""
    return [name for name in ENGINES if what in declaration(name).offers]


def _loaded(name: str, part: str) -> object:
    own = declaration(name)
    if part == "engine" and not all(map(find_spec, own.roots)):  # sooner than by its imports
        raise _not_installed(name)
    try:
        module = importlib.import_module(f"{ENGINES[name]}.{part}", __package__)
    except Exception as error:
        _refuse_broken(name, own)
        if not isinstance(error, ImportError | AttributeError):
            raise
        # A half-removed package leaves of an engine a module that lacks attributes.
        lacking = error.name if isinstance(error, ImportError) else _module_name(error.obj)
        if (lacking or own.package).split(".")[0] not in own.roots:
            raise
        raise _not_installed(name) from None
    return getattr(module, part.upper())


def _not_installed(name: str) -> EngineError:
    return EngineError(f"engine {name}: not installed; {install_command(name)}")


def _refuse_broken(name: str, own: Declaration) -> None:
    """Import the package of an engine by itself: a failure there is no fault of crankcheck. Raises
    BrokenEngineError for an installed package that fails."""
    package = own.package
    try:
        importlib.import_module(package)
    except Exception as error:
        absent = isinstance(error, ModuleNotFoundError) and f"{error.name}."
        if absent and any(f"{name}.".startswith(absent) for name in (package, *own.needs)):
            return  # the importing code says what to do
        why = f"{type(error).__name__}: {str(error).partition(chr(10))[0][:300]}"
        named = [f"{key}={value}" for key, value in os.environ.items() if package.upper() in key]
        cure = f"check {', '.join(named)}, or install it again" if named else "install it again"
        raise BrokenEngineError(
            f"engine {name}: {package} can not be imported here: {why}; {cure}: "
            f"{install_command(name)}"
        ) from None


def _module_name(value: object) -> str:
    """Return the name of a module, or of the module of a class or value; empty if unknown."""
    if isinstance(value, ModuleType):
        return value.__name__
    home = getattr(value, "__module__", None) or type(value).__module__
    return "" if value is None else str(home)


def install_command(name: str) -> str:
    """Return the command that installs an engine's package, and the systems that have wheels."""
    own = declaration(name)
    what = f"'crankcheck[{name}]'" if own.extra else own.distribution
    only = f" (wheels: {own.wheels})" if own.wheels else ""
    return f"{sys.executable} -m pip install {what}{only}"


def other_version(name: str) -> str:
    """Return a warning of a version of an engine that was never compared; empty for a tried one."""
    own = declaration(name)
    if not own.tried or (found := engine(name).version()).startswith(own.tried):
        return ""
    return (
        f"{name} {found}: tried with {own.tried}; defaults of its settings and instants of its "
        f"velocities and forces may differ: see `crankcheck engines check {name}`"
    )


def available() -> tuple[Availability, ...]:
    """List all shipped engines, installed or not."""
    return tuple(_available(name, install_command(name), BrokenEngineError) for name in ENGINES)


def applying(what: str) -> list[str]:
    """List the installed shipped engines that have "beams" of their own, "gears", "cams", ...."""
    flag = f"applies_{what}"
    return [one.name for one in available() if one.version and getattr(engine(one.name), flag)]


def brought() -> tuple[Availability, ...]:
    """List the engines of other installed packages, by their entry points; an unusable engine has
    its fault in words."""
    names = dict.fromkeys(point.name for point in installed())
    return tuple(_available(name, "", EngineError) for name in names)


def _available(name: str, install: str, told: type[EngineError]) -> Availability:
    """Return the availability of an engine; errors of the kind ``told`` give its fault in words."""
    try:
        return Availability(name, engine(name).version(), install)
    except EngineError as error:
        return Availability(name, None, install, str(error) if isinstance(error, told) else "")
