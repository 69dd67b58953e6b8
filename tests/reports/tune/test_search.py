"""The search over the knobs, on settings whose cost and error are known; and the file that it is
kept in: only the one that is asked for is gone on with."""

import contextlib
import math
import os
import sqlite3
import sys
from collections.abc import Callable, Collection
from dataclasses import dataclass, field, replace
from pathlib import Path

import optuna
import pytest
from optuna.trial import TrialState

from models.errors import CrankcheckError
from reports.tune.attempt import Attempt
from reports.tune.search import (
    Plan,
    Try,
    attempts,
    best_of,
    check_storage,
    plainer,
    search,
    study_in,
)
from reports.workers.signals import Stopped
from sim.engine import Settings
from sim.registry.offers import Knob, SearchSpace
from tests.worlds.tiers import slow

PROFILE = {"stiffness": 10.0, "idle": 3, "kind": "slow", "fixed": 7}
SPACE = SearchSpace(
    knobs=(
        Knob("stiffness", tuple(float(x) for x in range(1, 41))),
        Knob("idle", (1, 2, 3, 4, 5)),
        Knob("kind", ("slow", "fast", "wrong")),
    ),
    starts=({"kind": "wrong"},),
    work=lambda scene: lambda settings: 1.0,
).around(PROFILE)


def known(settings: Settings, best: Attempt | None) -> Attempt:
    """The best stiffness is 23; ``idle`` does nothing; ``wrong`` is cheap, and never reaches the
    target."""
    off = abs(float(settings["stiffness"]) - 23.0)
    cost = (100.0 + off) * {"fast": 1.0, "slow": 4.0, "wrong": 0.5}[str(settings["kind"])]
    reached = settings["kind"] != "wrong"
    steps = 100 if reached else None
    return Attempt(dict(settings), steps, 100, 0.9 if reached else 5.0, "a scene", cost, 3)


def plan(budget: int = 14, seed: int = 0) -> Plan:
    return Plan(SPACE, PROFILE, target=1.0, budget=budget, seed=seed)


def done(budget: int = 14, seed: int = 0, attempt: Try = known) -> list[Attempt]:
    with study_in(None, {}) as study:
        return search(study, plan(budget, seed), attempt)


@dataclass
class Called:
    """What is `known`, and what was asked; Ctrl-C comes instead of the call after ``stop`` of them,
    and the clock ends those in ``late``."""

    stop: float = math.inf
    late: Collection[int] = ()
    settings: list[Settings] = field(default_factory=list)
    bests: list[Attempt | None] = field(default_factory=list)

    def __call__(self, settings: Settings, best: Attempt | None) -> Attempt:
        number = len(self.bests)
        if number >= self.stop:
            raise Stopped(2)
        self.settings.append(dict(settings))
        self.bests.append(best)
        ended = {"steps_per_turn": None, "reason": "timeout", "timed_out": True}
        return replace(known(settings, best), **ended if number in self.late else {})


def costing(settings: Settings, cost_us: float) -> Attempt:
    return Attempt(dict(settings), 100, 100, 0.9, "a scene", cost_us, 1)


def test_the_profile_is_tried_first_and_then_what_the_seed_says() -> None:
    assert done(seed=1) == done(seed=1)
    one, other = ([a.settings for a in done(seed=seed)] for seed in (1, 2))
    assert one != other
    assert one[:2] == other[:2] == [PROFILE, {**PROFILE, "kind": "wrong"}]
    found = done(budget=5)
    assert best_of(found).cost_us <= found[0].cost_us


def test_the_search_beats_as_many_guesses_and_leaves_what_is_cheap_and_misses() -> None:
    found = done(budget=40)
    best = best_of(found)
    assert best.settings["kind"] == "fast"
    assert abs(float(best.settings["stiffness"]) - 23.0) <= 1.0
    assert {a.settings["fixed"] for a in found} == {7}, "that is no knob"
    kinds = [a.settings["kind"] for a in found[12:]]
    assert kinds.count("fast") > 2 * kinds.count("wrong")


