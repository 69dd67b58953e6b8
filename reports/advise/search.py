"""The error of a choice at the frame itself, and the fewest sub-steps that reach the target."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial

from models.errors import CrankcheckError, EngineError
from models.scene import Scene
from reports.advise.demand import Choice, Demand, MeasuredStudy
from reports.compare.compare import Truth
from reports.judge.cell import Cell
from reports.plan.steps import coarsest
from reports.stability.error_series import ErrorSeries, error_series
from reports.workers.isolated import Isolated, Limits, Lost, as_they_end, in_order
from sim.run import run

GROWS = 1.05
"""Largest ratio of the error in the second half of a run to the first that is not growth: samples
that fall elsewhere in a turn make some of it."""
LONGER = 8.0
"""Factor of the length of a run in which an error that grows has to stay under the target."""
WORDS = {
    "diverged": "comes apart",
    "locked": "locks",
    "branch-changed": "other branch",
    "timeout": "takes too long",
    "crashed": "crashes",
    "unsupported": "not possible",
}
"""Words for a failed run."""


@dataclass(frozen=True)
class TriedRun:
    """Result of a run. ``error`` is the error of place, over all its samples, infinite where it did
    not end well; ``growth`` is its ratio of the second half of the turns to the first, or NaN."""

    error: float
    status: str = "ok"
    reason: str = ""
    growth: float = math.nan
    studied: bool = False

    @property
    def grows(self) -> bool:
        return self.growth > GROWS


def look(cell: Cell) -> TriedRun:
    """Run a cell, and compare its places with the reference."""
    try:
        start = Truth(cell.scene, bound=False).start
        done = run(
            cell.scene,
            start,
            cell.engine,
            cell.profile,
            dt_s=cell.dt_s,
            steps=cell.steps,
            settings=cell.settings,
        )
    except EngineError as error:
        return TriedRun(math.inf, "unsupported", str(error))
    if done.status == "unsupported" or done.motion is None:
        return TriedRun(math.inf, done.status, done.reason)
    try:
        return _seen(error_series(cell.scene, done))
    except CrankcheckError as error:
        return TriedRun(math.inf, "crashed", f"no reference to compare with: {error}")


def _seen(series: ErrorSeries) -> TriedRun:
    if series.status != "ok":
        return TriedRun(math.inf, series.status, series.reason)
    if series.departure is not None:
        return TriedRun(math.inf, "branch-changed", f"{series.departure.link} left its branch")
    if series.incomplete:
        return TriedRun(math.inf, "crashed", series.incomplete)
    error, _ = series.worst(series.place)
    turn = series.turn
    late = turn > 0.5 * turn[-1]
    early = float(series.place[~late].max(initial=0.0))
    growth = float(series.place[late].max(initial=0.0)) / early if early > 0.0 else math.nan
    return TriedRun(error, growth=growth if turn[-1] >= 2.0 else math.nan)


LIMITS = Limits(time_s=30.0)
"""Limits of a run; the longest has `plan.steps.MOST_STEPS`, and takes a few seconds."""
ENDS_A_SEARCH = ("unsupported", "timeout", "crashed")
"""Endings of a run that no other step repairs, or that cost its process or its time."""


@dataclass(frozen=True)
class Worst:
    """The worst of the scenes with so many sub-steps in a frame."""

    substeps: int
    scene: str
    seen: TriedRun

    @property
    def error(self) -> float:
        return self.seen.error


@dataclass(frozen=True)
class SearchResult:
    """Search result of a choice.

    ``at_frame`` is the worst with one step to a frame, None where such a step is too long for a
    turn. ``promise`` is the worst with the fewest sub-steps that reach the target, over the whole
    run of every scene now; ``held_at`` are the larger numbers that were seen to reach it too. It is
    None where none does, and ``nearest`` has the least error over the target of all looks;
    ``unsteady`` numbers reach it, and larger ones do not. ``ended`` is the run that ended the
    search, where one did.
    """

    choice: Choice
    at_frame: Worst | None
    promise: Worst | None
    nearest: Worst | None
    held_at: tuple[int, ...] = ()
    unsteady: tuple[int, ...] = ()
    runs: int = 0
    ended: TriedRun | None = None


def search_all(
    demand: Demand,
    wanted: Sequence[Choice],
    known: MeasuredStudy,
    jobs: int,
    done: Callable[[SearchResult], None] = lambda _: None,
) -> list[SearchResult]:
    """Search for every choice, several at a time, each in a process that it may crash."""
    work = partial(_reached, demand, known)
    return in_order(as_they_end(work, wanted, jobs, LIMITS), done)


class EndedError(Exception):
    """A run after which no other is tried with the same settings."""

    def __init__(self, worst: Worst) -> None:
        super().__init__(worst.seen.reason)
        self.worst = worst


@dataclass
class _TriedRuns:
    """The runs of a choice so far, by number of sub-steps and scene."""

    demand: Demand
    known: MeasuredStudy
    child: Isolated[TriedRun]
    choice: Choice
    seen: dict[int, dict[str, TriedRun]] = field(default_factory=dict)
    runs: int = 0
    _last: dict[str, float] = field(default_factory=dict)

    def worst(self, substeps: int, *, whole: bool = False) -> Worst:
        """Return the worst of the scenes, or the first that is over the target, unless the
        ``whole`` is requested; the last worst scene is run first. Raises EndedError if no other
        step helps."""
        here = self.seen.setdefault(substeps, {})
        for scene in sorted(self.demand.scenes, key=lambda s: -self._last.get(s.name, math.inf)):
            if scene.name not in here:
                here[scene.name] = self._read(scene, substeps) or self._run(scene, substeps)
            self._last[scene.name] = error = here[scene.name].error
            if math.isinf(error) or (error > self.demand.target and not whole):
                break
        return self.worst_seen(substeps)

    def confirmed(self, substeps: int) -> bool:
        """True if all results from a study reach the target in runs now, too."""
        here = self.seen[substeps]
        for scene in self.demand.scenes:
            if here[scene.name].studied:
                here[scene.name] = self._run(scene, substeps)
        return self.worst_seen(substeps).error <= self.demand.target

    def forget_the_study(self) -> None:
        self.known = MeasuredStudy()
        run = {
            substeps: {name: seen for name, seen in here.items() if not seen.studied}
            for substeps, here in self.seen.items()
        }
        self.seen = {substeps: here for substeps, here in run.items() if here}

    def reached(self, substeps: int) -> bool:
        here = self.seen[substeps]
        whole = len(here) == len(self.demand.scenes)
        return whole and all(seen.error <= self.demand.target for seen in here.values())

    def worst_seen(self, substeps: int) -> Worst:
        here = self.seen[substeps]
        name = max(here, key=lambda name: here[name].error)
        return Worst(substeps, name, here[name])

    def _read(self, scene: Scene, substeps: int) -> TriedRun | None:
        """Return the study's error between its steps; None where it has none."""
        error = self.known.error(scene, self.choice, self.demand.steps_per_turn(substeps))
        return None if error is None else TriedRun(error, studied=True)

    def _run(self, scene: Scene, substeps: int) -> TriedRun:
        """Return a run now; a longer one where the error grows, and is not over the target yet."""
        seen = self._call(scene, substeps)
        if seen.grows and seen.error <= self.demand.target:
            seen = self._call(scene, substeps, LONGER)
        if seen.status in ENDS_A_SEARCH:
            raise EndedError(Worst(substeps, scene.name, seen))
        return seen

    def _call(self, scene: Scene, substeps: int, longer: float = 1.0) -> TriedRun:
        self.runs += 1
        cell = self.demand.cell(scene, self.choice, substeps, longer)
        found = self.child.call(look, cell)
        return TriedRun(math.inf, found.status, found.reason) if isinstance(found, Lost) else found


