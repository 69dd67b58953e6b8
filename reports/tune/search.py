"""The search: Optuna proposes values of the knobs, each is tried, the cheapest that reaches wins.

Everything is a function of the seed and of the results of earlier trials, down to the sampler,
which is made again from seed and place of every trial: the same seed finds the same settings, also
where a search is ended and resumed. Only a run that the clock ends is an exception: its trial
fails, and its place is open to the same settings when the search is resumed.
"""

import contextlib
import json
import sqlite3
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import optuna
from filelock import FileLock, Timeout
from optuna.distributions import BaseDistribution, CategoricalDistribution, IntDistribution
from optuna.exceptions import StorageInternalError
from optuna.samplers import TPESampler
from optuna.storages import BaseStorage, InMemoryStorage, RDBStorage
from optuna.study import Study
from optuna.trial import Trial, TrialState
from sqlalchemy import URL
from sqlalchemy.exc import SQLAlchemyError

from models.errors import CrankcheckError, cut
from reports.output.write import check_file
from reports.plan.steps import RESOLUTION
from reports.tune.attempt import Attempt
from sim.engine import Settings, SettingValue
from sim.registry.offers import Knob, SearchSpace, Values

FOUND = "found"
"""Key of a trial's attempt."""
PLACE = "place"
"""Key of a trial's number among those that came to an end, also one that the clock ended."""
Try = Callable[[Settings, Attempt | None], Attempt]


def attempts(study: Study) -> dict[int, Attempt]:
    """Return the attempts by place; trials that the clock ended are not among them."""
    complete = study.get_trials(deepcopy=False, states=(TrialState.COMPLETE,))
    return {trial.user_attrs[PLACE]: Attempt(**trial.user_attrs[FOUND]) for trial in complete}


def best_of(tried: Iterable[Attempt]) -> Attempt | None:
    """Return the cheapest that reaches the target, the first of equals; None where none does."""
    return min((a for a in tried if a.reached), key=lambda a: a.cost_us, default=None)


@dataclass(frozen=True)
class Plan:
    """Plan of a search: complete settings to start from, and the number of trials."""

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
    trial counts. Returns the attempts of all trials that there are, also those that the clock ended
    just now, which the study does not keep.
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
    """Keep the attempt of a trial; where the clock ended it, only that it is to be tried again."""
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
    """Return the best, each knob back at the profile's value if that costs nothing.

    ``first`` is the attempt of the profile itself, which is taken where it is as cheap. Also
    returns the attempts. Costs within the resolution of the step count as equal.
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
    """Return the next trial, and its values.

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
    """Return the parameters that were tried at a place when the clock ended it, by place."""
    failed = study.get_trials(deepcopy=False, states=(TrialState.FAIL,))
    return {t.user_attrs[PLACE]: dict(t.params) for t in failed if PLACE in t.user_attrs}


def _distribution(knob: Knob) -> BaseDistribution:
    """Return a distribution: numbers by their place in the order, words as they are."""
    if knob.ordered:
        return IntDistribution(0, len(knob.values) - 1)
    return CategoricalDistribution([str(value) for value in knob.values])


def _place(knob: Knob, value: SettingValue) -> int | str:
    return knob.values.index(value) if knob.ordered else str(value)


def _value(knob: Knob, place: int | str) -> SettingValue:
    return knob.values[place] if isinstance(place, int) else place


NAME = "crankcheck tune"
ASKED = "asked"
ENDINGS = (".db", ".sqlite", ".sqlite3")
MAGIC = b"SQLite format 3\0"
Asked = Mapping[str, object]


def check_storage(path: Path) -> None:
    """Refuse a file that no search can be kept in, before anything runs. Raises CrankcheckError."""
    check_file(path, "-o", ENDINGS, edited=True)
    if not path.exists():
        return
    if not path.is_file():  # a pipe would be waited for
        raise CrankcheckError(f"-o {path}: not a plain file; name a new file")
    if path.stat().st_size == 0:
        return
    names = _names(path)
    if names is None:
        raise CrankcheckError(f"-o {path}: holds something else; name a new file")
    if names not in ([], [NAME]):
        raise CrankcheckError(
            f"-o {path}: an Optuna file with the study {names[0]!r}, which is not of crankcheck "
            "tune; name a new file"
        )