def test_every_attempt_is_told_the_best_so_far_which_is_none_where_nothing_reaches() -> None:
    done(attempt=(called := Called()))
    first, *later = called.bests
    assert first is None
    told = [best.cost_us for best in later]
    assert told == sorted(told, reverse=True)
    assert told[-1] < told[0]

    def never(settings: Settings, best: Attempt | None) -> Attempt:
        assert best is None
        far = 2.0 + float(settings["stiffness"])
        return replace(known(settings, best), steps_per_turn=None, error=far)

    assert best_of(done(attempt=never)) is None


def test_a_search_that_was_cut_short_goes_on_to_what_a_whole_one_finds(path: Path) -> None:
    with pytest.raises(Stopped), study_in(path, {}) as study:
        search(study, plan(), Called(stop=7))
    with study_in(path, {}) as study:
        states = [trial.state for trial in study.trials]
        assert states == [TrialState.COMPLETE] * 7 + [TrialState.FAIL]
        found = search(study, plan(), called := Called())
        assert search(study, plan(4), Called(stop=0)) == found  # a smaller budget runs nothing
    own = optuna.load_study(study_name=None, storage=f"sqlite:///{path}")
    assert own.best_value == best_of(found).cost_us
    whole = done()
    assert found == whole
    assert len(called.settings) == sum(a.runs > 0 for a in whole) - 7


def test_what_gains_nothing_is_set_back_and_many_small_losses_do_not_add_up() -> None:
    best = known({**PROFILE, "kind": "fast", "idle": 5, "stiffness": 23.0}, None)
    found, tried = plainer(SPACE, known(PROFILE, None), best, known)
    assert found.settings == {**PROFILE, "kind": "fast", "stiffness": 23.0}
    assert len(tried) == 3
    knobs = tuple(Knob(f"k{i}", (0, 1)) for i in range(4))
    profile = dict.fromkeys((k.name for k in knobs), 0)

    def each_a_bit(settings: Settings, best: Attempt | None) -> Attempt:
        return costing(settings, 100.0 + 0.6 * sum(settings[k.name] == 0 for k in knobs))

    best = each_a_bit(dict.fromkeys(profile, 1), None)
    found, _ = plainer(replace(SPACE, knobs=knobs), each_a_bit(profile, None), best, each_a_bit)
    assert found.cost_us <= 1.01 * best.cost_us
    assert found.settings["k0"] == 0


def test_a_profile_that_is_as_cheap_is_taken_as_it_is() -> None:
    """A knob set back alone may cost more than the profile does, and still be as good as equal."""

    def costs(settings: Settings, best: Attempt | None) -> Attempt:
        values = (settings["k0"], settings["k1"])
        return costing(settings, {(0, 0): 100.5, (1, 1): 100.0}.get(values, 100.9))

    space = replace(SPACE, knobs=(Knob("k0", (0, 1)), Knob("k1", (0, 1))))
    first, best = (costs(dict.fromkeys(("k0", "k1"), k), None) for k in (0, 1))
    assert plainer(space, first, best, costs) == (first, [])


@slow("two seconds: three searches; what the clock ended is told in test_tune.py")
def test_what_the_clock_ended_is_not_kept_and_tried_anew(path: Path) -> None:
    with study_in(path, {}) as study:
        once = search(study, plan(), Called(late=(0, 5, 13)))
        kept = attempts(study)
    lost = [a for a in once if a.timed_out]
    assert len(lost) >= 3
    assert kept == {place: a for place, a in enumerate(once) if not a.timed_out}
    with study_in(path, {}) as study:
        again = search(study, plan(), called := Called())
        assert attempts(study) == dict(enumerate(again))
        assert search(study, plan(), Called(stop=0)) == again
    assert called.settings == [a.settings for a in lost if a.runs]
    assert [a.settings for a in again] == [a.settings for a in once]


