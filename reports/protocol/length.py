"""Length and step of a run, as requested; and the clock that both are counted by."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from models.scene import Scene
from reports.compare.compare import SETTLING
from reports.output.numbers import duration

Springs = Literal["plain", "corrected", "beam"]
"""Springs between segments: with the beam's stiffness over a segment, or such that the chain has
the sag of the beam; or none, where the engine has beams of its own, as many elements long."""
SEGMENTS = 16
"""Default number of segments of an elastic link."""


LEAST_STEPS = 2 * SETTLING
"""Least steps of a verification. Measured: no shipped scene fails for shortness alone in so
many."""


@dataclass(frozen=True)
class GivenAs:
    """Engines' model of the elastic links of a scene; ``words`` distinguish lines of a sweep, and
    are empty for a rigid scene."""

    segments: int = SEGMENTS
    springs: Springs = "plain"
    words: str = ""


@dataclass(frozen=True)
class Length:
    """The step [s], or the steps in a turn, and turns or a duration [s]; None leaves each to the
    scene. Every ``every``-th step is logged, and there are at least ``least``."""

    dt_s: float | None = None
    steps_per_turn: float | None = None
    turns: float | None = None
    duration_s: float | None = None
    every: int = 1
    least: int = LEAST_STEPS


@dataclass(frozen=True)
class Planned:
    """A run of a scene in so many ``steps`` of ``dt_s`` [s], before an engine is chosen."""

    scene: Scene
    dt_s: float
    steps: int
    given_as: GivenAs = field(default_factory=GivenAs)
    with_forces: bool = False
    tolerance: Mapping[str, float] = field(default_factory=dict)

    @property
    def duration_s(self) -> float:
        return self.dt_s * self.steps


@dataclass(frozen=True)
class Clock:
    """The unit of time of a drive; ``per`` follows numbers of it, "" for turns, ``unit`` follows
    lengths of runs."""

    name: str
    per: str
    unit: str

    def short(self, dt_s: float, steps_per_turn: float) -> str:
        """The step of a run, in a few words."""
        return f"{steps_per_turn:g} a turn"

    def long(self, dt_s: float, steps: int, steps_per_turn: float) -> str:
        """The length of a run of so many steps, in words."""
        turns = steps / steps_per_turn
        return f"{steps_per_turn:.6g} steps a turn, {turns:.6g} turn{'s' * (turns != 1.0)}"

    def step(self, row: Mapping[Any, Any]) -> str:
        """The step of a stored cell, in words: so many in a turn."""
        return f"{row['steps_per_turn']:g}"

    def lasts(self, turns: float) -> str:
        """The length of a run, in words that follow its name."""
        return f", {turns:g} turn{'' if turns == 1.0 else 's'}"

    def words(self, dt_s: float, steps_per_turn: float, turns: float) -> tuple[str, str]:
        """The step and the length of a run, in words."""
        return f"{steps_per_turn:.4g} steps a turn", f"{turns:.4g} turns"

    def period_s(self, driver_s: float) -> float:
        """The period [s], for a driver whose period is ``driver_s``."""
        return driver_s


class Seconds(Clock):
    """The clock of free motion, which has no turns."""

    def short(self, dt_s: float, steps_per_turn: float) -> str:
        return f"dt {dt_s:g} s"

    def long(self, dt_s: float, steps: int, steps_per_turn: float) -> str:
        return f"{steps} steps, {steps * dt_s:.6g} s"

    def step(self, row: Mapping[Any, Any]) -> str:
        return duration(row["dt_s"])

    def lasts(self, turns: float) -> str:
        return f" for {turns:g} s"

    def words(self, dt_s: float, steps_per_turn: float, turns: float) -> tuple[str, str]:
        return f"dt {dt_s:.4g} s", f"free for {turns:.4g} s"

    def period_s(self, driver_s: float) -> float:
        return 1.0


TURNS, SECONDS = Clock("turn", "", "turns"), Seconds("second", "/s", "s")
FACETS = Clock("turn", "", "facets")
"""The clock of cams by contact, whose steps are their facets."""
_CLOCKS = {"free": SECONDS}


def clock_of(drive: str) -> Clock:
    """The clock of a drive."""
    return _CLOCKS.get(drive, TURNS)


def common_clock(drives: Iterable[str]) -> Clock:
    """The clock of several drives: turns where one drive has them."""
    return SECONDS if {clock_of(drive) for drive in drives} <= {SECONDS} else TURNS
