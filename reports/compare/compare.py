"""Compare a run with the reference: total, geometric, drive and closure errors, rates and all.

Total error: the reference at the commanded time. Geometric error: the reference at the crank angle
that the engine logged, so that a crank which lags shows in the drive and not in the geometry.

What a run is beside (`Beside`) names the modules that compare it, which are loaded when they are
needed.
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
        """The errors of a run, with those that the modules before have found."""
        ...

    def places(self, beside: Beside) -> list[Error]:
        """Drive or phase errors, total errors of place and gaps alone."""
        ...


def compare(beside: Beside | None) -> Errors | None:
    """The errors of a run, a row per quantity, body, source and kind; None where it logged nothing.

    Samples that are not finite, and bodies or pins of the scene that a run lacks, give errors
    that are not finite; what a user's own log lacks gives none.
    """
    errors: Errors | None = None
    for module in _modules(beside):
        assert beside is not None
        errors = module.compared(beside, errors)
    return errors


def places(beside: Beside | None) -> list[Error]:
    """Drive error, total errors of place and gaps alone; none of a run that logged nothing."""
    if beside is None:
        return []
    return [row for module in _modules(beside) for row in module.places(beside)]


def _modules(beside: Beside | None) -> Iterator[Comparing]:
    """The modules that compare a run."""
    for name in beside.compared_by if beside else ():
        yield cast(Comparing, import_module(name, __package__))


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
