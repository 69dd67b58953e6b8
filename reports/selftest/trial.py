"""The faults by name: plant one, see which rules fail, and find the size from which on its own rule
does.

The runs are short: one turn, or a second of free motion; profile tuned. A fault is caught where the
rule that it names fails at the size planted, while the same run without it, and with it at size 0,
passes every rule.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from typing import cast

from models.errors import CrankcheckError, EngineError, suggestion
from models.files.reading import load_scene
from models.scene import Scene
from reports.judge.cell import Checked, check, examined
from reports.judge.rules.rule import Finding
from reports.protocol.way import own_parts
from reports.selftest.fault import PROFILE, STEPS, Fault, FaultRuns, FaultSet, RunKind, Unseen
from reports.workers.isolated import Limits, Lost, run_all
from sim.engine.settings import profile_of, resolved
from sim.registry import ENGINES, apart, engine

_SETS = [cast(FaultSet, each) for each in own_parts("faults").values()]
RUNS: dict[RunKind, FaultRuns] = {kind: runs for each in _SETS for kind, runs in each.runs.items()}
"""Runs by kind."""
GROUPS = {group: title for runs in RUNS.values() for group, title in runs.groups.items()}
_KINDS = {group: kind for kind, runs in RUNS.items() for group in runs.groups}
FAULTS: dict[str, Fault] = {
    fault.name: replace(fault, kind=_KINDS[fault.group]) for each in _SETS for fault in each.faults
}
"""Faults by name; a further fault goes into the module of its group."""


def chosen_faults(
    names: Sequence[str], engines: Iterable[str], kind: RunKind = "motion"
) -> list[Fault]:
    """Return the named faults, each once, or all that are planted in runs of a kind, where one of
    the engines can have them.

    Raises
    ------
    CrankcheckError
        An unknown name (the message suggests near ones), or one that these engines can not have.
    """
    chosen = set(engines)
    for name in names:
        if name not in FAULTS:
            hint = suggestion(name, FAULTS, "use")
            raise CrankcheckError(f"--fault {name!r}: unknown; {hint}")
        if not any(map(FAULTS[name].possible, chosen)):
            able = " and ".join(FAULTS[name].engines) or "engines that are not installed"
            raise CrankcheckError(
                f"--fault {name}: it can be planted in {able} only; "
                f"found --engine {', '.join(sorted(chosen))}"
            )
    kinds = (kind, *RUNS[kind].also)
    every = [name for name, fault in FAULTS.items() if fault.kind in kinds]
    order = dict.fromkeys(names or every)
    return [FAULTS[name] for name in order if any(map(FAULTS[name].possible, chosen))]


DECADES = 12
"""Powers of ten below the planted size that are tried."""
CLOSE = 1.1
"""Ratio of sizes at which the search ends."""
LIMITS = Limits(600.0, 4.0)
"""Limits of a fault: it takes some seconds, with the search for its smallest size."""


@dataclass(frozen=True)
class FaultTrial:
    """A fault in one scene and engine, and its result.

    ``finding`` is the failure of the rule that should fail, None where it passed; ``failed`` are
    all rules that failed. ``false`` are rules that fail with a size of 0. ``least`` is the smallest
    size that is caught, 0 where every tried size was, None where there is no size or the fault
    escapes; ``nothing`` says that it escapes because every error equals that of size 0, to the last
    bit.
    """

    scene: str
    engine: str
    finding: Finding | None
    failed: tuple[str, ...]
    false: tuple[str, ...]
    least: float | None
    nothing: bool = False


@dataclass(frozen=True)
class Verdict:
    """A fault, by name, in all its places; ``sound`` says that the runs without it pass every rule.
    There are no places where the fault ended the process, or took too much: ``lost`` says which."""

    name: str
    places: tuple[FaultTrial, ...]
    sound: bool
    lost: str = ""

    @property
    def fault(self) -> Fault:
        return FAULTS[self.name]

    @property
    def caught(self) -> bool:
        """True if the named rule fails, everywhere, and no rule does without the fault."""
        seen_everywhere = all(
            place.finding is not None and not place.false for place in self.places
        )
        return self.sound and seen_everywhere and bool(self.places)

    def least(self, engine: str) -> float | None:
        """Return the size that is caught in every scene of an engine; None where there is none."""
        sizes = [place.least for place in self.places if place.engine == engine]
        caught = [size for size in sizes if size is not None]
        return max(caught) if caught and len(caught) == len(sizes) else None


@cache
def healthy(scene: str, engine: str, steps: int = STEPS, kind: RunKind = "motion") -> Checked:
    """Return a run of a kind without any fault."""
    return check(RUNS[kind].cell(load_scene(scene), engine, steps, True))


def sites(faults: Sequence[Fault], engines: Sequence[str]) -> list[tuple[str, str]]:
    """Return the scenes and engines that the faults are planted in."""
    there = [name for name in dict.fromkeys((*ENGINES, *engines)) if name in engines]
    pairs = {(s, e): f.kind for f in faults for s in f.scenes for e in there if f.possible(e)}
    return [(scene, name) for (scene, name), kind in pairs.items() if held(scene, name, kind)]


@cache
def held(scene: str, name: str, kind: RunKind = "motion") -> bool:
    """True if an engine can hold a scene; not every engine of a user's own has every joint."""
    adapter, cell = engine(name), RUNS[kind].cell(load_scene(scene), name, STEPS, False)
    settings = resolved(profile_of(adapter, PROFILE), None)
    try:
        adapter.open(cell.given, cell.truth.start, settings, cell.dt_s, cell.drive)
    except EngineError:
        return False
    return True


