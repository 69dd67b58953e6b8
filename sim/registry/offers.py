"""Optional parts of an engine beside its adapter: knobs, snippets, recipes, remedies, a window."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal, Protocol, cast

from models.errors import EngineError
from models.motion import State
from models.scene import Scene
from sim.engine import Drive, Profile, Settings, SettingValue
from sim.registry import capability, declaration, offering

Values = Settings
Work = Callable[[Settings], float]
"""Model of the time of a step [microseconds] by the complete settings; it gives the same number at
every call. Two timings of one thing differ by a few per cent, so that a search that ranks settings
by them finds others at every run. The model counts the operations of a step; the time of each was
measured once, and fitted, with ``python -m benchmarks.step_cost``."""


@dataclass(frozen=True)
class Knob:
    """A setting, or several that go together, and the values to choose from.

    Numbers are in their order, and neighbours are expected to do similar things; words have no
    order. ``sets`` names the settings if there are several, or another.
    """

    name: str
    values: tuple[SettingValue, ...]
    sets: tuple[str, ...] = ()

    @property
    def targets(self) -> tuple[str, ...]:
        """Settings that take the value."""
        return self.sets or (self.name,)

    @property
    def ordered(self) -> bool:
        """True if the values are numbers."""
        return not isinstance(self.values[0], str)

    def through(self, *values: SettingValue) -> Knob:
        """Return the knob with more values among its own."""
        every = dict.fromkeys((*self.values, *values))
        return replace(self, values=tuple(sorted(every, key=float) if self.ordered else every))


@dataclass(frozen=True)
class SearchSpace:
    """Knobs of an engine, settings to try first (a profile's settings remain where they name none),
    and the model of the time of a step in a scene assembled at a state. The step itself is no knob:
    the search finds the coarsest that reaches the target with each set of values."""

    knobs: tuple[Knob, ...]
    starts: tuple[Values, ...]
    work: Callable[[Scene, State], Work]

    def around(self, profile: Settings) -> SearchSpace:
        """Return the space with the profile first of its starts, and the values of all starts on
        the knobs."""
        first = {knob.name: profile[knob.targets[0]] for knob in self.knobs}
        starts = tuple({**first, **start} for start in ({}, *self.starts))
        knobs = tuple(k.through(*(start[k.name] for start in starts)) for k in self.knobs)
        return replace(self, knobs=knobs, starts=starts)

    def settings(self, profile: Settings, values: Values) -> dict[str, SettingValue]:
        """Return the complete settings: the profile's, with the knobs' values in their place."""
        complete = dict(profile)
        for knob in self.knobs:
            complete |= dict.fromkeys(knob.targets, values[knob.name])
        return complete


def rungs(low: float, high: float, ratio: float) -> tuple[float, ...]:
    """Return round numbers from ``low`` to ``high``, each about ``ratio`` times the one before."""
    count = round(math.log(high / low) / math.log(ratio))
    exact = (low * (high / low) ** (k / count) for k in range(count + 1))
    return tuple(dict.fromkeys(float(f"{value:.2g}") for value in exact))


def search_space(engine: str) -> SearchSpace:
    """Return the search space of an engine. Raises EngineError where it has none."""
    return cast(SearchSpace, capability(engine, "knobs"))


PERIOD_S = 2.0 * math.pi / 10.0
"""Time of a turn at 10 rad/s, the speed of most shipped scenes."""


@dataclass(frozen=True)
class Stepping:
    """Stepping of a crank of ``period_s`` [s]: ``dt_s`` [s] at a time, and with ``substeps`` of it
    in each frame of a program; 0 without frames."""

    period_s: float
    dt_s: float
    substeps: int = 0

    @property
    def speed_rad_s(self) -> float:
        return 2.0 * math.pi / self.period_s

    @property
    def steps_per_turn(self) -> float:
        return self.period_s / self.dt_s

    @property
    def speed(self) -> str:
        """The crank's speed, in words."""
        return f"{self.speed_rad_s:.6g} rad/s"

    @property
    def per_turn(self) -> str:
        """The number of steps in a turn, in words."""
        return f"{self.steps_per_turn:g}"

    @property
    def frame(self) -> str:
        """The length of a frame, in words."""
        return f"{self.dt_s * self.substeps:.6g} s"

    def scaled_by_speed(self, step: str) -> str:
        """Say what ``step`` is at another speed, without the end of the sentence."""
        return (
            f"{self.per_turn} steps a turn of a crank at {self.speed}. At another speed: {step} = "
            f"2 pi / ({self.per_turn} speed)"
        )

    def scaled_in_frames(self, them: str) -> str:
        """Say that a faster crank needs more of ``them``, without the end of the sentence."""
        return (
            f"A crank at {self.speed} has {self.per_turn} of {them} in a turn; a faster one needs "
            "more of them in a frame, in proportion"
        )

    def counted_in(self, drive: Drive) -> Literal["turns", "frames", "nothing"]:
        """Return the whole that its steps divide: no speed sets their length in free motion."""
        if drive == "free":
            return "nothing"
        return "frames" if self.substeps else "turns"


@dataclass(frozen=True)
class SnippetWriter:
    """Writer of the snippets of an engine (see `snippet`).

    ``language`` is the language for colouring, ``shipped`` the profile of the engine's own
    defaults. ``lines`` gets the complete settings, the defaults, the stepping, the drive, and
    lines of comment to begin with.
    """

    language: str
    shipped: Profile
    lines: Callable[[Settings, Settings, Stepping, Drive, Sequence[str]], list[str]]

    def write(
        self, settings: Settings, stepping: Stepping, drive: Drive, head: Sequence[str]
    ) -> str:
        """Write a snippet, with defaults for omitted ``settings``."""
        defaults = self.shipped.values
        complete = defaults | dict(settings)
        return "\n".join(self.lines(complete, defaults, stepping, drive, head)) + "\n"


def snippet_writer(engine: str) -> SnippetWriter:
    """Return the snippet writer of an engine. Raises EngineError where it has none."""
    return cast(SnippetWriter, capability(engine, "snippet"))


WIDTH = 96
"""Most characters in a line of a snippet."""
INSET = "  "
"""Indent of a line of code within a comment: it keeps its own line."""


def alone(whole: str, lines: Sequence[str]) -> list[str]:
    """Return paragraphs of a comment: lines that would change the rest of a user's model."""
    title = f"ONLY TO MEASURE AS WE DID, in a {whole} with nothing else in it:"
    return [title, *(INSET + line for line in lines)] if lines else []


def comment(*paragraphs: str, xml: bool = False) -> list[str]:
    """Return the paragraphs as comment lines of Python, or as one comment of XML, in which two
    hyphens may not stand together."""
    first, more, end = ("<!-- ", "     ", " -->") if xml else ("# ", "# ", "")
    lines: list[str] = []
    for paragraph in paragraphs:
        text = paragraph.replace("--", "- -").replace("--", "- -") if xml else paragraph
        wrapped = textwrap.wrap(text, WIDTH - len(more), break_on_hyphens=False)
        lines += [text] if text.startswith(INSET) else wrapped
    marked = [(more if k else first) + line for k, line in enumerate(lines)]
    return [*marked[:-1], marked[-1] + end] if marked else []


def snippet(
    engine: str,
    settings: Settings,
    steps_per_turn: float,
    period_s: float = PERIOD_S,
    *,
    drive: Drive = "prescribed",
    head: Sequence[str] = (),
) -> str:
    """Write the lines that set the requested ``settings``, at a step of period over steps.

    The engine's own defaults are left out. The active lines are the mechanism's needs, set on the
    mechanism alone wherever the engine can, so that the rest of a user's model runs as before with
    that step and integrator; the other settings of measured runs, which change more, are in a
    comment. ``period_s`` is the driver's [s]; the text says how its numbers change with the speed.
    Raises EngineError where the engine has no writer.
    """
    stepping = Stepping(period_s, period_s / steps_per_turn)
    return snippet_writer(engine).write(settings, stepping, drive, head)


def frame_snippet(
    engine: str, settings: Settings, stepping: Stepping, head: Sequence[str] = ()
) -> str:
    """Write `snippet` for a program with frames: the number and length of steps in a frame."""
    return snippet_writer(engine).write(settings, stepping, "prescribed", head)


class ForceRecipe(Protocol):
    """Writer of an engine's recipe: a standalone Python program, independent of crankcheck, to
    read, to copy, and to run, which tests do."""

    def __call__(self, scene: Scene, state: State, settings: Settings, dt_s: float) -> str:
        """Write the program: it holds ``scene`` from ``state`` on, with a complete set of settings
        and a step [s], turns the driver once, and prints the forces as lines of numbers.

        The first line names the columns: ``time_s``, then ``POINT.BODY.x_n`` and ``POINT.BODY.y_n``
        (the force of the pin at POINT on BODY [N], in the ground's frame) for a pin that closes a
        loop, or for more pins, then ``torque_n_m`` (of the drive on the driver). The forces act at
        these times. Comments give reasons. Raises EngineError for a scene that the engine cannot
        hold, or that the recipe does not cover.
        """
        ...


def written(rows: Mapping[str, object] | Iterable[object]) -> str:
    """Write a dict or a list of a recipe, an entry a line."""
    if isinstance(rows, Mapping):
        (first, last), entries = "{}", [f"{key!r}: {row!r}" for key, row in rows.items()]
    else:
        (first, last), entries = "[]", [repr(row) for row in rows]
    return (
        "\n".join([first, *(f"    {each}," for each in entries), last]) if entries else first + last
    )


def force_recipe(
    engine: str, scene: Scene, state: State, settings: Settings, steps_per_turn: float
) -> str:
    """Write the recipe of an engine. Raises EngineError where it has none, and as `ForceRecipe`."""
    write = cast(ForceRecipe, capability(engine, "force_recipe"))
    return write(scene, state, settings, scene.driver.law.period_s / steps_per_turn)


Remedies = Callable[[Scene, State, Settings], Sequence[Settings]]
"""Settings that may repair a failing set, for a scene assembled at a state; the cheapest first."""


def remedies(engine: str, scene: Scene, state: State, settings: Settings) -> Sequence[Settings]:
    """Return an engine's remedies; none if it has none. Raises EngineError as `capability`."""
    if "remedies" not in declaration(engine).offers:
        return ()
    return cast(Remedies, capability(engine, "remedies"))(scene, state, settings)


Viewer = Callable[[Scene, State], None]
"""Opens a scene, assembled at a state, in a window; returns when that is closed."""


def viewer() -> Viewer:
    """Return the viewer of the first installed engine that has one. Raises EngineError if there is
    none, with the message of the last one."""
    missing = EngineError("no engine has a window of its own")
    for name in offering("viewer"):
        try:
            return cast(Viewer, capability(name, "viewer"))
        except EngineError as error:
            missing = error
    raise missing
