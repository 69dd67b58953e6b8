"""What an engine may offer beside its adapter: knobs, snippets, recipes, remedies, a window."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Literal, Protocol, cast

from models.errors import EngineError
from models.motion import State
from models.scene import Scene
from sim.engine import Drive, Settings, SettingValue
from sim.registry import capability, declaration, offering

Values = Settings
Work = Callable[[Settings], float]
"""From complete settings to the time of a step [microseconds]: a model, which gives the same number
at every call. Two timings of one thing differ by a few per cent, so that a search which ranks
settings by them finds others at every run. The model counts what the engine does in a step; what
each count takes was measured once, and fitted, with ``python -m benchmarks.step_cost``."""


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
    assembled at a state. The step itself is no knob: the search finds the coarsest that reaches the
    target with each set of values."""

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


PERIOD_S = 2.0 * math.pi / 10.0
"""A turn at 10 rad/s, the speed of most shipped scenes."""


@dataclass(frozen=True)
class Stepping:
    """How a crank of ``period_s`` [s] is stepped: ``dt_s`` [s] at a time, and where a program has
    frames ``substeps`` of that in each of them; 0 where it has none."""

    period_s: float
    dt_s: float
    substeps: int = 0

    @property
    def speed_rad_s(self) -> float:
        return 2.0 * math.pi / self.period_s

    @property
    def steps_per_turn(self) -> float:
        return self.period_s / self.dt_s

    def counted_in(self, drive: Drive) -> Literal["turns", "frames", "nothing"]:
        """What its steps are a part of: of what nothing drives no speed says how long they are."""
        if drive == "free":
            return "nothing"
        return "frames" if self.substeps else "turns"


@dataclass(frozen=True)
class SnippetWriter:
    """What writes the snippets of an engine.

    ``language`` is what a page may colour them as; ``write`` is given the settings, the
    stepping, the drive, and lines of comment to begin with (see `snippet`).
    """

    language: str
    write: Callable[[Settings, Stepping, Drive, Sequence[str]], str]


def snippet_writer(engine: str) -> SnippetWriter:
    """That of an engine. Raises EngineError where it has none."""
    return cast(SnippetWriter, capability(engine, "snippet"))


def comment(paragraphs: Sequence[str], width: int) -> list[str]:
    """The paragraphs as comment lines of Python, at most so wide."""
    lines: list[str] = []
    for paragraph in paragraphs:
        wrapped = textwrap.wrap(paragraph, width - 2, break_on_hyphens=False)
        lines += [f"# {line}" for line in wrapped]
    return lines


def snippet(
    engine: str,
    settings: Settings,
    steps_per_turn: float,
    period_s: float = PERIOD_S,
    *,
    drive: Drive = "prescribed",
    head: Sequence[str] = (),
) -> str:
    """The lines that set ``settings`` (those asked for), at a step of period over steps.

    What is the engine's own default is left out. In force is what the mechanism needs, on the
    mechanism alone wherever the engine can, so that what else a user's model holds goes on as it
    did with that step and integrator; the settings that measured runs had besides, to which that
    does not apply, stand in a comment. ``period_s`` is that of the driver [s]; the text says how
    its numbers change with the speed. Raises EngineError where the engine has no writer.
    """
    stepping = Stepping(period_s, period_s / steps_per_turn)
    return snippet_writer(engine).write(settings, stepping, drive, head)


def frame_snippet(
    engine: str, settings: Settings, stepping: Stepping, head: Sequence[str] = ()
) -> str:
    """As `snippet`, for a program that has frames: how many steps of which length are one."""
    return snippet_writer(engine).write(settings, stepping, "prescribed", head)


class ForceRecipe(Protocol):
    """What writes the recipe of an engine: a standalone Python program, which knows nothing of
    crankcheck, to read, to copy, and to run, which tests do."""

    def __call__(self, scene: Scene, state: State, settings: Settings, dt_s: float) -> str:
        """The program: it holds ``scene`` from ``state`` on, with a complete set of settings and a
        step [s], turns the driver once, and prints what acts as lines of numbers with commas.

        The first line names the columns: ``time_s``, then ``POINT.BODY.x_n`` and ``POINT.BODY.y_n``
        (the force of the pin at POINT on BODY [N], in the ground's frame) for a pin that closes a
        loop, or for more pins, then ``torque_n_m`` (of the drive on the driver). Times are those at
        which the forces act. Comments say why each line is as it is. Raises EngineError for a scene
        that the engine cannot hold, or that the recipe does not cover.
        """
        ...


def force_recipe(
    engine: str, scene: Scene, state: State, settings: Settings, steps_per_turn: float
) -> str:
    """The recipe of an engine. Raises EngineError where it has none, and as `ForceRecipe`."""
    write = cast(ForceRecipe, capability(engine, "force_recipe"))
    return write(scene, state, settings, scene.driver.law.period_s / steps_per_turn)


Remedies = Callable[[Scene, State, Settings], Sequence[Settings]]
"""Settings to put in the place of some of a complete set that failed, for a scene that is assembled
at a state; those that cost least first."""


def remedies(engine: str, scene: Scene, state: State, settings: Settings) -> Sequence[Settings]:
    """Those of an engine; none where it offers none. Raises EngineError as `capability` does."""
    if "remedies" not in declaration(engine).offers:
        return ()
    return cast(Remedies, capability(engine, "remedies"))(scene, state, settings)


Viewer = Callable[[Scene, State], None]
"""Opens a scene, assembled at a state, in a window; returns when that is closed."""


def viewer() -> Viewer:
    """The viewer of the first engine that has one and is installed. Raises EngineError where
    there is none: the message is that of the last one."""
    missing = EngineError("no engine has a window of its own")
    for name in offering("viewer"):
        try:
            return cast(Viewer, capability(name, "viewer"))
        except EngineError as error:
            missing = error
    raise missing
