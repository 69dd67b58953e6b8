"""Compare a run with the reference: total, geometric, drive and closure errors, rates and all.

Total error: the reference at the commanded time. Geometric error: the reference at the crank angle
that the engine logged, so that a crank which lags shows in the drive and not in the geometry.

The kind of comparison (`Beside`) names the modules that compare it; they are loaded on demand.
"""

import math
from collections.abc import Iterator
from dataclasses import fields
from importlib import import_module
from typing import Protocol, cast

from models.motion import State
from models.scene import Scene
from reports.compare.beside import Beside
from reports.compare.errors import Error, Errors
from sim.engine import Run, Settings, SettingValue, Setup
from sim.run.check import SAME


class Comparing(Protocol):
    """A module that compares runs of a kind."""

    def compared(self, beside: Beside, errors: Errors | None) -> Errors:
        """Return the errors of a run, added to the errors of the modules before."""

    def places(self, beside: Beside) -> list[Error]:
        """Return drive or phase errors, total errors of position and gaps alone."""


def compare(beside: Beside | None) -> Errors | None:
    """Return the errors of a run, a row per quantity, body, source and kind; None for an empty log.

    Samples that are not finite, and bodies or pins of the scene that a run lacks, give errors that
    are not finite; gaps of a user's own log give none.
    """
    errors: Errors | None = None
    for module in _modules(beside):
        assert beside is not None
        errors = module.compared(beside, errors)
    return errors


def places(beside: Beside | None) -> list[Error]:
    """Return drive error, total errors of position and gaps alone; none for an empty log."""
    if beside is None:
        return []
    return [row for module in _modules(beside) for row in module.places(beside)]


def _modules(beside: Beside | None) -> Iterator[Comparing]:
    for name in beside.compared_by if beside else ():
        yield cast(Comparing, import_module(name, __package__))


ROUNDING = 1e-12
"""Largest relative difference by rounding, for a number computed in another order."""


def not_asked_for(run: Run, setup: Setup, holds: Settings, scene: Scene, state: State) -> list[str]:
    """Return the differences between the run's own data and the request, field by field.

    ``holds`` are the settings as an engine with the requested ones reports them; ``state`` is the
    requested start of the run.
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
    """Return the bodies whose first logged position differs from the state's."""
    motion = run.motion
    if motion is None or not motion.time_s.size:
        return []
    first = motion.state()
    size = max(scene.longest_m, *(math.hypot(*place) for place in state.position.values()))
    turned = {
        f"link {name}": abs(math.remainder(first.theta[name] - angle, math.tau))
        for name, angle in state.theta.items()
        if name in first.theta
    }
    moved = {
        f"point {name}": math.dist(first.position[name], place) / size
        for name, place in state.position.items()
        if name in first.position
    } | {
        f"slider {name}": abs(first.displacement[name] - place) / size
        for name, place in state.displacement.items()
        if name in first.displacement
    }
    far = [*((*each, "rad") for each in turned.items()), *((*each, "L") for each in moved.items())]
    return [f"start: {body} begins {by:.2g} {unit} off" for body, by, unit in far if by > SAME]


def _words(name: str, asked: object, found: object) -> str:
    return f"{name}: asked for {_short(asked)}, the run has {_short(found)}"


def _short(value: object) -> str:
    return "none" if value is None else f"{value:.9g}" if isinstance(value, float) else repr(value)


def _equal(found: SettingValue | None, asked: SettingValue) -> bool:
    if found is None or isinstance(found, str) or isinstance(asked, str):
        return found == asked
    return math.isclose(found, asked, rel_tol=ROUNDING)