def tried(name: str, engines: Sequence[str], steps: int = STEPS, search: bool = True) -> Verdict:
    """Plant the fault of that name in all its places; ``search`` for the smallest sizes too."""
    fault = FAULTS[name]
    pairs = sites([fault], engines)
    sound = all(passes(healthy(scene, engine, steps, fault.kind)) for scene, engine in pairs)
    places = [_place(fault, load_scene(scene), engine, steps, search) for scene, engine in pairs]
    return Verdict(name, tuple(places), sound)


@dataclass(frozen=True)
class Passed:
    """A deviation that need not be seen, by engine the rules that fail all the same, and the
    engines in which nothing was planted."""

    unseen: Unseen
    failed: Mapping[str, tuple[str, ...]]
    nothing: tuple[str, ...]


def passed_by(engines: Sequence[str], kind: RunKind = "motion", steps: int = STEPS) -> list[Passed]:
    """Plant the deviations that need not be seen, in one scene."""
    runs = RUNS[kind]
    able = [name for name in engines if held(runs.unseen_in, name, kind)]
    return [_passed(each, load_scene(runs.unseen_in), able, steps, kind) for each in runs.unseen]


def _passed(
    each: Unseen, scene: Scene, engines: Sequence[str], steps: int, kind: RunKind
) -> Passed:
    failed, nothing = {}, []
    for name in filter(each.needs, engines):
        cell = RUNS[kind].cell(scene, name, steps, False)
        full, none = (examined(cell, each.plant(size))[0] for size in (1.0, 0.0))
        failed[name] = tuple(finding.rule for finding in full.failures)
        nothing += [name] * (each.shows and full.errors == none.errors)
    return Passed(each, failed, tuple(nothing))


def tried_all(
    names: Sequence[str], engines: Sequence[str], jobs: int, done: Callable[[Verdict], None]
) -> list[Verdict]:
    """Plant all faults, in ``jobs`` processes (0: one per processor)."""
    work = partial(tried, engines=engines)
    return run_all(work, names, jobs, LIMITS, _lost, done, apart(engines))


def _lost(name: str, lost: Lost) -> Verdict:
    return Verdict(name, (), sound=False, lost=lost.reason)


def passes(checked: Checked) -> bool:
    """True if every rule passes."""
    return all(finding.level == "pass" for finding in checked.findings)


def _place(fault: Fault, scene: Scene, engine: str, steps: int, search: bool) -> FaultTrial:
    def planted(size: float) -> Checked:
        cell = RUNS[fault.kind].cell(scene, engine, steps, fault.finer)
        cell = replace(cell, settings=fault.settings(engine))
        return examined(cell, fault.plant(size))[0]

    full, none = planted(fault.planted), planted(0.0)
    finding = _named(fault, full)
    sized = search and finding is not None and fault.size is not None
    return FaultTrial(
        scene=scene.name,
        engine=engine,
        finding=finding,
        failed=tuple(one.rule for one in full.failures),
        false=tuple(one.rule for one in none.failures),
        least=_least(fault, lambda size: _named(fault, planted(size)) is not None)
        if sized
        else None,
        nothing=finding is None and (full.errors, full.reason) == (none.errors, none.reason),
    )


def _named(fault: Fault, checked: Checked) -> Finding | None:
    """Return the failure of the rule that should see the fault, in the words that it should use."""
    return next(
        (
            finding
            for finding in checked.failures
            if finding.rule == fault.rule and all(word in finding.text for word in fault.says)
        ),
        None,
    )


def _least(fault: Fault, caught: Callable[[float], bool]) -> float:
    """Return the smallest size caught, as all larger tried ones are; 0 if no tried one escapes."""
    high = fault.planted
    for low in _smaller(fault):
        if not low or not caught(low):
            break
        high = low
    else:
        return 0.0
    while high > CLOSE * low and not (fault.whole and high - low <= 1.0):
        middle = math.sqrt(high * low) if low else high / 2.0
        if fault.whole:
            middle = min(max(round(middle), low + 1.0), high - 1.0)
        low, high = (low, middle) if caught(middle) else (middle, high)
    return high


def _smaller(fault: Fault) -> Iterator[float]:
    """Yield sizes below the planted one, a power of ten apart; whole ones end with 0."""
    for decade in range(1, DECADES + 1):
        size = fault.planted / 10.0**decade
        if fault.whole and size < 1.0:
            yield 0.0
            return
        yield round(size) if fault.whole else size