@pytest.mark.parametrize("late", [(), range(40)], ids=["in time", "ended by the clock"])
def test_settings_are_tried_once_and_progress_is_told_of_each_trial(late: Collection[int]) -> None:
    space, called, told = replace(SPACE, knobs=SPACE.knobs[1:]), Called(late=late), []
    with study_in(None, {}) as study:
        found = search(study, replace(plan(40), space=space), called, lambda: told.append(None))
        assert len(found) == len(told) == 40
        assert len(attempts(study)) == (0 if late else 40)
    assert len(called.settings) == len({str(each) for each in called.settings}) <= 15
    assert sum(a.runs for a in found) == 3 * len(called.settings)


ASKED = {"engine": "mujoco", "target": 1e-6, "profile": {"iterations": 2}}


def test_a_study_is_gone_on_with_where_all_is_as_before_and_else_refused(path: Path) -> None:
    path.touch()  # an empty file is taken, and one of another ending is not
    with pytest.raises(CrankcheckError, match=r"found '\.txt'; use \.db"):
        check_storage(path.with_suffix(".txt"))
    check_storage(path)
    with study_in(path, ASKED) as study:
        study.add_trial(optuna.create_trial(value=1.0))
    check_storage(path)
    with study_in(path, ASKED) as study:
        assert len(study.trials) == 1
    assert sorted(each.name for each in path.parent.iterdir()) == [".kept.db.lock", "kept.db"]
    for name, value, words in (
        ("target", 1e-4, "holds a search with target 1e-06; requested was target 0.0001"),
        (
            "profile",
            {"iterations": 3},
            'with profile {"iterations": 2}; requested was profile {"it',
        ),
    ):
        with pytest.raises(CrankcheckError, match=words), study_in(path, {**ASKED, name: value}):
            pass


def test_any_name_of_a_file_is_that_of_the_file(tmp_path: Path) -> None:
    with study_in(tmp_path / "100%.db", ASKED), study_in(tmp_path / "what?.db", ASKED):
        pass
    names = [".100%.db.lock", ".what?.db.lock", "100%.db", "what?.db"]
    assert sorted(each.name for each in tmp_path.iterdir()) == names


def notes(path: Path) -> None:
    path.write_text("my notes", encoding="utf-8")


def shop(path: Path) -> None:
    with contextlib.closing(sqlite3.connect(path)) as base:
        base.execute("CREATE TABLE orders (number INTEGER)")
        base.commit()


def theirs(path: Path) -> None:
    optuna.create_study(storage=f"sqlite:///{path}", study_name="theirs")


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (notes, "holds something else; name a new file"),
        (shop, "holds something else; name a new file"),
        (theirs, "Optuna file with the study 'theirs'"),
        (os.mkfifo, "not a plain file; name a new file"),  # and it is not waited for
    ],
)
def test_other_files_are_refused_whole(make: Callable[..., None], words: str, path: Path) -> None:
    make(path)
    before = path.read_bytes() if path.is_file() else None
    with pytest.raises(CrankcheckError, match=words):
        check_storage(path)
    assert (path.read_bytes() if path.is_file() else None) == before


@pytest.mark.skipif(sys.platform == "win32", reason="no file that is open is removed there")
def test_a_search_that_comes_as_another_ends_locks_out_a_third(path: Path) -> None:
    """The second has opened the file of the lock while the first held it; the third comes late."""
    import fcntl

    with study_in(path, ASKED):
        second = path.with_name(".kept.db.lock").open("ab")
    with second:
        fcntl.flock(second, fcntl.LOCK_EX | fcntl.LOCK_NB)
        writes = "another search writes there now"
        with pytest.raises(CrankcheckError, match=writes), study_in(path, ASKED):
            pass


def test_a_file_that_can_no_more_be_written_is_told_without_a_traceback(path: Path) -> None:

    def broken() -> None:
        with study_in(path, ASKED) as study, contextlib.closing(sqlite3.connect(path)) as base:
            base.execute("DROP TABLE trials")
            base.commit()
            study.ask()

    with pytest.raises(CrankcheckError, match=r"-o .*kept\.db: .*name another file"):
        broken()
