"""A model that somebody wrote in an engine's own format: what an engine that reads such files makes
of one.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol, cast

from models.errors import EngineError
from models.motion import State
from models.scene import Scene
from sim.engine import Engine, Poses
from sim.registry import capability, offering

MOST_TURNS = 100
"""A joint may read so many turns either way at the start; at more, the rounding of its angle nears
what a run is held to."""


@dataclass(frozen=True)
class Tour:
    """What a model meets in the poses of its closed form: by pair of bodies or shapes the share of
    the poses in which they touch; by joint how far the way leads past its limits, in words."""

    touching: Mapping[tuple[str, str], float]
    passed: Sequence[str]


@dataclass(frozen=True)
class Disturbance:
    """Something in a model that can move a run off its closed form: ``text`` names it, with its
    joint or body; what is of one ``kind`` goes away together where a line of that name without it
    is told (``contacts`` in ``contacts-off``)."""

    kind: str
    text: str


@dataclass(frozen=True)
class Advised:
    """What the recommended settings set beside stiff loops and a tight solver: the integrator (the
    file's own where not), contacts off."""

    integrator: bool = True
    contacts_off: bool = False


class OwnModel(Protocol):
    """A model as it was read.

    Its ``scene`` has no branch, and a driver that turns at 1 rad/s from where the model is drawn,
    and whose angle is what its joint reads; ``dt_s`` is the model's own step [s].
    """

    @property
    def scene(self) -> Scene: ...

    @property
    def dt_s(self) -> float: ...

    @property
    def disturbances(self) -> Sequence[Disturbance]:
        """What can move a run off its closed form, but for what its tour shows."""
        ...

    @property
    def files(self) -> Sequence[Path]:
        """The file, and those that it includes."""
        ...

    def drawn(self) -> Poses:
        """The pose that the file asks for, one sample."""
        ...

    def coordinate_rad(self) -> float:
        """What the driven joint reads in that pose."""
        ...

    def open_m(self) -> Mapping[str, float]:
        """By how much each joint of the scene is open in that pose [m]."""
        ...

    def loose(self) -> Sequence[str]:
        """The joints that can still move where the driven one is held."""
        ...

    def welds(self) -> Sequence[str]:
        """The welds that make bodies of the linkage one, with these bodies, in words."""
        ...

    def tour(self, scene: Scene, states: Sequence[State]) -> Tour:
        """Hold the model in states of its closed form. Raises EngineError where the engine sees a
        loop open that is shut there."""
        ...

    def engine(self, advised: Advised) -> Engine:
        """The engine, which runs this model whatever scene it is given: its profiles are the lines
        to tell, as written first and recommended last."""
        ...

    def patch(self, dt_s: float, advised: Advised) -> str:
        """The recommended settings at a step as a diff of the file, or in words."""
        ...


Reader = Callable[[Path, str, str | None], OwnModel]
"""Reads a file whose driven joint has that name, at the keyframe of that name or as drawn. Raises
EngineError for what can not be read, or is no planar linkage with one driver."""


def reading_engine() -> str:
    """The engine that reads files of others. Raises EngineError where none does."""
    able = offering("reader")
    if not able:
        raise EngineError("no engine reads models of others")
    return able[0]


def reader() -> Reader:
    """What reads a model. Raises EngineError where its engine is not installed."""
    return cast(Reader, capability(reading_engine(), "reader"))
