"""Users' own engines that this process has loaded, by their own names.

Results have the name that an engine gives itself, not its spelling. Another process that is to run
it needs the spelling (`told`), as the name does not locate it.
"""

import math
import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import MISSING, dataclass, fields
from typing import Any, get_args

from models.errors import EngineError, shown, suggestion
from sim.engine import Engine, ForcesOf, Placing, Precision, Profile, Setting
from sim.own_engine.watched import WRITTEN, found, installed, only_one, spelling_of, watched

NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]{0,39}")
"""Pattern safe as the name of a file, in a table and in `--set NAME.setting=value`."""
NEEDED = tuple(
    each.name
    for each in fields(Engine)
    if each.default is MISSING and each.default_factory is MISSING
)
SAYS = tuple(each.name for each in fields(Engine) if isinstance(each.default, bool))
"""Attributes that are true or false."""
CALLED = ("version", "check", "open", "holds", "placing", "in_seconds", "unreported")


def looked_over(spelling: str, value: object) -> Engine:
    """Convert an object to an `Engine`, with the defaults of that class.

    Raises
    ------
    EngineError
        Another object, with all its missing and wrong attributes.
    """
    lacking = [name for name in NEEDED if not hasattr(value, name)]
    if lacking or isinstance(value, type):
        what = f"a class, {value.__name__}" if isinstance(value, type) else _kind(value)
        without = f", which lacks {', '.join(lacking)}" if lacking else ""
        raise EngineError(
            f"engine {spelling}: found {what}{without}; give an object made with "
            f"crankcheck.engine.Engine({', '.join(NEEDED)})"
        )
    given: dict[str, Any] = {
        each.name: getattr(value, each.name) for each in fields(Engine) if hasattr(value, each.name)
    }
    if faults := list(_faults(given)):
        raise EngineError(f"engine {spelling}: {'; '.join(faults)}")
    made = Engine(**given)
    if faults := list(_faults_of_placing(made)):
        raise EngineError(f"engine {spelling}: {'; '.join(faults)}")
    return made


def _faults_of_placing(made: Engine) -> Iterator[str]:
    """Yield faults of its placing under the settings of its profiles."""
    for name, profile in made.profiles.items():
        try:
            found: object = made.placing(profile.values)
        except Exception as error:  # any error of a user's function
            found = error
        if found not in get_args(Placing):
            yield (
                f"placing of profile {shown(name)} gives {_kind(found)}; give "
                f"{' or '.join(get_args(Placing))}"
            )


def _faults(given: Mapping[str, Any]) -> Iterator[str]:
    if not isinstance(given["name"], str) or not NAME.fullmatch(given["name"]):
        yield (
            f"name is {shown(given['name'])}; give letters, digits, - and _, a letter first, "
            "40 at most"
        )
    yield from _profiles(given["profiles"])
    for name in CALLED:
        if name in given and not callable(given[name]):
            yield f"{name} is {_kind(given[name])}; give a function"
    if type(given.get("order", 1)) is not int or given.get("order", 1) < 1:
        yield f"order is {shown(given['order'])}; give a whole number above 0"
    for name in SAYS:
        if not isinstance(said := given.get(name, True), bool):
            yield f"{name} is {shown(said)}; give True or False"
    if (said := given.get("forces_of", "nothing")) not in get_args(ForcesOf):
        yield f"forces_of is {shown(said)}; give {' or '.join(get_args(ForcesOf))}"
    if (said := given.get("precision", "double")) not in get_args(Precision):
        yield f"precision is {shown(said)}; give {' or '.join(get_args(Precision))}"
    if not isinstance(said := given.get("floor", 1.0), int | float) or not 0.0 < said < math.inf:
        yield f"floor is {shown(said)}; give a number above 0"
    if not isinstance(said := given.get("no_forces", ""), str):
        yield f"no_forces is {shown(said)}; give words"


def _profiles(profiles: object) -> Iterator[str]:
    if not isinstance(profiles, Mapping) or not profiles:
        yield f"profiles is {_kind(profiles)}; give a dict of Profile by name"
        return
    for name, profile in profiles.items():
        if not isinstance(profile, Profile) or not isinstance(profile.settings, Mapping):
            yield f"profile {shown(name)} is {_kind(profile)}; give a Profile"
        else:
            for setting, value in profile.settings.items():
                if not isinstance(value, Setting):
                    yield (
                        f"profile {shown(name)}: {shown(setting)} is {_kind(value)}; give a "
                        "Setting(value, reason)"
                    )


def _kind(value: object) -> str:
    """Return the kind of a value, without its contents."""
    if value is None or isinstance(value, str | int | float):
        return shown(value)
    name = type(value).__name__
    return f"{'an' if name[0] in 'AEIOUaeiou' else 'a'} {name}"


@dataclass(frozen=True)
class _KnownEngine:
    """An engine, the object that it was made of, and its spelling."""

    engine: Engine
    value: object
    spelling: str


_known: dict[str, _KnownEngine] = {}
_told: dict[str, str] = {}


def own_engine(text: str, ours: Collection[str]) -> Engine:
    """Return the engine of that name or spelling; ``ours`` are the reserved names.

    Raises
    ------
    EngineError
        An unknown name (the message suggests near ones), an engine that cannot be found or
        imported, an object that is no engine, an engine with the name of another.
    """
    if ":" in text:
        return _met(text, ours)
    if text in _known:
        return _known[text].engine
    if text in _told:
        return _met(_told[text], ours)
    points = installed()
    if text not in (names := [point.name for point in points]):
        choices = [*ours, *dict.fromkeys(names)]
        cure = suggestion(text, choices, "there are")
        own = "" if cure.startswith("did you") else f"; one of your own is written {WRITTEN}"
        raise EngineError(f"engine {text!r}: unknown; {cure}{own}")
    point = only_one(text, points)
    engine = _met(spelling_of(point), ours)
    if engine.name != text:
        raise EngineError(
            f"engine {text}: the entry point of that name gives an engine that calls itself "
            f"{engine.name}; give both the same name"
        )
    return engine


def spellings() -> Mapping[str, str]:
    """Return the spellings of the engines known here, by name: the input of `told`."""
    return {**_told, **{name: one.spelling for name, one in _known.items()}}


def told(more: Mapping[str, str]) -> None:
    """Register the engines of another process by name; they are loaded on request."""
    _told.update(more)


def _met(spelling: str, ours: Collection[str]) -> Engine:
    """Load the engine of a spelling, and refuse a name that is another engine's."""
    for one in _known.values():
        if one.spelling == spelling:
            return one.engine
    value = found(spelling)
    engine = looked_over(spelling, value)
    if same := [name for name in ours if name.casefold() == engine.name.casefold()]:
        raise EngineError(
            f"engine {spelling}: it calls itself {engine.name}, as the {same[0]} that crankcheck "
            "has; give it another name"
        )
    before = next((o for n, o in _known.items() if n.casefold() == engine.name.casefold()), None)
    if before is None:
        _known[engine.name] = _KnownEngine(watched(spelling, engine), value, spelling)
    elif before.value is not value:
        raise EngineError(
            f"engine {spelling}: it calls itself {engine.name}, as {before.spelling} does; give "
            "one of them another name"
        )
    return _known[engine.name].engine
