"""A user's own model in an engine's format: the interface of an engine that reads such files."""

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
"""Largest number of turns of a joint at the start, either way; with more, the rounding of its angle
nears the tolerance of a run."""


@dataclass(frozen=True)
class Tour:
    """Events of a model in the poses of its closed form: by pair of bodies or shapes the share of
    the poses with contact; by joint the excess beyond its limits, in words."""

    touching: Mapping[tuple[str, str], float]
    passed: Sequence[str]


FAR_PIN = "far pin"
"""Kind of a disturbance: a pin far outside its body, so that another linkage was meant."""


@dataclass(frozen=True)
class Disturbance:
    """Something in a model that can move a run off its closed form: ``text`` names it, with its
    joint or body; a run with a variant that names its ``kind`` (``contacts`` in ``contacts-off``)
    leaves out all of this kind."""

    kind: str
    text: str


@dataclass(frozen=True)
class Advised:
    """Recommended settings beside stiff loops and a tight solver: the integrator (else the file's
    own), contacts off."""

    integrator: bool = True
    contacts_off: bool = False


class OwnModel(Protocol):
    """A model as read.

    Its ``scene`` has no branch, and a driver that turns at 1 rad/s from the drawn position, with
    the angle of its joint; ``dt_s`` is the model's own step [s].
    """

    @property
    def scene(self) -> Scene: ...

    @property
    def dt_s(self) -> float: ...

    @property
    def notes(self) -> Sequence[str]:
        """Parts of the model that are held or left out, with the reason."""
        ...

    @property
    def disturbances(self) -> Sequence[Disturbance]:
        """Disturbances of a run against its closed form, except those of its tour."""
        ...

    @property
    def files(self) -> Sequence[Path]:
        """The file, and its included files."""
        ...

    def drawn(self) -> Poses:
        """Return the pose of the file, one sample."""
        ...

    def coordinate_rad(self) -> float:
        """Return the coordinate of the driven joint in that pose."""
        ...

    def open_m(self) -> Mapping[str, float]:
        """Return the opening of each joint of the scene in that pose [m]."""
        ...

    def loose(self) -> Sequence[str]:
        """List the joints that can still move while the driven joint is fixed."""
        ...

    def welds(self) -> Sequence[str]:
        """List the welds that unite bodies of the linkage, with these bodies, in words."""
        ...

    def outside(self, scene: Scene, state: State) -> Sequence[str]:
        """Describe the joints that a state puts outside their declared ranges, with the readings;
        the driven joint is none of them."""
        ...

    def tour(self, scene: Scene, states: Sequence[State]) -> Tour:
        """Put the model into states of its closed form. Raises EngineError where the engine sees a
        loop open that is closed there."""
        ...

    def engine(self, advised: Advised) -> Engine:
        """Return the engine, which runs this model for any scene: its profiles are the lines of the
        report, as written first and recommended last."""
        ...

    def patch(self, dt_s: float, advised: Advised) -> str:
        """Return the recommended settings at a step as a diff of the file, or in words."""
        ...


Reader = Callable[[Path, str, str | None], OwnModel]
"""Reads a file by the name of the driven joint, at the named keyframe or as drawn. Raises
EngineError for an unreadable file, or no planar linkage with one driver."""


def reading_engine() -> str:
    """Return the engine that reads users' own files. Raises EngineError where none does."""
    able = offering("reader")
    if not able:
        raise EngineError("no engine reads models of others")
    return able[0]


def reader() -> Reader:
    """Return the reader of a model. Raises EngineError where its engine is not installed."""
    return cast(Reader, capability(reading_engine(), "reader"))
