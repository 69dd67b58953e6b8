"""A test of one set of settings: the coarsest step at which it reaches the target."""

import math
from collections.abc import Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass

from models.errors import CrankcheckError
from models.scene import Scene
from reports.judge.cell import Cell
from reports.plan.steps import LEAST_STEPS_PER_TURN, MOST_SEARCHED, coarsest, counted
from reports.protocol.length import LEAST_STEPS
from reports.sweep.measured import MeasuredCell, Repeats, measured, timed_in_turns
from reports.workers.isolated import Isolated, Limits, Lost
from sim.engine import Settings
from sim.registry.offers import Work

DEARER = 2.0
"""Factor of the cost of the best settings so far at which others are given up."""
NONE_KNOWN = 30.0
"""Distance from the target, in decades, of settings whose runs give no error at all."""
Row = Mapping[str, object]


@dataclass(frozen=True)
class Goal:
    """Goal of a search: ``target`` is the error of place (angle [rad], position and displacement
    over the longest link), the worst of all ``scenes`` in a run of ``turns``."""

    scenes: tuple[Scene, ...]
    engine: str
    profile: str
    target: float
    turns: float

    @property
    def least(self) -> int:
        """Fewest steps in a turn that a run of so many turns may have."""
        return max(LEAST_STEPS_PER_TURN, math.ceil(LEAST_STEPS / self.turns))

    @property
    def most(self) -> int:
        """Most steps in a turn; a run at half the step is still possible."""
        return int(MOST_SEARCHED / (2.0 * self.turns))

    def cell(self, scene: Scene, settings: Settings, steps_per_turn: int) -> Cell:
        """Return a run with complete settings."""
        step = counted(scene, None, steps_per_turn, self.turns)
        return Cell(
            scene, self.engine, self.profile, *step, gated=False, converge=False, settings=settings
        )


@dataclass(frozen=True)
class Attempt:
    """Result of some settings.

    ``steps_per_turn`` is None where no step reached the target for good: ``error`` is then the
    least that is over it, at ``tried`` steps in a turn. ``cost_us`` is the model's cost of a turn,
    all scenes together [microseconds]; ``runs`` the number of runs, one per scene and step.
    ``timed_out`` says that the clock ended a run: this says nothing for good about the settings.
    """

    settings: Settings
    steps_per_turn: int | None
    tried: int
    error: float
    scene: str
    cost_us: float
    runs: int
    reason: str = ""
    timed_out: bool = False

    @property
    def reached(self) -> bool:
        return self.steps_per_turn is not None

    def over(self, target: float) -> float:
        """Return by how many decades the error is over the target; 0 or less where it is not."""
        if self.error == 0.0:
            return -NONE_KNOWN
        return min(math.log10(self.error / target), NONE_KNOWN)


class LostError(Exception):
    """A run that came to nothing: no other step is tried with its settings."""

    def __init__(self, scene: str, status: str, reason: str) -> None:
        super().__init__(f"{scene}: {status}: {reason}")
        self.timed_out = status == "timeout"


