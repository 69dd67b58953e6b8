"""The search: Optuna proposes values of the knobs, each is tried, the cheapest that reaches wins.

Everything is a function of seed and of what the trials before found, down to the sampler, which is
made anew from seed and number of every trial: the same seed finds the same settings, also where a
search is ended and taken up again.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from optuna.distributions import BaseDistribution, CategoricalDistribution, IntDistribution
from optuna.samplers import TPESampler
from optuna.study import Study
from optuna.trial import FrozenTrial, Trial, TrialState

from reports.tuning.attempt import Attempt
from reports.tuning.coarsest import RESOLUTION
from reports.tuning.cost import Settings
from reports.tuning.knobs import Knob, Space, Values
from sim.engine import SettingValue

FOUND = "found"
"""Where a trial keeps its attempt."""
Try = Callable[[Settings, Attempt | None], Attempt]


def attempts(study: Study) -> list[Attempt]:
    """What the trials of a study found, in order."""
    complete = study.get_trials(deepcopy=False, states=(TrialState.COMPLETE,))
    return [_attempt(trial) for trial in complete]


def best_of(found: list[Attempt]) -> Attempt | None:
    """The cheapest that reaches the target, the first of equals; None where none does."""
    return min((a for a in found if a.reached), key=lambda a: a.cost_us, default=None)


def nearest_of(found: list[Attempt]) -> Attempt:
    """The one with the least error; there has to be one."""
    return min(found, key=lambda a: a.error)


@dataclass(frozen=True)
class Plan:
    """How to search: around which complete settings, in how many trials."""

    space: Space
    profile: Settings
    target: float
    budget: int
    seed: int


def search(
    study: Study, plan: Plan, attempt: Try, advance: Callable[[], None] = lambda: None
) -> list[Attempt]:
    """Fill the study up to the budget; the trials that it has count.

    The starts of the space come first. Settings that were tried before are not run again, and the
    trial counts. Returns the attempts of all trials that there are.
    """
    known = attempts(study)
    while len(known) < plan.budget:
        trial, values = _asked(study, plan, len(known))
        settings = plan.space.settings(plan.profile, values)
        before = next((a for a in known if dict(a.settings) == settings), None)
        found = replace(before, runs=0) if before else attempt(settings, best_of(known))
        trial.set_user_attr(FOUND, found.plain())
        trial.set_constraint("decades over the target", found.over(plan.target))
        study.tell(trial, found.cost_us)
        known.append(found)
        advance()
    return known


def plainer(
    space: Space, profile: Settings, best: Attempt, attempt: Try
) -> tuple[Attempt, list[Attempt]]:
    """The best with every knob back at the profile's value that it gains nothing by.

    Also returns what was tried for it. As cheap counts what the step is not resolved to.
    """
    tried = []
    held = best
    for knob in space.knobs:
        back = {name: profile[name] for name in knob.targets}
        if any(held.settings[name] != value for name, value in back.items()):
            found = attempt({**held.settings, **back}, best)
            tried.append(found)
            if found.reached and found.cost_us <= RESOLUTION * best.cost_us:
                held = found
    return held, tried


def _asked(study: Study, plan: Plan, index: int) -> tuple[Trial, Values]:
    """The next trial, and the values that it stands for.

    ``index`` counts the trials that came to an end, not those that were cut short.
    """
    study.sampler = TPESampler(
        seed=int(np.random.SeedSequence([plan.seed, index]).generate_state(1)[0]),
        constant_liar=False,  # a trial that was cut short is to leave no trace
    )
    space = plan.space
    if index < len(space.starts) and not study.get_trials(states=(TrialState.WAITING,)):
        start = space.starts[index]
        study.enqueue_trial({knob.name: _place(knob, start[knob.name]) for knob in space.knobs})
    trial = study.ask({knob.name: _distribution(knob) for knob in space.knobs})
    return trial, {k.name: _value(k, trial.params[k.name]) for k in space.knobs}


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


def _attempt(trial: FrozenTrial) -> Attempt:
    return Attempt(**trial.user_attrs[FOUND])
