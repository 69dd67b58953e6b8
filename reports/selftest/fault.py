"""A fault, and the four places where one is planted: scene, settings, engine, log.

A plant makes a runner from a size: it runs a cell as `sim.run.run` does, with the fault in it. A
size of 0 goes the same way and changes nothing, which must not be noticed.
"""

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import Any

import numpy as np

from analytic.kinematics import solve
from models.motion import State
from models.scene import Same, Scene
from reports.judge.cell import Cell, CellRunner
from reports.protocol import length, way
from sim.engine import Run, Session, Settings
from sim.engine.settings import profile_of, resolved
from sim.registry import available, engine, offering
from sim.run import run
from sim.run.spoil import Opening, Spoiler, WrongSetting, spoiler, spoilt

PROFILE = "tuned"
"""Profile of all runs that faults are planted in."""
FOURBAR, SLIDER, SHAPER = "fourbar-lecture-1", "slider-crank-offset", "shaper"
REFUSED = "the engine does not hold"
"""Words of `sim.run.check` where the model in the engine is not the scene."""
Plant = Callable[[float], CellRunner]
SceneChange = Callable[[Scene, float], Scene]
"""Change of a scene by a size."""
Items = tuple[tuple[str, Any], ...]
RunKind = str
"""Kind of the runs that faults are planted in, by name (`FaultRuns`)."""
INSIDE = ("engine", "stepping", "vibration")
"""Groups of faults inside an engine."""


@dataclass(frozen=True)
class Fault:
    """Something that goes wrong, and the rule that must say so.

    ``what`` describes it. ``size`` is its planted size, in ``unit``; None for a fault without
    sizes; ``whole`` sizes are whole numbers. ``rule`` is the one that must fail, with the words
    ``says`` in its text. ``scenes`` are where it is planted; ``needs`` says if an engine can have
    it. A ``finer`` fault needs runs at half and a quarter of the step to be seen. ``settings`` are
    those that its cell requests of an engine, on top of the profile. ``kind`` is the kind of its
    runs, by its group.
    """

    group: str
    name: str
    what: str
    rule: str
    plant: Plant
    size: float | None = None
    unit: str = ""
    says: tuple[str, ...] = ()
    scenes: tuple[str, ...] = (FOURBAR, SLIDER)
    needs: Callable[[str], bool] = lambda _: True
    whole: bool = False
    finer: bool = False
    settings: Callable[[str], Settings] = lambda _: {}
    shown: Callable[[float], str] | None = None
    kind: RunKind = "motion"

    @property
    def planted(self) -> float:
        """Size that the plant is given."""
        return 1.0 if self.size is None else self.size

    def possible(self, name: str) -> bool:
        """True if an engine can have it; a fault inside an engine needs its spoiler."""
        return (self.group not in INSIDE or name in offering("spoiler")) and self.needs(name)

    @property
    def engines(self) -> tuple[str, ...]:
        """Installed engines that can have it."""
        here = (one.name for one in available() if one.version)
        return tuple(name for name in here if self.possible(name))

    @property
    def refused(self) -> bool:
        """True if the look at the model before the run sees it."""
        return REFUSED in self.says

    def words(self, size: float) -> str:
        """Return a size with its unit."""
        digits = 3 if size > 1.0 else 2
        return self.shown(size) if self.shown else f"{size:.{digits}g} {self.unit}"


@dataclass(frozen=True)
class Unseen:
    """A deviation that passes every rule, and why that is right.

    ``needs`` says if an engine can have it; where ``shows`` the errors change with it, if only in
    their last digits: else nothing was planted.
    """

    name: str
    what: str
    reason: str
    plant: Plant
    needs: Callable[[str], bool] = lambda _: True
    shows: bool = True


def planting(runner: Callable[..., Any]) -> Plant:
    """Return the plant of a runner that takes the size first, before the arguments of a run."""
    return lambda size: partial(runner, size)


def _assembled(wrong: Scene, _: State, dt_s: float) -> State:
    return solve(wrong, np.zeros(1)).state()


