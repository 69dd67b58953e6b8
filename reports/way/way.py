"""A way: how scenes of a kind are run and compared with the reference.

A kind of scene is a folder of the room `ways`, found by its name, with a value ``WAY``; to add one,
add the folder and its name in `WAYS`.
"""

from __future__ import annotations

from functools import cache
from importlib import import_module
from typing import Protocol, cast

from models.scene import Scene
from reports.compare.beside import Truth
from reports.way.length import GivenAs, Length, Planned
from sim.engine import Drive

WAYS = ("free_elastic", "elastic", "free", "driven")
"""The kinds, the more special first: a scene is of the first that takes it."""


class StudyLengths(Protocol):
    """What a study says of the lengths of runs."""

    steps_per_turn: list[float]
    turns: float
    dt_s: list[float]
    duration_s: float | None
    times_held: list[float]


class Way(Protocol):
    """How scenes of a kind are run and compared."""

    name: str
    drive: Drive
    """Of a run of such a scene, where none is named."""
    closed_form: bool
    """Whether the reference is solved at each instant by itself, with bounds that cost time."""

    @property
    def table(self) -> object:
        """The table of its cells, a `reports.verify.cell_table.CellTable`."""
        ...

    @property
    def log(self) -> object:
        """What is particular to its logs, a `reports.own_log.log_kind.LogKind`."""
        ...

    @property
    def solving(self) -> object:
        """How its scenes are solved, a `reports.requests.solving.Solving`."""
        ...

    def takes(self, scene: Scene, drive: Drive) -> bool:
        """Whether a run of the scene with that drive is of this kind."""
        ...

    def counted(self, scene: Scene, length: Length, given: GivenAs) -> tuple[float, int]:
        """Step [s] and number of steps of a run. Raises CrankcheckError for a length that can not
        be run."""
        ...

    def lengths(self, scene: Scene, study: StudyLengths, given: GivenAs) -> list[Length]:
        """The runs of a scene in a study, a length for each step. Raises CrankcheckError."""
        ...

    def refuse(self, run: Planned) -> None:
        """Refuse a run that has no reference. Raises CrankcheckError."""
        ...

    def turn_s(self, scene: Scene) -> float:
        """What lengths of runs are multiples of [s]: a turn of the driver, or a second."""
        ...

    def every(self, steps: int, steps_per_turn: float) -> int:
        """How many steps are taken from sample to sample of the log."""
        ...

    def given(self, scene: Scene, given: GivenAs) -> Scene:
        """The scene that an engine is given: of elastic links, the segments."""
        ...

    def note(self, scene: Scene, duration_s: float) -> str:
        """What is said of a run of that duration [s] beside its numbers; "" for nothing."""
        ...

    def truth(self, run: Planned) -> Truth:
        """The reference of a run. Raises CrankcheckError for a scene that has none."""
        ...


@cache
def way(name: str) -> Way:
    """The way of that name."""
    return cast(Way, import_module(f"..ways.{name}", __package__).WAY)


def way_of(scene: Scene, drive: Drive | None = None) -> Way:
    """The way of a run of the scene with a drive; of None with its own."""
    chosen = drive or ("free" if scene.is_free else "prescribed")
    return next(each for each in map(way, WAYS) if each.takes(scene, chosen))


def laid_out(
    scene: Scene, length: Length, given: GivenAs, *, with_forces: bool = False
) -> tuple[float, int]:
    """Step [s] and number of steps of a run that has a reference. Raises CrankcheckError."""
    chosen = way_of(scene)
    step = chosen.counted(scene, length, given)
    chosen.refuse(Planned(scene, *step, given, with_forces))
    return step