def _reached(
    demand: Demand, known: MeasuredStudy, child: Isolated[TriedRun], choice: Choice
) -> SearchResult:
    looks = _TriedRuns(demand, known, child, choice)
    at_frame, promise, nearest, last = None, None, None, None
    try:
        first = looks.worst(demand.least, whole=True)
        at_frame = first if demand.least == 1 else None
        if substeps := _fewest(looks):
            promise = looks.worst(substeps)
        else:
            nearest = _nearest(looks)
        at_frame = at_frame and looks.worst(1, whole=True)  # as far as it was run since
    except EndedError as ended:
        last = ended.worst.seen
        at_frame = at_frame or (ended.worst if ended.worst.substeps == 1 else None)
    within = sorted(n for n in looks.seen if looks.reached(n))
    return SearchResult(
        choice=choice,
        at_frame=at_frame,
        promise=promise,
        nearest=nearest,
        held_at=tuple(n for n in within if promise and n > promise.substeps),
        unsteady=() if promise else tuple(within),
        runs=looks.runs,
        ended=last,
    )


def _fewest(looks: _TriedRuns) -> int | None:
    """Return the fewest sub-steps that reach the target, and do so in runs now.

    A promise of the study is run; if that run is over the target, the search goes on by runs alone.
    """
    demand = looks.demand

    def found(start: int) -> int | None:
        def error(substeps: int) -> float:
            return looks.worst(substeps).error

        return coarsest(error, demand.target, start, demand.least, demand.most)

    substeps = found(demand.least)
    if substeps is None or looks.confirmed(substeps):
        return substeps
    looks.forget_the_study()
    return found(substeps)


def _nearest(looks: _TriedRuns) -> Worst | None:
    """Return the least error over the target of all looks; None where no run came to its end."""
    over = [looks.worst_seen(n) for n in looks.seen if not looks.reached(n)]
    finite = [worst for worst in over if math.isfinite(worst.error)]
    if not finite:
        return None
    least = min(finite, key=lambda worst: (worst.error, worst.substeps))
    return looks.worst(least.substeps, whole=True)