class Bench:
    """Runs settings at steps, in a process of its own that may crash or hang; to be closed."""

    def __init__(self, goal: Goal, works: Sequence[Work], limits: Limits) -> None:
        self.goal = goal
        self.works = works
        self._isolated: Isolated[MeasuredCell] = Isolated(limits)

    def close(self) -> None:
        """End the process at once."""
        self._isolated.close()

    def us_per_step(self, settings: Settings) -> float:
        """Return the model's cost of a step, all scenes together [microseconds]."""
        return sum(work(settings) for work in self.works)

    def row(self, scene: Scene, settings: Settings, steps_per_turn: int) -> Row:
        """Return the row of one run.

        Raises
        ------
        LostError
            The process crashed or took too long, or the engine can not hold the scene.
        """
        cell = self.goal.cell(scene, settings, steps_per_turn)
        outcome = self._isolated.call(measured, cell, False)
        if isinstance(outcome, Lost):
            raise LostError(scene.name, outcome.status, outcome.reason)
        if outcome.row["status"] == "unsupported":
            raise LostError(scene.name, "unsupported", str(outcome.row["reason"]))
        return outcome.row

    def refuse_unsupported(self, settings: Settings) -> None:
        """Raise CrankcheckError for a scene that the engine can not hold."""
        for scene in self.goal.scenes:
            cell = self.goal.cell(scene, settings, self.goal.least)
            outcome = self._isolated.call(measured, cell, False)
            if isinstance(outcome, MeasuredCell) and outcome.row["status"] == "unsupported":
                raise CrankcheckError(f"{cell.label}: {outcome.row['reason']}")

    def attempt(self, settings: Settings, best: Attempt | None) -> Attempt:
        """Find the coarsest step that reaches the target.

        The search starts at the step of ``best``, the best so far, and ends where these settings
        would take several times as long: they can not win any more.
        """
        goal, each = self.goal, self.us_per_step(settings)
        most, start = goal.most, 4 * goal.least
        if best is not None and best.steps_per_turn is not None:
            start = best.steps_per_turn
            most = min(most, int(DEARER * best.cost_us / each))
        worst: dict[int, tuple[float, str]] = {}
        runs = 0

        def error_at(steps_per_turn: int) -> float:
            nonlocal runs
            errors = []
            for scene in goal.scenes:
                runs += 1
                error = error_of(self.row(scene, settings, steps_per_turn))
                errors.append((error, scene.name))
                if math.isinf(error):
                    break
            worst[steps_per_turn] = max(errors)
            return worst[steps_per_turn][0]

        reason, timed_out = "", False
        steps: int | None = None
        try:
            steps = coarsest(error_at, goal.target, start, goal.least, max(most, goal.least))
        except LostError as lost:
            reason, timed_out = str(lost), lost.timed_out
        over = [n for n, (error, _) in worst.items() if not error <= goal.target]
        tried = steps or min(over, key=lambda n: (worst[n][0], n), default=start)
        error, scene = worst[tried] if tried in (steps, *over) else (math.inf, "")
        cost_us = tried * each
        return Attempt(dict(settings), steps, tried, error, scene, cost_us, runs, reason, timed_out)


def error_of(row: Row) -> float:
    """Return the error of place of a run; infinite where it did not come to its end."""
    error = row["place_pure"]
    sound = row["status"] == "ok" and isinstance(error, float) and math.isfinite(error)
    return float(error) if sound and isinstance(error, float) else math.inf


ROUNDS = 12
"""Rounds of timing, one after the other: a slow minute then slows both."""
GUESS_US = 50.0
"""Guess of a step; high, so that a repeat is short: the least of many is hardly disturbed."""


@dataclass(frozen=True)
class Taken:
    """Measured times of the scenes together: of a step [microseconds] and of a turn [s].

    ``noise`` is the relative difference of two timings of the same cell.
    """

    us_per_step: float
    s_per_turn: float
    noise: float


def times(goal: Goal, attempts: Sequence[Attempt], limits: Limits) -> list[Taken] | None:
    """Time each attempt at its step; the least time of all rounds counts. None where one is lost.

    The A/A noise comes from the least times of odd and even rounds over all scenes.
    """
    cells = [goal.cell(scene, a.settings, a.tried) for a in attempts for scene in goal.scenes]
    with closing(Isolated[Repeats](limits)) as isolated:
        timings = timed_in_turns(isolated, [(cell, GUESS_US) for cell in cells], ROUNDS)
    least = [(min(timing[0]), min(timing[1])) for timing in timings if timing is not None]
    if len(least) < len(cells):
        return None
    each = len(goal.scenes)
    return [
        _taken(least[each * index : each * (index + 1)], attempt.tried)
        for index, attempt in enumerate(attempts)
    ]


def _taken(halves: Sequence[Sequence[float]], steps_per_turn: int) -> Taken:
    us = sum(min(half) for half in halves)
    a, b = (sum(half[k] for half in halves) for k in (0, 1))
    return Taken(us, 1e-6 * us * steps_per_turn, abs(a - b) / min(a, b))
