"""`crankcheck tune`: search an engine's settings for the cheapest that reach a target error."""

import math
from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path
from typing import Annotated

import numpy as np
from rich.console import Console
from rich.text import Text

from analytic.kinematics import solve
from models.errors import CrankcheckError
from models.files.reading import find_scenes, read_text
from reports.output.console import say_whole
from reports.output.write import crankcheck_version, provenance
from reports.plan import grid, requirements, singular
from reports.plan.steps import LEAST_STEPS_PER_TURN, MOST_SEARCHED, positive
from reports.requests.options import argument, output_option
from reports.tune.attempt import Attempt, Bench, Goal, LostError, Row, times
from reports.tune.search import Plan, attempts, best_of, check_storage, plainer, search, study_in
from reports.tune.table import Side, footer, show
from reports.workers import isolated, signals
from reports.workers.progress import progress_bar
from sim.engine import AT_ROUNDING, Settings, settings
from sim.registry import engine, offering
from sim.registry.offers import SearchSpace, search_space, snippet

PROFILE = "tuned"
"""The profile that is the start of the search, and compared with its result."""
MOST_BUDGET, MOST_SEED, COARSEST = 100_000, 2**32 - 1, 1.0


@dataclass(frozen=True)
class TuneRequest:
    scenes: Annotated[Sequence[str], argument("SCENE", "Shipped names or scene files.")]
    engine: Annotated[str, "Engine whose settings are searched."]
    target: Annotated[float, "Error to reach, as a pure number: rad, lengths over L."]
    budget: Annotated[int, "Trials in all, those of a resumed search included."] = 60
    seed: Annotated[int, "Seed; the same seed finds the same settings."] = 0
    turns: Annotated[float, "Turns of the driver in a run."] = 2.0
    output: Annotated[Path | None, output_option("Keep the search (.db), to continue later.")] = (
        None
    )
    limit_s: Annotated[float, "Longest time for a run, in seconds."] = 20.0
    timing: Annotated[bool, "Time the found settings beside the profile."] = True

    def run(self, console: Console, progress: Console) -> int:
        """Answer, and return the exit code: 0 when settings reach the target, 1 when none do.
        Raises CrankcheckError for a faulty request before the search."""
        goal = _goal(self)
        if note := requirements.left_out_note(self.scenes):
            say_whole(progress, note)
        base = settings.resolved(settings.profile_of(engine(goal.engine), goal.profile), None)
        space = search_space(goal.engine).around(base)
        if self.output is not None:
            check_storage(self.output)
        limits = isolated.Limits(self.limit_s)
        works = [space.work(scene, solve(scene, np.zeros(1)).state()) for scene in goal.scenes]
        with closing(Bench(goal, works, limits)) as bench:
            bench.refuse_unsupported(base)
            trials = _searched(self, bench, space, base, progress)
            best = best_of(trials)
            first = next(trial for trial in trials if dict(trial.settings) == dict(base))
            tried: list[Attempt] = []
            if best is not None:
                best, tried = plainer(space, first, best, bench.attempt)
            last = best or min(trials, key=lambda trial: trial.error)
            columns = {f"profile {goal.profile}": first, "found": last}
            sides = [Side(title, each, _rows(bench, each)) for title, each in columns.items()]
        if self.timing and (taken := times(goal, list(columns.values()), limits)):
            sides = [replace(side, taken=each) for side, each in zip(sides, taken, strict=True)]
        show(console, goal, space, sides)
        if best is None:
            console.print(Text(_unreached(goal, last), "bold red"))
        elif goal.engine in offering("snippet"):
            # To copy, at the speed of the first scene.
            period_s = goal.scenes[0].driver.law.period_s
            text = snippet(goal.engine, best.settings, float(best.tried), period_s)
            console.print()
            say_whole(console, text)
        around = len(goal.scenes) + sum(len(side.rows) for side in sides)
        facts = provenance({goal.engine: engine(goal.engine).version()})
        how = _how(self, trials, tried, around)
        console.print(Text(footer(goal, how, facts), "dim"), highlight=False)
        return 0 if best else 1


def _how(
    request: TuneRequest, trials: Sequence[Attempt], tried: Sequence[Attempt], around: int
) -> str:
    """Number of trials and runs; ``around`` are the runs before and after the search."""
    after = sum(each.runs for each in tried)
    late = sum(each.timed_out for each in (*trials, *tried))
    lost = (
        f" The time limit ended {late} of the trials (--limit-s {request.limit_s:g}), which are "
        "not kept: a search with quicker runs may have another result."
    )
    return (
        f"Seed {request.seed}: {len(trials)} trials, of which {sum(a.reached for a in trials)} "
        f"reach the target; {sum(a.runs for a in trials) + after + around} runs in all, {after} of "
        "them to set back settings without gain."
    ) + (lost if late else "")


