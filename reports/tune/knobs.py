"""What of an engine's settings is searched, and what a step costs with them: one entry an engine.

The step itself is not among the knobs: the search finds, for each set of values, the coarsest
step that reaches the target (`reports.tune.coarsest`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from models.errors import CrankcheckError
from models.scene import Scene
from reports.tune.cost import Settings, Work, mujoco_work, pymunk_work
from sim.engine import SettingValue

Values = Mapping[str, SettingValue]


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
class Space:
    """The knobs of an engine, settings worth a look before anything is guessed (what they do not
    name is left as the profile has it), and the model of what a step takes."""

    knobs: tuple[Knob, ...]
    starts: tuple[Values, ...]
    work: Callable[[Scene], Work]

    def around(self, profile: Settings) -> Space:
        """The space with the profile first of its starts, and the values of all starts on the
        knobs."""
        first = {knob.name: profile[knob.targets[0]] for knob in self.knobs}
        starts = tuple({**first, **start} for start in ({}, *self.starts))
        knobs = tuple(k.through(*(start[k.name] for start in starts)) for k in self.knobs)
        return replace(self, knobs=knobs, starts=starts)

    def settings(self, profile: Settings, values: Values) -> dict[str, SettingValue]:
        """The complete settings: those of the profile with the knobs' values in their place."""
        found = dict(profile)
        for knob in self.knobs:
            found |= dict.fromkeys(knob.targets, values[knob.name])
        return found


def rungs(low: float, high: float, ratio: float, digits: int = 2) -> tuple[float, ...]:
    """Round numbers from ``low`` to ``high``, each about ``ratio`` times the one before."""
    count = round(math.log(high / low) / math.log(ratio))
    exact = (low * (high / low) ** (k / count) for k in range(count + 1))
    return tuple(dict.fromkeys(float(f"{value:.{digits}g}") for value in exact))


SPACES: Mapping[str, Space] = {
    "mujoco": Space(
        knobs=(
            Knob("integrator", ("RK4", "implicitfast", "Euler", "implicit", "discrete")),
            # MuJoCo itself takes 2 steps for anything shorter (refsafe).
            Knob("solref_timeconst_steps", rungs(2.0, 20.0, 1.06)),
            # Above 5 pins come apart slowly, over tens of turns, which no short run sees.
            Knob("solref_dampratio", rungs(0.2, 5.0, 1.08)),
            Knob(
                "solimp",
                (0.9, 0.95, 0.98, 0.99, 0.995, 0.998, 0.999, 0.9995, 0.9998, 0.9999),
                sets=("solimp_dmin", "solimp_dmax"),
            ),
            Knob("iterations", (1, 2, 3, 5, 10, 20, 50, 100)),
        ),
        starts=(
            {"integrator": "implicitfast", "solref_timeconst_steps": 2.0},
            {"integrator": "Euler", "solref_timeconst_steps": 2.0},
        ),
        work=mujoco_work,
    ),
    "pymunk": Space(
        knobs=(
            Knob("iterations", tuple(int(x) for x in rungs(1.0, 200.0, 1.1))),
            Knob(
                "error_bias",
                (0.0, 1e-9, 1e-6, 1e-4, 0.0017970074436457143, 0.01, 0.03, 0.1, 0.2, 0.4, 0.7, 1.0),
            ),
            Knob("lines", ("exact", "groove")),
        ),
        starts=(
            {"iterations": 10},
            {"iterations": 10, "error_bias": 0.0017970074436457143, "lines": "groove"},
        ),
        work=pymunk_work,
    ),
}
"""Engine to space. To have an engine tuned, add an entry, and its model to `reports.tune.cost`;
solvers other than MuJoCo's Newton are left out, as their passes depend on the state, not on the
settings alone, and save nothing (PGS: 7 % of a step with 1 pass, and -15 % with 10)."""


def space_of(engine: str) -> Space:
    """The space of an engine. Raises CrankcheckError where nobody has written one."""
    if engine not in SPACES:
        raise CrankcheckError(f"tune {engine}: no knobs are known; there are {', '.join(SPACES)}")
    return SPACES[engine]
