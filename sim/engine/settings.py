"""Settings of a run: a profile's, overridden one by one; and engines that come with settings."""

from collections.abc import Callable, Mapping, Sequence
from types import ModuleType
from typing import Any

from models.errors import EngineError, nearest, shown
from models.motion import State
from models.scene import Scene
from sim.engine import Drive, Engine, Profile, Session, Settings, SettingValue


class SettingError(EngineError):
    """A setting that an engine lacks, or a value that it does not take."""


def profile_of(engine: Engine, name: str) -> Profile:
    """Return the profile of that name. Raises EngineError that lists the profiles."""
    if name in engine.profiles:
        return engine.profiles[name]
    raise EngineError(
        f"profile {name!r}: {engine.name} has none of that name; use {' or '.join(engine.profiles)}"
    )


def resolved(profile: Profile, overrides: Settings | None) -> dict[str, SettingValue]:
    """Return all settings of a profile, with some replaced.

    Raises
    ------
    SettingError
        A setting that the engine lacks, or a value of another kind than the profile's.
    """
    settings = profile.values
    for name, value in (overrides or {}).items():
        if name not in settings:
            near = nearest(name, settings, 1, 0.6)
            hint = f"did you mean {near[0]}? " if near else ""
            raise SettingError(
                f"setting {name!r}: {profile.engine} has none of that name; {hint}"
                f"it has {', '.join(settings)}"
            )
        settings[name] = _like(name, value, settings[name])
    return settings


def check_choices(settings: Settings, choices: Mapping[str, tuple[str, ...]]) -> None:
    """Refuse a setting outside its choices. Raises SettingError that lists them."""
    for name, allowed in choices.items():
        if settings[name] not in allowed:
            raise SettingError(
                f"setting {name}: found {shown(settings[name])}; use {' or '.join(allowed)}"
            )


def check_ranges(settings: Settings, ranges: Mapping[str, tuple[float, float]]) -> None:
    """Refuse a number outside its range, both ends included, and text. Raises SettingError."""
    for name, (least, most) in ranges.items():
        value = settings[name]
        if isinstance(value, str) or not least <= value <= most:
            raise SettingError(
                f"setting {name}: found {shown(value)}; it takes {least:g} to {most:g}"
            )


def checker(
    choices: Mapping[str, tuple[str, ...]], ranges: Mapping[str, tuple[float, float]]
) -> Callable[[Settings], None]:
    """Return the ``check`` of an engine with these choices and ranges (`sim.engine.Engine`)."""

    def check(settings: Settings) -> None:
        check_choices(settings, choices)
        check_ranges(settings, ranges)

    return check


def as_held(
    name: str, asked: SettingValue, given: SettingValue, found: SettingValue, cause: str
) -> dict[str, SettingValue]:
    """Return a setting as ``found`` in an engine: or the one ``asked`` for if it has the value that
    was ``given`` for a cause."""
    if cause and found == given:
        return {name: asked, f"{name}_of_{cause}": found}
    return {name: found}


def _like(name: str, value: SettingValue, model: SettingValue) -> SettingValue:
    kind = type(model)
    try:
        converted = kind(value)
        exact = isinstance(value, str) or float(converted) == float(value)
    except (ValueError, OverflowError):
        exact = False
    if exact and not (kind is not str and isinstance(value, str) and not value.strip()):
        return converted
    need = {int: "a whole number", float: "a number", str: "text"}[kind]
    raise SettingError(f"setting {name}: found {shown(value)}; it takes {need}, such as {model!r}")


def shipped_engine(
    own: ModuleType,
    version: str,
    session: Callable[[Scene, State, Settings, float, Drive], Session],
    *,
    of_states: bool = False,
    **more: Any,
) -> Engine:
    """Declare an engine that comes with crankcheck, by its module of settings: all apply loads,
    constant friction and springs. Its ``VARIANTS``, if any, are profiles too. It reports forces and
    accelerations ``of_states``, or else forces of steps alone; ``more`` are other fields, by
    default without settings in seconds."""
    profiles: Sequence[Profile] = (own.AS_SHIPPED, own.TUNED, *getattr(own, "VARIANTS", ()))
    fields = {
        "in_seconds": lambda settings: (),
        "forces_of": "states" if of_states else "steps",
        "applies_loads": True,
        "applies_constant_friction": True,
        "applies_springs": True,
    }
    return Engine(
        own.TUNED.engine,
        {profile.name: profile for profile in profiles},
        version=lambda: version,
        check=own.checked,
        open=session,
        reports_accelerations=of_states,
        **{**fields, **more},
    )