def _names(path: Path) -> list[str] | None:
    """Return the studies in a file of Optuna; None for any other."""
    try:
        with path.open("rb") as file:
            if file.read(len(MAGIC)) != MAGIC:
                return None
        with contextlib.closing(sqlite3.connect(path)) as base:
            tables = {row[0] for row in base.execute("SELECT name FROM sqlite_master")}
            if not tables:
                return []
            if "studies" not in tables:
                return None
            return [row[0] for row in base.execute("SELECT study_name FROM studies")]
    except (OSError, sqlite3.Error):
        return None


@contextmanager
def study_in(path: Path | None, asked: Asked) -> Iterator[Study]:
    """Yield the study of a file, new or to be resumed; in memory for None.

    Trials that were cut short are marked as failed: they count for nothing.

    Raises
    ------
    CrankcheckError
        The file holds a search for something else, another search writes to it now, or it can not
        be written.
    """
    optuna.logging.set_verbosity(optuna.logging.ERROR)
    optuna.logging.disable_default_handler()
    try:
        with _locked(path):
            yield _opened(path, asked)
    except (StorageInternalError, SQLAlchemyError) as error:
        why = " ".join(str(error.__cause__ or error).split())[:200]
        raise CrankcheckError(f"-o {path}: {why}; name another file") from None


@contextmanager
def _locked(path: Path | None) -> Iterator[None]:
    """Run the block in one search at a time. The file of the lock stays: removed, it would let one
    search lock the old file, one a new. Raises CrankcheckError."""
    if path is None:
        yield
        return
    lock = FileLock(path.with_name(f".{path.name}.lock"), timeout=0)
    try:
        lock.acquire()
    except Timeout:
        raise CrankcheckError(
            f"-o {path}: another search writes there now; wait for it, or choose another"
        ) from None
    except OSError as error:
        raise CrankcheckError(
            f"-o {path}: {lock.lock_file} can not be locked: {error.strerror or error}; remove it, "
            "or choose another place"
        ) from None
    try:
        yield
    finally:
        lock.release()


def _opened(path: Path | None, asked: Asked) -> Study:
    """Return the study, with its request stored or compared."""
    try:
        storage = _storage(path)
    except RuntimeError as error:  # of another version of Optuna
        raise CrankcheckError(f"-o {path}: {error}; name another file") from None
    study = optuna.create_study(
        storage=storage, study_name=NAME, load_if_exists=True, direction="minimize"
    )
    earlier = study.user_attrs.get(ASKED)
    if earlier is None:
        study.set_user_attr(ASKED, dict(asked))
    elif path is not None:
        _refuse_other(path, earlier, json.loads(json.dumps(asked)))
    for trial in study.get_trials(deepcopy=False, states=(TrialState.RUNNING,)):
        study.tell(trial.number, state=TrialState.FAIL)
    return study


def _storage(path: Path | None) -> BaseStorage:
    if path is None:
        return InMemoryStorage()
    url = URL.create("sqlite", database=str(path.resolve()))
    return RDBStorage(url.render_as_string(hide_password=False))


def _refuse_other(path: Path, earlier: Asked, asked: Asked) -> None:
    """Refuse to resume a search for something else, and say how it differs."""
    for name in asked:
        if earlier.get(name) != asked[name]:
            was, now = _short(earlier.get(name)), _short(asked[name])
            raise CrankcheckError(
                f"-o {path}: holds a search with {name} {was}; requested was {name} {now}: name "
                "another file, or use the same options"
            )


def _short(value: object) -> str:
    return cut(value if isinstance(value, str) else json.dumps(value))
