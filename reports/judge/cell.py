"""One cell of a verification: scene x engine x profile x step; run it, compare it, judge it."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from statistics import median
from typing import Any, Literal

import numpy as np

from analytic.kinematics import solve
from models.errors import CrankcheckError, EngineError
from models.motion import State
from models.scene import Scene
from models.scene.driver import place_in_words
from reports.compare.compare import Truth, compare, not_asked_for
from reports.compare.errors import Departure, largest
from reports.compare.worlds import Batch, difference, evenly, holders
from reports.judge.halving import Followed, followed
from reports.judge.known import Judged, Names
from reports.judge.rules import BATCHES, RULES, judge
from reports.judge.rules.rule import Evidence, Finding
from reports.judge.tolerance import limits
from reports.output.numbers import count
from reports.protocol.length import SEGMENTS, GivenAs, Planned, Springs
from reports.protocol.way import Way, way_of
from sim.engine import Drive, Engine, Run, SettingValue
from sim.engine.settings import profile_of, resolved
from sim.registry import engine
from sim.run import run, setup
from sim.run.worlds import run_worlds

CellRunner = Callable[..., Any]
"""Runner of a cell: it takes the arguments of `sim.run.run`, or of `run_worlds` for a batch."""


@dataclass(frozen=True)
class Cell:
    """Run request: ``steps`` of ``dt_s`` from the scene's start; a cell that is not ``gated`` is
    shown and judged, and does not count for the exit code. ``settings`` override the profile.
    ``with_forces`` requests the reactions and the driving torque as well. The engine gets each
    elastic link as so many ``segments``, with ``springs`` of a kind between them. With ``worlds``
    it is run in a batch of so many, in so many ``threads``, whose starts are spread evenly over the
    driver's period."""

    scene: Scene
    engine: str
    profile: str
    dt_s: float
    steps: int
    gated: bool = True
    drive: Drive = "prescribed"
    tolerance: Mapping[str, float] = field(default_factory=dict)
    converge: bool = True
    settings: Mapping[str, SettingValue] = field(default_factory=dict)
    with_forces: bool = False
    segments: int = SEGMENTS
    springs: Springs = "plain"
    worlds: int = 0
    threads: int = 1

    @property
    def turns(self) -> float:
        """Length of the run: in turns of the driver, for free motion in seconds."""
        return self.steps * self.dt_s / self.way.turn_s(self.scene)

    @property
    def steps_per_turn(self) -> float:
        """Steps in a turn, or in a second of free motion: scenes of the same step are comparable,
        whatever the length of their free motion."""
        return self.way.turn_s(self.scene) / self.dt_s

    @property
    def way(self) -> Way:
        """The way to run and compare a run of this kind."""
        return way_of(self.scene, self.drive)

    @property
    def given_as(self) -> GivenAs:
        """The form of elastic links for the engine."""
        return GivenAs(self.segments, self.springs)

    @property
    def truth(self) -> Truth:
        """The reference. Raises CrankcheckError for a scene without free motion."""
        return self.way.truth(self.planned)

    @property
    def planned(self) -> Planned:
        """The run, without its engine."""
        run = self.dt_s, self.steps, self.given_as, self.with_forces, self.tolerance
        return Planned(self.scene, *run)

    @property
    def shown_truth(self) -> Truth:
        """The reference without bounds, which cost time and are not drawn."""
        return Truth(self.scene, bound=False) if self.way.closed_form else self.truth

    @property
    def given(self) -> Scene:
        """The scene for the engine: with segments for elastic links."""
        return self.way.given(self.scene, self.given_as)

    @property
    def every(self) -> int:
        """Number of steps from sample to sample."""
        return self.way.every(self.steps, self.steps_per_turn)

    @property
    def label(self) -> str:
        return f"{self.scene.name}, {self.engine}, {self.profile}{self.in_batch}"

    @property
    def in_batch(self) -> str:
        """The worlds of a batch, in words that follow a name; "" for a run alone."""
        threads = f" in {self.threads} threads" if self.threads > 1 else ""
        return f", {count(self.worlds, 'world')}{threads}" if self.worlds else ""