def _goal(request: TuneRequest) -> Goal:
    target, budget, seed = request.target, request.budget, request.seed
    if not AT_ROUNDING <= target < COARSEST:
        raise CrankcheckError(
            f"--target {target:g}: give an error of place from {AT_ROUNDING:g}, which is rounding, "
            f"to under {COARSEST:g}, such as 1e-6"
        )
    if not 1 <= budget <= MOST_BUDGET:
        raise CrankcheckError(f"--budget {budget}: give a number of trials, 1 to {MOST_BUDGET}")
    if not 0 <= seed <= MOST_SEED:
        raise CrankcheckError(f"--seed {seed}: give a whole number, 0 to {MOST_SEED}")
    positive("--limit-s", request.limit_s, "seconds for a run, such as 20")
    if not request.scenes:
        raise CrankcheckError("tune: name a scene or several, such as fourbar-lecture-1")
    positive("--turns", request.turns, "turns; 1 is one period of the driver")
    name = requirements.chosen_engines([request.engine])[0]
    goal = Goal(
        tuple(requirements.chosen_scenes(request.scenes, requirements.rigid_alone("tune"))),
        name,
        PROFILE,
        target,
        request.turns,
    )
    if goal.most < goal.least:
        raise CrankcheckError(
            f"--turns {request.turns:g}: a run of a search has {MOST_SEARCHED} steps at most; take "
            f"{MOST_SEARCHED / (2 * LEAST_STEPS_PER_TURN):g} turns or less"
        )
    for scene in goal.scenes:
        duration_s = goal.turns * scene.driver.law.period_s
        singular.refuse_singular(scene, duration_s)
        singular.refuse_short_tables(scene, duration_s)
    return goal


def _searched(
    request: TuneRequest, bench: Bench, space: SearchSpace, base: Settings, progress: Console
) -> list[Attempt]:
    with study_in(request.output, _asked(request, bench, space, base)) as study:
        done = min(len(attempts(study)), request.budget)
        try:
            with progress_bar(progress, "trials", request.budget - done) as advance:
                plan = Plan(space, base, bench.goal.target, request.budget, request.seed)
                return search(study, plan, bench.attempt, advance)
        except signals.Stopped:
            if request.output is not None:
                say_whole(
                    progress,
                    f"{len(attempts(study))} of {request.budget} trials are kept in "
                    f"{request.output}; the same command continues from there",
                )
            raise


def _asked(
    request: TuneRequest, bench: Bench, space: SearchSpace, base: Settings
) -> dict[str, object]:
    """All facts that the results of the trials depend on, as plain values."""
    goal = bench.goal
    texts = [read_text(path) for path in find_scenes(request.scenes)]
    return {
        "scene": [scene.name for scene in goal.scenes],
        "scene text": list(dict.fromkeys(grid.digest(text) for text in texts)),
        "engine": goal.engine,
        "engine version": engine(goal.engine).version(),
        "crankcheck version": crankcheck_version(),
        "Optuna version": version("optuna"),
        "target": goal.target,
        "turns": goal.turns,
        "seed": request.seed,
        "limit_s": request.limit_s,
        "profile": dict(base),
        "knobs": {knob.name: list(knob.values) for knob in space.knobs},
        "starts": [dict(start) for start in space.starts],
        "model of cost": [work(base) for work in bench.works],
        "measure": grid.MEASURE,
    }


def _rows(bench: Bench, of: Attempt) -> list[Row]:
    """The rows of an attempt at its step, one per scene; none where one is lost."""
    try:
        return [bench.row(scene, of.settings, of.tried) for scene in bench.goal.scenes]
    except LostError:
        return []


def _unreached(goal: Goal, nearest: Attempt) -> str:
    if nearest.reason:
        return f"NOTHING REACHES {goal.target:g}; {nearest.reason}"
    if math.isinf(nearest.error):
        return f"NOTHING REACHES {goal.target:g}: no run came to its end"
    return (
        f"NOTHING REACHES {goal.target:g}: nearest is {nearest.error:.2e} in {nearest.scene} with "
        f"{nearest.tried} steps per turn; take a larger target, or a larger --budget"
    )
