"""The way of a kind of scene: its run, and its comparison with the reference.

A kind of scene is a folder of the room `ways`, found by its name, with a value ``WAY``; to add one,
add the folder and its name in `WAYS`.
"""

from collections.abc import Collection, Mapping, Sequence, Set
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from types import ModuleType
from typing import Any, NoReturn, Protocol, cast

from models.array import Array
from models.motion import Forces, Motion, State
from models.scene import Scene
from reports.compare.compare import Truth
from reports.protocol.length import Clock, GivenAs, Length, Planned, Springs, clock_of
from reports.quantities.quantity import Role, Tolerance
from sim.engine import Drive

TARGETS = (1e-2, 1e-3, 1e-4, 1e-6)
"""Target errors of place [rad, or of the longest link]."""
FIXED = TARGETS[1:]
"""Errors that cells of every step are compared with beside their tolerance."""
SHRINKS = (
    "The tolerance of a cell is a budget that shrinks with its step: settings with less error may "
    "be within it less often."
)


@dataclass(frozen=True)
class ResultKind:
    """Words and targets of stored cells.

    ``unit`` is that of the compared error, ``axis`` its name on diagrams and ``promise`` in a
    recommendation; ``targets`` are those of recommendations, ``kept`` names the items kept within
    one, ``head`` its column, and ``notes`` precede settings to be copied. ``error`` explains the
    error on a page, in the place ``stands`` among other kinds; a common axis is that of the kind
    with the lowest ``leads``.
    """

    error: str
    stands: int
    leads: int
    axis: str
    promise: str
    unit: str = "rad"
    targets: Sequence[float] = TARGETS
    kept: str = "scene within a target"
    head: str = "target\nrad"
    notes: Sequence[str] = ()


WAYS = ("free_elastic", "elastic", "free", "driven")
"""The kinds, special ones first: a scene belongs to the first that takes it. A name with a dot is
that of a package elsewhere."""


class StudyLengths(Protocol):
    """The lengths of runs in a study."""

    steps_per_turn: list[float]
    turns: float
    dt_s: list[float]
    duration_s: float | None
    times_held: list[float]


class StudyLinks(Protocol):
    """The models of elastic links in a study."""

    segments: list[int]
    springs: list[Springs]


