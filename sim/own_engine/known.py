"""The engines that are not ours and that this process has met, by their own names.

The name that an engine gives itself stands in results, not how it was spelled. A process that is
to run one is told the spelling (`told`), as the name says nothing of where it is.
"""

import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import MISSING, dataclass, fields
from typing import Any, get_args

from models.errors import EngineError, shown, suggestion
from sim.engine import Engine, ForcesOf, Placing, Profile, Setting
from sim.own_engine.spelling import WRITTEN, found, installed, only_one, spelling_of
from sim.own_engine.watched import watched

NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]{0,39}")
"""What is safe as the name of a file, in a table and in `--set NAME.setting=value`."""
NEEDED = tuple(
    each.name
    for each in fields(Engine)
    if each.default is MISSING and each.default_factory is MISSING
)
SAYS = (
    "reports_accelerations",
    "applies_loads",
    "applies_constant_friction",
    "applies_springs",
    "applies_beams",
)
"""What is yes or no."""
CALLED = ("version", "check", "open", "holds", "placing", "in_seconds")


def looked_over(spelling: str, value: object) -> Engine:
    """The object as an `Engine`; what it does not say of itself is as that has it.

    Raises
    ------
    EngineError
        Something else, with all that is missing or of a wrong kind.
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
    """What it says of places under the settings of its profiles."""
    for name, profile in made.profiles.items():
        settings = {each: setting.value for each, setting in profile.settings.items()}
        try:
            found: object = made.placing(settings)
        except Exception as error:  # whatever somebody else's function raises
            found = error
        if found not in get_args(Placing):
            yield (
                f"placing of profile {shown(name)} gives {_kind(found)}; give "
                f"{' or '.join(get_args(Placing))}"
            )


def _faults(given: Mapping[str, Any]) -> Iterator[str]:
    """What is of a wrong kind."""
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
    """What was found, without its contents."""
    if value is None or isinstance(value, str | int | float):
        return shown(value)
    name = type(value).__name__
    return f"{'an' if name[0] in 'AEIOUaeiou' else 'a'} {name}"


@dataclass(frozen=True)
class _KnownEngine:
    """An engine, the object that it was made of, and how that is spelled."""

    engine: Engine
    value: object
    spelling: str


_known: dict[str, _KnownEngine] = {}
_told: dict[str, str] = {}


def own_engine(text: str, ours: Collection[str]) -> Engine:
    """The engine of that name or spelling; ``ours`` are the names that are taken.

    Raises
    ------
    EngineError
        An unknown name (the message suggests near ones), an engine that is not to be found or
        imported, an object that is none, one with the name of another.
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
    """How the engines that are known here are spelled, by name: what `told` takes."""
    return {**_told, **{name: one.spelling for name, one in _known.items()}}


def told(more: Mapping[str, str]) -> None:
    """Know engines by name that another process has met; they are looked for when asked for."""
    _told.update(more)


def _met(spelling: str, ours: Collection[str]) -> Engine:
    """The engine that is spelled, once it is clear that its name is its own."""
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
