"""Whether a run is the one that was asked for, by what it says of itself."""

from __future__ import annotations

import math
from dataclasses import fields

from sim.engine import Run, Settings, SettingValue, Setup

SAME = 1e-12
"""A relative difference that is rounding: of a number that is worked out in another order."""


def not_asked_for(run: Run, setup: Setup, holds: Settings) -> list[str]:
    """What the run says of itself that is not as asked for, field by field.

    ``holds`` is what an engine that was given the settings says that it holds of them.
    """
    texts = [
        _words(field.name, getattr(setup, field.name), getattr(run, field.name))
        for field in fields(setup)
        if field.name != "asked" and getattr(run, field.name) != getattr(setup, field.name)
    ]
    told = [
        _words(f"setting {name}", setup.asked.get(name), run.asked.get(name))
        for name in dict.fromkeys([*setup.asked, *run.asked])
        if name not in setup.asked or name not in run.asked or setup.asked[name] != run.asked[name]
    ]
    held = [
        _words(f"setting {name}, as the engine holds it", value, run.settings.get(name))
        for name, value in holds.items()
        if run.motion is not None and not _equal(run.settings.get(name), value)
    ]
    return [*texts, *(told or held)]


def _words(name: str, asked: object, found: object) -> str:
    return f"{name}: asked for {_short(asked)}, the run has {_short(found)}"


def _short(value: object) -> str:
    return "none" if value is None else f"{value:.9g}" if isinstance(value, float) else repr(value)


def _equal(found: SettingValue | None, asked: SettingValue) -> bool:
    if found is None or isinstance(found, str) or isinstance(asked, str):
        return found == asked
    return math.isclose(found, asked, rel_tol=SAME)