@dataclass(frozen=True, kw_only=True)
class Checked(Judged):
    """A cell with its results, and its duration [s]; the trajectories are gone."""

    cell: Cell
    version: str = ""
    settings: Mapping[str, SettingValue] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()
    wall_s: float = 0.0

    @property
    def names(self) -> Names:
        return self.cell.scene.name, self.cell.engine, self.cell.profile, self.cell.drive

    @property
    def most_taken(self) -> float:
        """The largest part of a limit; infinite for a number that is not finite."""
        parts = (finding.taken for finding in self.findings)
        return max((part for part in parts if not math.isnan(part)), default=0.0)

    @property
    def place_error(self) -> float:
        """The largest pure error of place; infinite for one that is not finite, or none."""
        rows = (self.errors.worst(name) for name in self.cell.way.placed) if self.errors else ()
        worst = largest(filter(None, rows))
        return worst.pure if worst and worst.finite else math.inf

    @property
    def advice(self) -> tuple[Finding, ...]:
        return tuple(finding for finding in self.findings if finding.level == "advice")

    @property
    def verdict(self) -> Literal["within", "out", "known", "unsupported"]:
        if self.status == "unsupported":
            return "unsupported"
        return "known" if self.is_known else "out" if self.failures else "within"


def check(cell: Cell) -> Checked:
    """Run a cell at its step (and at half and a quarter of it), compare and judge it; of a batch,
    judge the worst world."""
    return examined(cell)[0]


def examined(
    cell: Cell, runner: CellRunner | None = None, adapter: Engine | None = None
) -> tuple[Checked, Run | None]:
    """Return `check`, and the run at the full step, None where there is none. ``runner`` replaces
    `sim.run.run`, or for a batch `run_worlds`: to see whether a fault in it is detected.
    ``adapter`` replaces the engine of that name: for an engine with a model of its own."""
    began = time.perf_counter()
    usual: CellRunner = run_worlds if cell.worlds else run
    found, done = _untimed(cell, runner or usual, adapter)
    return replace(found, wall_s=time.perf_counter() - began), done


def _untimed(cell: Cell, runner: CellRunner, adapter: Engine | None) -> tuple[Checked, Run | None]:
    try:
        truth = cell.truth  # before the run: the reference of another scene is dropped
        own = adapter or engine(cell.engine)
        if cell.worlds:
            starts = cell.way.turn_s(cell.scene) * np.arange(cell.worlds) / cell.worlds
            motion = solve(cell.scene, starts, bound=False)
            states = [motion.state(k) for k in range(cell.worlds)]
            worlds = [_Runs(cell, truth, each, cell.given, own, run, adapter) for each in states]
            return _in_batch(worlds, runner), None
        runs = _Runs(cell, truth, truth.start, cell.given, own, runner, adapter)
        done = runs.run(1)
    except EngineError as error:
        return unfinished(cell, "unsupported", str(error)), None
    except CrankcheckError as error:
        return unfinished(cell, "crashed", f"no reference at the start: {error}"), None
    return _judged(cell, truth, done, runs), done


def _in_batch(worlds: Sequence[_Runs], runner: CellRunner) -> Checked:
    """Run the worlds of a cell as a batch, and return the worst of them, with the facts of all."""
    first, states = worlds[0], [one.state for one in worlds]
    cell, adapter = first.cell, first.adapter
    done = runner(cell.given, states, *first.names, threads=cell.threads, **first.options(1))
    if not done:
        return unfinished(cell, "crashed", "no world of the batch was logged")
    each = [
        _judged(cell, one.truth, replace(one, runner=_existing(run)).run(1), one)
        for one, run in zip(worlds, done, strict=False)
    ]
    alone = {k: worlds[k].run(1) for k in evenly(cell.worlds) if k < len(done)}
    apart = {k: difference(cell.scene, done[k], run) for k, run in alone.items()}
    at = max(apart, key=lambda k: apart[k][0])
    worst = max(range(len(each)), key=lambda k: (bool(each[k].failures), each[k].most_taken))
    placed = [one.place_error for one in each]
    batch = Batch(
        count=cell.worlds,
        worst=worst,
        error=max(placed),
        error_in=placed.index(max(placed)),
        lost=cell.worlds - len(done),
        holds=holders(cell.scene, done),
        alone=tuple(alone),
        difference=apart[at][0],
        at=at,
        exact=all(exact for _, exact in apart.values()),
        bound=done[0].floor,
        why=adapter.batches.why if adapter.batches else "",
        us_per_step=_median_us(done),
        us_alone=_median_us(alone.values()),
    )
    found = replace(each[worst], batch=batch)
    own = (
        finding
        if finding.level == "pass"
        else replace(finding, text=f"world {worst}: {finding.text}")
        for finding in found.findings
    )
    return replace(found, findings=(*own, *judge(found, [RULES[name] for name in BATCHES])))


