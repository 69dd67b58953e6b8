"""What of an engine's settings is searched, and what a step costs with them.

The step itself is not among the knobs: the search finds, for each set of values, the coarsest
step that reaches the target. What a step costs is told by a model: the same number at every call,
unlike a clock's. A search that ranks settings by measured time finds others at every run, since two
timings of one thing differ by a few per cent. A model counts what the engine does in a step; what
each count takes was measured once, and fitted, with ::

    python -m benchmarks.step_cost

which prints the constants of the models and how far they are off.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import cast

from models.motion import State
from models.scene import Scene
from sim.engine import Settings, SettingValue
from sim.registry import capability

Values = Settings
Work = Callable[[Settings], float]
"""From complete settings to the time of a step [microseconds]."""


@dataclass(frozen=True)
class Knob:
    """A setting, or several that go together, and the values to choose from.

    Numbers stand in their order, and neighbours are taken to do similar things; of words none is
    nearer to another. ``sets`` names the settings where there are several, or another.
    """

    name: str
    values: tuple[SettingValue, ...]
    sets: tuple[str, ...] = ()

    @property
    def targets(self) -> tuple[str, ...]:
        """The settings that take the value."""
        return self.sets or (self.name,)

    @property
    def ordered(self) -> bool:
        """Whether the values are numbers."""
        return not isinstance(self.values[0], str)

    def through(self, *values: SettingValue) -> Knob:
        """The knob with more values among its own."""
        every = dict.fromkeys((*self.values, *values))
        return replace(self, values=tuple(sorted(every, key=float) if self.ordered else every))


@dataclass(frozen=True)
class SearchSpace:
    """The knobs of an engine, settings worth a look before anything is guessed (what they do not
    name is left as the profile has it), and the model of what a step takes in a scene that is
    assembled at a state."""

    knobs: tuple[Knob, ...]
    starts: tuple[Values, ...]
    work: Callable[[Scene, State], Work]

    def around(self, profile: Settings) -> SearchSpace:
        """The space with the profile first of its starts, and the values of all starts on the
        knobs."""
        first = {knob.name: profile[knob.targets[0]] for knob in self.knobs}
        starts = tuple({**first, **start} for start in ({}, *self.starts))
        knobs = tuple(k.through(*(start[k.name] for start in starts)) for k in self.knobs)
        return replace(self, knobs=knobs, starts=starts)

    def settings(self, profile: Settings, values: Values) -> dict[str, SettingValue]:
        """The complete settings: those of the profile with the knobs' values in their place."""
        complete = dict(profile)
        for knob in self.knobs:
            complete |= dict.fromkeys(knob.targets, values[knob.name])
        return complete


def rungs(low: float, high: float, ratio: float, digits: int = 2) -> tuple[float, ...]:
    """Round numbers from ``low`` to ``high``, each about ``ratio`` times the one before."""
    count = round(math.log(high / low) / math.log(ratio))
    exact = (low * (high / low) ** (k / count) for k in range(count + 1))
    return tuple(dict.fromkeys(float(f"{value:.{digits}g}") for value in exact))


def search_space(engine: str) -> SearchSpace:
    """That of an engine. Raises EngineError where it has none."""
    return cast(SearchSpace, capability(engine, "knobs"))
