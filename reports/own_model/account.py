"""Account of a model: its reading, and the results of its lines."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from analytic.kinematics import repeats_after, solve
from models.array import Array
from models.errors import CrankcheckError, ReachError
from models.scene import Same, Scene
from reports.compare.compare import truth_of
from reports.compare.last_turn import Trace, trace
from reports.compare.tracks import length
from reports.judge.cell import Cell, Checked, examined
from reports.judge.tolerance import check_names
from reports.own_model.assembly import ModelRequest, assembled, far_pins, out_of_reach
from reports.plan.singular import continued_note, refuse_singular
from reports.plan.steps import counted
from reports.workers.isolated import Isolated, Limits, Lost
from sim.engine import Run
from sim.registry.own_models import Advised, Disturbance, OwnModel, reader, reading_engine

NO_MEMORY = "not allocate memory"
"""Words of an engine that has no more memory."""
POSES = 73
"""Poses of a turn in which contacts and limits are sought: 5 deg apart."""


@dataclass(frozen=True)
class ProposedChange:
    """Settings that may be recommended, with the change of the file: a diff, words, or ""."""

    advised: Advised
    patch: str


@dataclass(frozen=True)
class ModelAccount:
    """A model as read, from its ``files``: its scene, the openings of its own pose by joint [m],
    possible disturbances of a comparison, the lines to run, the proposals, first choice first, and
    the recommended one; ``helps`` is False where none was seen to gain anything."""

    request: ModelRequest
    scene: Scene
    dt_s: float
    steps: int
    open_m: Mapping[str, float]
    notes: Sequence[str]
    disturbances: Sequence[Disturbance]
    profiles: Sequence[str]
    proposals: Sequence[ProposedChange]
    recommended: ProposedChange
    files: Sequence[Path]
    helps: bool = True


@dataclass(frozen=True)
class ModelLine:
    """One line of an account: the model in one profile."""

    account: ModelAccount
    profile: str

    @property
    def cell(self) -> Cell:
        account, request = self.account, self.account.request
        return Cell(
            scene=account.scene,
            engine=reading_engine(),
            profile=self.profile,
            dt_s=account.dt_s,
            steps=account.steps,
            gated=self.profile == account.profiles[0],
            tolerance=request.tolerance,
            converge=request.converge and self.profile in told(account.profiles),
        )


def told(profiles: Sequence[str]) -> tuple[str, ...]:
    """Return the three that are run with finer steps: as written, contacts off, recommended."""
    return (profiles[0], profiles[1], profiles[-1])


def read(request: ModelRequest, limits: Limits) -> ModelAccount:
    """Read a model in a process of its own: a fault in it may end that, or run forever. Raises
    CrankcheckError for a file that cannot be read, or has no closed form."""
    reader()  # says how to install it where it is missing
    child: Isolated[ModelAccount] = Isolated(limits)
    try:
        account = child.call(read_here, request)
    finally:
        child.close()
    if not isinstance(account, Lost):
        return account
    if isinstance(account.error, CrankcheckError) and NO_MEMORY not in str(account.error):
        raise account.error
    how = "did not finish" if account.status == "timeout" else account.status
    raise CrankcheckError(
        f"{request.path}: reading it {how}: {account.reason}; it is allowed --limit-s "
        f"{limits.time_s:g} s and --memory-gb {limits.memory_gb:g}"
    )


def read_here(request: ModelRequest) -> ModelAccount:
    """Read as `read`, in this process."""
    own = reader()(request.path, request.joint, request.key)
    scene, notes = assembled(own, request)
    check_names(scene)
    dt_s, steps = _step_s_and_count(scene, own, request)
    turns = min(dt_s * steps / scene.driver.law.period_s, repeats_after(scene) / math.tau)
    poses = max(POSES, math.ceil(POSES * turns))
    times = np.linspace(0.0, turns * scene.driver.law.period_s, poses)
    try:
        motion = solve(scene, times, bound=False)
        refuse_singular(scene, dt_s * steps)
    except ReachError as error:
        words = f"{out_of_reach(scene, request, str(error))}{far_pins(own)}"
        raise CrankcheckError(f"{request.path}: {words}") from None
    except CrankcheckError as error:
        raise CrankcheckError(
            f"{request.path}: {error}; --start and --turns set the range of joint {request.joint}"
            f"{far_pins(own)}"
        ) from None
    seen = own.tour(scene, [motion.state(index) for index in range(len(times))])
    # Contacts off only where links touch, and the file's own integrator where another is no help.
    possible = itertools.product((True, False), (True, False) if seen.touching else (False,))
    proposals = [
        ProposedChange(advised, own.patch(dt_s, advised))
        for advised in itertools.starmap(Advised, possible)
    ]
    met = [
        Disturbance("contacts", f"{first} touches {second} in {share:.0%} of the poses")
        for (first, second), share in seen.touching.items()
    ]
    met += [Disturbance("limits", text) for text in seen.passed]
    note = continued_note(scene, motion)
    passed = [f"joint {request.joint}: {note}"] if note else []
    return ModelAccount(
        request=request,
        scene=scene,
        dt_s=dt_s,
        steps=steps,
        open_m=own.open_m(),
        notes=[*own.notes, *notes, *passed],
        disturbances=[*met, *own.disturbances],
        profiles=list(own.engine(proposals[0].advised).profiles),
        proposals=proposals,
        recommended=proposals[0],
        files=own.files,
    )


def _step_s_and_count(scene: Scene, own: OwnModel, request: ModelRequest) -> tuple[float, int]:
    given_s = request.dt_s
    if given_s is None and request.steps_per_turn is None:
        if not 0.0 < own.dt_s < math.inf:
            raise CrankcheckError(
                f"{request.path}: its timestep is {own.dt_s:g} s; give it one above 0, or --dt"
            )
        given_s = own.dt_s
    return counted(scene, given_s, request.steps_per_turn, request.turns)


MOST = 600
"""Instants of a course."""


@dataclass(frozen=True)
class ErrorCourse:
    """The largest position error of all bodies over time, and the widest gap, as pure numbers (T,):
    for a long run the largest of each stretch, at its own instant [s]."""

    time_s: Array
    error: Array
    gap: Array


@dataclass(frozen=True, kw_only=True)
class CheckedLine(Checked):
    """A judged line, with its last turn and its whole course where it logged something."""

    last_turn: Trace = field(default_factory=dict)
    course: ErrorCourse | None = None


def checked_line(line: ModelLine) -> CheckedLine:
    """Run and judge one line, in this process."""
    cell, request = line.cell, line.account.request
    own = reader()(request.path, request.joint, request.key)
    found, run = examined(cell, adapter=own.engine(line.account.recommended.advised))
    if run is None or found.errors is None:
        return CheckedLine(**vars(found))
    return CheckedLine(
        **vars(found), last_turn=trace(cell.shown_truth, run), course=course_of(cell, run)
    )


def course_of(cell: Cell, run: Run) -> ErrorCourse | None:
    """Return the course of a run, None without a log. Raises CrankcheckError for no reference."""
    beside = truth_of(Same(cell.scene)).beside(run)
    if beside is None:
        return None
    time_s = beside.motion.time_s
    error = np.max([length(each.error) / each.scale for each in beside.places], axis=0)
    widest = np.max([np.zeros(time_s.size), *map(np.abs, run.gaps.values())], axis=0)
    gap = np.asarray(widest / (cell.scene.longest_m or 1.0))
    kept = _largest_rows(np.nan_to_num(error, nan=np.inf, posinf=np.inf))
    return ErrorCourse(time_s[kept], error[kept], gap[kept])


def _largest_rows(series: Array) -> list[int]:
    """Return the first row, the last, and the largest of each stretch, about `MOST` in all."""
    if series.size <= MOST:
        return list(range(series.size))
    ends = np.linspace(0, series.size, MOST - 1).astype(int)
    largest = (int(start + np.argmax(series[start:end])) for start, end in itertools.pairwise(ends))
    return sorted({0, *largest, series.size - 1})