def _median_us(runs: Iterable[Run]) -> float:
    """Return the cost of a step in most runs; NaN where none has any."""
    return median([run.cost.us_per_step for run in runs if run.cost] or [math.nan])


def _existing(run: Run) -> CellRunner:
    """Return a runner that has the run already."""
    return lambda *_, **__: run


def check_run(cell: Cell, done: Run) -> Checked:
    """Return `check` for an earlier run, at no other step."""
    return _judged(cell, cell.truth, done, None)


def _judged(cell: Cell, truth: Truth, done: Run, runs: _Runs | None) -> Checked:
    """Compare and judge a run at the full step; ``runs`` make the finer ones, if any."""
    try:
        errors = compare(truth.beside(done))
    except CrankcheckError as error:
        why = f"the run has no reference to compare with: {error}"
        return unfinished(cell, "crashed", why)
    status, reason = done.status, done.reason
    if status == "ok" and errors and errors.departure:
        status, reason = "branch-changed", left_words(errors.departure)
    adapter, seen = runs.adapter if runs else engine(cell.engine), Followed()
    placing = adapter.placing(resolved(profile_of(adapter, cell.profile), cell.settings))
    if cell.converge and errors and runs:
        nature = placing, adapter.order
        seen = followed(truth, cell.dt_s, errors, cell.tolerance, runs.run, *nature)
    evidence = Evidence(
        status=status,
        reason=reason,
        stopped_at_s=done.stopped_at_s,
        errors=errors,
        limits=limits(cell.scene, errors, cell.tolerance) if errors else {},
        convergence=seen.places,
        force_convergence=seen.forces,
        gated=cell.gated,
        profile="" if runs and runs.given else cell.profile,
        placing=placing,
        order=adapter.order,
        unasked=tuple(runs.unasked) if runs else None,
    )
    return Checked(
        **vars(evidence),
        cell=cell,
        version=done.version,
        settings=dict(done.settings),
        findings=judge(evidence),
        warnings=done.warnings,
    )


@dataclass(frozen=True)
class _Runs:
    """The runs of a cell from one state, and their differences from the request."""

    cell: Cell
    truth: Truth
    state: State
    given_scene: Scene
    adapter: Engine
    runner: CellRunner
    given: Engine | None = None
    unasked: list[str] = field(default_factory=list)

    @property
    def names(self) -> tuple[str | Engine, str]:
        """The engine and its profile."""
        return self.given or self.cell.engine, self.cell.profile

    def options(self, finer: int) -> dict[str, Any]:
        """Return the options of a run with the step divided by ``finer``."""
        cell = self.cell
        return {
            "dt_s": cell.dt_s / finer,
            "steps": cell.steps * finer,
            "every": finer * cell.every,
            "drive": cell.drive,
            "settings": cell.settings,
            "rates": finer == 1 or cell.with_forces,  # of finer runs places alone are compared
            "with_forces": cell.with_forces,
        }

    def run(self, finer: int) -> Run:
        """Run the cell with its step divided by ``finer``, logged at the same instants."""
        given, options = self.given_scene, self.options(finer)
        done = self.runner(given, self.state, *self.names, **options)
        asked = setup(given, self.state, *self.names, **options)
        held = self.adapter.holds(asked.asked, asked.dt_s, asked.drive)
        texts = not_asked_for(done, asked, held, given, self.state)
        at = f"finer run, dt / {finer}: " if finer > 1 else ""
        self.unasked.extend(at + text for text in texts)
        return self.truth.logged(done)


def left_words(departure: Departure) -> str:
    """Return a departure in words."""
    at = place_in_words(departure.driver_rad, departure.driver_unit, ".1f")
    return (
        f"{departure.link} left its branch at driver {at}, "
        f"t = {departure.time_s:.4g} s, and moves on in the other assembly of the closed loop"
    )


def unfinished(cell: Cell, status: str, reason: str) -> Checked:
    """Return a cell that has no run: a row with a reason."""
    evidence = Evidence(status, reason, 0.0, None, {})
    return Checked(**vars(evidence), cell=cell, findings=judge(evidence))