class Way(Protocol):
    """The way to run and compare scenes of a kind.

    Its parts are modules in its folder, or in that of a way that it builds on, each loaded where
    needed; the value of a module has its name, in capitals; the footer is a second value of the
    table's module. A way without columns of its own has those of all cells alone.

    ========== ===============================================================================
    columns    the columns of its cells, a `reports.judge.rows.ColumnsOf`
    table      the table of its cells, a `reports.verify.table.CellTable`
    batches    the table of its cells in batches, also a `CellTable`; of driven scenes alone
    footer     the lines under the table, `reports.verify.table.Part` each, also there
    faults     the faults that are planted in its runs, a `reports.selftest.fault.FaultSet`
    cases      the hard cases of its scenes, by group (`reports.stability.case.Case`)
    series     the references of hard runs, by name (`reports.stability.case.Yardstick`)
    figures    its figures of a store, by name (`reports.figures.drawing.Drawing`)
    section    its section of the page (`reports.page.sections.section.WaySection`)
    log        the judging of its logs, a `reports.own_log.log_limits.LogKind`
    solving    the solving of its scenes, a `reports.requests.solving.Solving`
    ========== ===============================================================================
    """

    name: str
    drive: Drive
    """Default drive of a run of such a scene."""
    kinds: Sequence[str]
    """Kinds of its cells, in words: a figure shows some kinds."""
    closed_form: bool
    """True if the reference is solved at each instant by itself, with bounds that cost time."""

    limits: Mapping[str, Tolerance]
    """The tolerances of its runs, by name."""
    roles: Set[Role]
    """The roles of the quantities with columns in its cells, without forces."""
    placed: Sequence[str]
    """The quantities whose largest error is the error of place."""
    unlogged: Sequence[str]
    """Quantities of the whole run that have no column in a log."""

    noted: bool
    """True if the notes of its comparison appear under the tables."""
    units: str
    """The units of the numbers of its cells, in words."""
    no_case: str
    """Words on the absence of hard cases of such scenes."""
    results: ResultKind
    """Words and targets of its stored cells."""
    over_g: Sequence[str]
    """Errors that are divided by the sensitivity of the motion, in words."""

    def part(self, name: str) -> object:
        """The part named ``name``."""
        return _part(type(self).__mro__, name)

    def roles_of(self, *, with_forces: bool) -> Set[Role]:
        """The roles of the quantities of a run."""
        return {*self.roles, *(("force",) if with_forces else ())}

    def stored(self, row: Mapping[Any, Any]) -> bool:
        """True if a row of a store is a cell of the kind, or of a kind that builds on it."""

    def takes(self, scene: Scene, drive: Drive) -> bool:
        """True if a run of the scene with that drive is of this kind."""

    def counted(self, scene: Scene, length: Length, given: GivenAs) -> tuple[float, int]:
        """Step [s] and number of steps of a run. Raises CrankcheckError where it has none."""

    def lengths(self, scene: Scene, study: StudyLengths, given: GivenAs) -> list[Length]:
        """The runs of a scene in a study, a length for each step. Raises CrankcheckError."""

    def refuse(self, run: Planned) -> None:
        """Refuse a run that has no reference. Raises CrankcheckError."""

    @property
    def clock(self) -> Clock:
        """The unit of the steps and lengths of its runs."""
        return clock_of(self.drive)

    def turn_s(self, scene: Scene) -> float:
        """The unit of the lengths of runs [s]: a turn of the driver, or a second."""
        return self.clock.period_s(scene.driver.law.period_s)

    def every(self, steps: int, steps_per_turn: float) -> int:
        """Number of steps from sample to sample of the log."""
        return 1

    def given(self, scene: Scene, given: GivenAs) -> Scene:
        """The scene that an engine is given: elastic links as segments."""
        return scene

    def note(self, scene: Scene, duration_s: float) -> str:
        """A note on a run of that duration [s], beside its numbers; "" for none."""

    def truth(self, run: Planned) -> Truth:
        """The reference of a run. Raises CrankcheckError for a scene without one."""

    drives: tuple[Drive, ...]
    """Possible drives of its runs."""
    lengths_by: tuple[str, ...]
    """Options of a length that apply to it."""
    over: str
    """The drawn time of the motion, in words."""
    targets: Collection[str]
    """The quantities to which a single target applies."""
    least_judged: int
    """Least number of steps of an existing run that is judged."""

    def refuse_length(self, option: str) -> NoReturn:
        """Refuse an option of a length that does not apply. Raises CrankcheckError."""

    def released(self, scene: Scene) -> Scene:
        """The scene of the run: in free motion, where the drive is free."""

    def opened(self, scene: Scene) -> tuple[Scene, State]:
        """The scene that an engine is given, and its start. Raises CrankcheckError."""

    def held_steps(self, scene: Scene) -> tuple[float, ...]:
        """Steps in a turn for which the scene of an engine is exact; empty for any."""
        return ()

    def launch(self, run: Planned) -> Truth | None:
        """The start of a run; None for the start of the scene itself. Raises CrankcheckError."""

    def refuse_made(self, run: Planned) -> None:
        """Refuse an existing run that has no reference. Raises CrankcheckError."""

    def judged_by(self, given: GivenAs) -> list[str] | None:
        """The options of `judge` for a log of it; None where logs of it are not judged."""
        return []

    def given_by(self, study: StudyLinks) -> list[GivenAs]:
        """All models of elastic links in a study. Raises CrankcheckError."""
        return [GivenAs()]

    def key(self, given: GivenAs) -> list[object]:
        """The parts of a stored result's name beside those of all kinds."""
        return []

    def shortened(self, scene: Scene, lasts_s: float) -> str:
        """A note on a run that ends before its scene; "" for none."""
        return ""

    def motion(self, scene: Scene, time_s: Array) -> Motion:
        """The reference motion to draw, with rigid links. Raises CrankcheckError."""

    def drawn_forces(self, scene: Scene, time_s: Array) -> Forces:
        """The forces to draw. Raises CrankcheckError where there are none."""

    def drawn_s(self, most_s: float) -> float:
        """Longest drawn time of a motion that is not periodic [s]."""

    def latest_s(self, scene: Scene) -> float:
        """The latest time that can be drawn or shown [s]."""


@cache
def _part(classes: tuple[type, ...], name: str) -> object:
    own = classes[: classes.index(Way)]
    found = (getattr(_module(cls, name), name.upper(), None) for cls in own)
    return next(filter(None, found), None) or _OF_ALL[name]


def _no_columns(checked: object) -> dict[str, object]:
    return {}


_OF_ALL = {"columns": _no_columns}


def _module(cls: type, name: str) -> ModuleType | None:
    """The module of a part in the folder of a class, None where there is none."""
    whole = f"{cls.__module__}.{'table' if name == 'footer' else name}"
    return import_module(whole) if find_spec(whole) else None


@cache
def way(name: str) -> Way:
    """Return the way named ``name``."""
    return cast(Way, import_module(name if "." in name else f"..ways.{name}", __package__).WAY)


def own_parts(name: str) -> dict[str, object]:
    """The parts named ``name`` of the ways that have their own, the most general way first."""
    modules = {each: _module(type(way(each)), name) for each in reversed(WAYS)}
    return {each: getattr(module, name.upper()) for each, module in modules.items() if module}


def way_of(scene: Scene, drive: Drive | None = None) -> Way:
    """The way of a run of the scene with a drive; None for the scene's own drive."""
    chosen = drive or ("free" if scene.is_free else "prescribed")
    return next(each for each in map(way, WAYS) if each.takes(scene, chosen))


def driven_by(scene: Scene, drive: Drive) -> Drive:
    """The drive of a run of the scene: the requested one if it can be run, or its own."""
    chosen = way_of(scene)
    return drive if drive in chosen.drives else chosen.drive


def laid_out(
    scene: Scene, length: Length, given: GivenAs, *, with_forces: bool = False
) -> tuple[float, int]:
    """Step [s] and number of steps of a run that has a reference. Raises CrankcheckError."""
    chosen = way_of(scene)
    step = chosen.counted(scene, length, given)
    chosen.refuse(Planned(scene, *step, given, with_forces))
    return step


def way_of_row(row: Mapping[Any, Any]) -> Way:
    """The way of a stored cell."""
    return next(each for each in map(way, WAYS) if each.stored(row))
