"""The search: Optuna proposes values of the knobs, each is tried, the cheapest that reaches wins.

Everything is a function of seed and of what the trials before found, down to the sampler, which is
made anew from seed and place of every trial: the same seed finds the same settings, also where a
search is ended and taken up again. Only a run that the clock ends is none: its trial fails, and its
place is open when the search is taken up again, to the same settings.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
from optuna.distributions import BaseDistribution, CategoricalDistribution, IntDistribution
from optuna.samplers import TPESampler
from optuna.study import Study
from optuna.trial import Trial, TrialState

from reports.plan.coarsest import RESOLUTION
from reports.tune.attempt import Attempt
from sim.engine import Settings, SettingValue
from sim.offers import Knob, SearchSpace, Values

FOUND = "found"
"""Where a trial keeps its attempt."""
PLACE = "place"
"""Where a trial keeps its number among those that came to an end, also one that the clock ended."""
Try = Callable[[Settings, Attempt | None], Attempt]


def attempts(study: Study) -> dict[int, Attempt]:
    """From place to what the trial there found; what the clock ended is not among it."""
    complete = study.get_trials(deepcopy=False, states=(TrialState.COMPLETE,))
    return {trial.user_attrs[PLACE]: Attempt(**trial.user_attrs[FOUND]) for trial in complete}


def best_of(tried: Iterable[Attempt]) -> Attempt | None:
    """The cheapest that reaches the target, the first of equals; None where none does."""
    return min((a for a in tried if a.reached), key=lambda a: a.cost_us, default=None)


@dataclass(frozen=True)
class Plan:
    """How to search: around which complete settings, in how many trials."""

    space: SearchSpace
    profile: Settings
    target: float
    budget: int
    seed: int


def search(
    study: Study, plan: Plan, attempt: Try, advance: Callable[[], None] = lambda: None
) -> list[Attempt]:
    """Fill the study up to the budget; the trials that it has count.

    The starts of the space come first. Settings that were tried before are not run again, and the
    trial counts. Returns the attempts of all trials that there are, also of those that the clock
    ended just now, which the study does not keep.
    """
    by_place = attempts(study)
    for place in (each for each in range(plan.budget) if each not in by_place):
        trial, values = _asked(study, plan, place)
        settings = plan.space.settings(plan.profile, values)
        so_far = [by_place[each] for each in sorted(by_place)]
        before = next((a for a in so_far if dict(a.settings) == settings), None)
        outcome = replace(before, runs=0) if before else attempt(settings, best_of(so_far))
        _tell(study, plan, trial, place, outcome)
        by_place[place] = outcome
        advance()
    return [by_place[place] for place in sorted(by_place)]


def _tell(study: Study, plan: Plan, trial: Trial, place: int, outcome: Attempt) -> None:
    """Keep what a trial found; where the clock ended it, only that it is to be tried again."""
    trial.set_user_attr(PLACE, place)
    if outcome.timed_out:
        study.tell(trial, state=TrialState.FAIL)
        return
    trial.set_user_attr(FOUND, asdict(outcome))
    trial.set_constraint("decades over the target", outcome.over(plan.target))
    study.tell(trial, outcome.cost_us)


def plainer(
    space: SearchSpace, first: Attempt, best: Attempt, attempt: Try
) -> tuple[Attempt, list[Attempt]]:
    """The best with every knob back at the profile's value that it gains nothing by.

    ``first`` is the attempt of the profile itself, which is taken where it is as cheap. Also
    returns what was tried. As cheap counts what the step is not resolved to.
    """
    tried: list[Attempt] = []
    most_us = RESOLUTION * best.cost_us
    if first.reached and first.cost_us <= most_us:
        return first, tried
    simplest = best
    for knob in space.knobs:
        back = {name: first.settings[name] for name in knob.targets}
        if any(simplest.settings[name] != value for name, value in back.items()):
            tried.append(attempt({**simplest.settings, **back}, best))
            if tried[-1].reached and tried[-1].cost_us <= most_us:
                simplest = tried[-1]
    return simplest, tried


def _asked(study: Study, plan: Plan, place: int) -> tuple[Trial, Values]:
    """The next trial, and the values that it stands for.

    ``place`` counts the trials that came to an end, not those that were cut short.
    """
    study.sampler = TPESampler(
        seed=int(np.random.SeedSequence([plan.seed, place]).generate_state(1)[0]),
        constant_liar=False,  # a trial that was cut short is to leave no trace
    )
    space = plan.space
    if not study.get_trials(states=(TrialState.WAITING,)):
        given = _timed_out(study).get(place)
        if given is None and place < len(space.starts):
            start = space.starts[place]
            given = {knob.name: _place(knob, start[knob.name]) for knob in space.knobs}
        if given is not None:
            study.enqueue_trial(given)
    trial = study.ask({knob.name: _distribution(knob) for knob in space.knobs})
    return trial, {k.name: _value(k, trial.params[k.name]) for k in space.knobs}


def _timed_out(study: Study) -> dict[int, dict[str, Any]]:
    """From place to what was tried there when the clock ended it."""
    failed = study.get_trials(deepcopy=False, states=(TrialState.FAIL,))
    return {t.user_attrs[PLACE]: dict(t.params) for t in failed if PLACE in t.user_attrs}


def _distribution(knob: Knob) -> BaseDistribution:
    """Numbers are searched by their place in the order, words as they are."""
    if knob.ordered:
        return IntDistribution(0, len(knob.values) - 1)
    return CategoricalDistribution([str(value) for value in knob.values])


def _place(knob: Knob, value: SettingValue) -> int | str:
    """What Optuna knows a value as."""
    return knob.values.index(value) if knob.ordered else str(value)


def _value(knob: Knob, place: int | str) -> SettingValue:
    """The value that Optuna means."""
    return knob.values[place] if isinstance(place, int) else place
