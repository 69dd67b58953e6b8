"""Is an object an engine? What it lacks is told before anything is asked of it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import MISSING, fields
from typing import Any, get_args

from models.errors import EngineError, shown
from sim.engine import Engine, ForcesOf, Placing, Profile, Setting

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