def in_scene(
    change: SceneChange, start: Callable[[Scene, State, float], State] = _assembled
) -> Plant:
    """Give the engine another scene than the reference, well assembled, or with the ``start`` that
    the wrong scene, the start of the right one and the step [s] give."""

    @planting
    def runner(
        size: float, scene: Scene, state: State, *args: Any, dt_s: float, **options: Any
    ) -> Run:
        wrong = change(scene, size)
        return run(wrong, start(wrong, state, dt_s), *args, dt_s=dt_s, **options)

    return runner


def is_double(name: str) -> bool:
    """True if an engine has double precision: rounding of others hides what is small."""
    return engine(name).precision == "double"


def integrates(name: str) -> bool:
    """True if an engine integrates its places: a step leaves an error in them, unlike in numbers of
    the reference. Places that joints are solved for may be as exact as these."""
    adapter = engine(name)
    return adapter.placing(resolved(profile_of(adapter, PROFILE), None)) == "integrated"


def can_set(what: WrongSetting) -> Callable[[str], bool]:
    """True if an engine has such settings."""
    return lambda name: what in spoiler(name).wrong_settings


def in_settings(what: WrongSetting) -> Plant:
    """Set the engine otherwise than requested."""

    @planting
    def runner(
        size: float,
        scene: Scene,
        state: Any,
        name: str,
        *args: Any,
        settings: Any = None,
        **more: Any,
    ) -> Run:
        wrong = spoiler(name).wrong_settings[what](size) if size else {}
        return run(scene, state, name, *args, settings={**(settings or {}), **wrong}, **more)

    return runner


def in_engine(
    at: Callable[[int], Iterable[int]],
    spoil: Callable[[Spoiler, Session, Opening, float, float], object],
) -> Plant:
    """Meddle with the engine while it runs.

    ``at`` says after which of so many steps; ``spoil`` is given the size, and the run's elapsed
    share.
    """

    @planting
    def runner(size: float, scene: Scene, state: Any, name: str, *args: Any, **options: Any) -> Run:
        steps = options["steps"]

        def act(tools: Spoiler, session: Session, opening: Opening, done: int) -> None:
            spoil(tools, session, opening, size, done / steps)

        broken = spoilt(engine(name), tuple(at(steps)), act)
        return run(scene, state, broken, *args, **options)

    return runner


def in_log(change: Callable[[Scene, Run, float], Run]) -> Plant:
    """Run the scene without a fault, and change the log afterwards."""

    @planting
    def runner(
        size: float, scene: Scene, _: object, *names: str, settings: Any = None, **options: Any
    ) -> Run:
        asked = (tuple(sorted(each.items())) for each in (settings or {}, options))
        return change(scene, _healthy(Same(scene), *names, *asked), size)

    return runner


@lru_cache(maxsize=3)
def _healthy(same: Same, name: str, profile: str, settings: Items, options: Items) -> Run:
    """Return a run as the profile says, once for all sizes: at a step, its half and its quarter."""
    given = dict(options)
    planned = length.Planned(same.scene, given["dt_s"], given["steps"])
    start = way.way_of(same.scene, given.get("drive")).truth(planned).start
    return run(same.scene, start, name, profile, settings=dict(settings), **given)


def switched(change: Callable[[Scene, Run], Run]) -> Plant:
    """Change the log, or leave it for a size of 0."""
    return in_log(lambda scene, done, size: change(scene, done) if size else done)


STEPS = 360
"""Steps of a turn, or of a run that is a turn's."""


@dataclass(frozen=True, eq=False)
class FaultRuns:
    """Set-up and words of the runs of a kind.

    ``groups`` are the headings of its faults, by group. ``cell`` gives the run of a scene in an
    engine, with so many steps in a turn where that is `STEPS`, and halved steps compared or not.
    ``words`` says how long the runs of some scenes are, ``settings`` the same as numbers.
    ``unseen`` need not be seen in the scene ``unseen_in``. Faults of the kinds ``also`` are
    requested with it.
    """

    groups: Mapping[str, str]
    cell: Callable[[Scene, str, int, bool], Cell]
    words: Callable[[Collection[str]], Sequence[str]]
    settings: Mapping[str, object]
    unseen_in: str = FOURBAR
    unseen: Sequence[Unseen] = ()
    also: Sequence[RunKind] = ()


@dataclass(frozen=True, eq=False)
class FaultSet:
    """Faults of a way, in the order of the table, and their runs by kind."""

    faults: Sequence[Fault]
    runs: Mapping[RunKind, FaultRuns]
