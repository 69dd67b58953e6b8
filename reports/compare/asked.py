"""Whether a run is the one that was asked for, by what it says of itself."""

from __future__ import annotations

import math
from dataclasses import fields

from models.motion import State
from models.scene import Scene
from sim.check import SAME
from sim.engine import Run, Settings, SettingValue, Setup

ROUNDING = 1e-12
"""A relative difference that is rounding: of a number that is worked out in another order."""


def not_asked_for(run: Run, setup: Setup, holds: Settings, scene: Scene, state: State) -> list[str]:
    """What the run says of itself that is not as asked for, field by field.

    ``holds`` is what an engine that was given the settings says that it holds of them; ``state`` is
    what the run was to start from.
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
    return [*texts, *(told or held), *_elsewhere(run, scene, state)]


def _elsewhere(run: Run, scene: Scene, state: State) -> list[str]:
    """The bodies whose first logged place is not that of the state."""
    motion = run.motion
    if motion is None or not motion.time_s.size:
        return []
    first = motion.state()
    size = max(scene.longest_m, *(math.hypot(*place) for place in state.position.values()))
    turns = {
        name: abs(math.remainder(first.theta[name] - angle, math.tau))
        for name, angle in state.theta.items()
        if name in first.theta
    }
    moves = {
        name: math.dist(first.position[name], place) / size
        for name, place in state.position.items()
        if name in first.position
    }
    slides = {
        name: abs(first.displacement[name] - place) / size
        for name, place in state.displacement.items()
        if name in first.displacement
    }
    far = {
        f"{kind} {name}": (by, unit)
        for kind, unit, each in (
            ("link", "rad", turns),
            ("point", "L", moves),
            ("slider", "L", slides),
        )
        for name, by in each.items()
        if by > SAME
    }
    return [f"start: {body} begins {by:.2g} {unit} off" for body, (by, unit) in far.items()]


def _words(name: str, asked: object, found: object) -> str:
    return f"{name}: asked for {_short(asked)}, the run has {_short(found)}"


def _short(value: object) -> str:
    return "none" if value is None else f"{value:.9g}" if isinstance(value, float) else repr(value)


def _equal(found: SettingValue | None, asked: SettingValue) -> bool:
    if found is None or isinstance(found, str) or isinstance(asked, str):
        return found == asked
    return math.isclose(found, asked, rel_tol=ROUNDING)
