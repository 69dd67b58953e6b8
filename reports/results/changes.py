"""Improvements and regressions, quantity by quantity and cell by cell."""

import json
import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Literal

from models.errors import CrankcheckError
from reports.output.numbers import count
from reports.quantities.limits import ELASTIC, FREE
from reports.results.runs import COMPARED, CellName, StoredCell, StoredRun
from reports.store.manifest import BUSY
from sim.engine import AT_ROUNDING

FACTOR = 1.1
"""Growth of an error up to which it is not called worse."""
Word = Literal["worse", "better", "equal"]


@dataclass(frozen=True)
class ErrorChange:
    """One error, old and new, as pure numbers; infinite where there is no number.

    Rounding alone may change both by ``floor``.
    """

    quantity: str
    old: float
    new: float
    floor: float

    @property
    def ratio(self) -> float:
        """Error ratio new over old, without the floor; infinite where the old one is 0."""
        if self.old == self.new:
            return 1.0
        return self.new / self.old if self.old else math.inf

    @property
    def growth(self) -> float:
        """Ratio new over old where the floor under both keeps values near zero from counting."""
        if self.old == self.new:
            return 1.0
        return (self.new + self.floor) / (self.old + self.floor)

    @property
    def factor(self) -> float:
        """Ratio of the larger to the smaller error; at least 1."""
        return max(self.growth, 1.0 / self.growth) if self.growth else math.inf

    @property
    def changed(self) -> bool:
        return self.word() != "equal"

    def word(self, factor: float = FACTOR) -> Word:
        """Return worse or better if one exceeds ``factor`` times the other by more than floor."""
        if self.new > factor * self.old + self.floor:
            return "worse"
        return "better" if self.old > factor * self.new + self.floor else "equal"


@dataclass(frozen=True)
class CellPair:
    """A cell that both runs have.

    A run that did not end well has no errors to compare: its ending is the change, and two failed
    runs are equal, however they failed. ``word`` is worse where any error is worse, better where
    some are better and none is worse.
    """

    old: StoredCell
    new: StoredCell
    changes: tuple[ErrorChange, ...]
    word: Word
    factor: float

    @property
    def name(self) -> CellName:
        return self.new.name

    @property
    def turned(self) -> bool:
        """True if it ended well in one run and not in the other."""
        return self.old.ok != self.new.ok

    @property
    def failed(self) -> bool:
        """True if it ended well in neither run."""
        return not (self.old.ok or self.new.ok)

    @property
    def worst(self) -> ErrorChange | None:
        """Change that is shown: the largest in the direction of ``word``."""
        alike = [c for c in self.changes if c.word(self.factor) == self.word]
        if self.word == "better":
            return min(alike, key=lambda change: change.growth, default=None)
        return max(alike, key=lambda change: change.growth, default=None)

    @property
    def factor_of_change(self) -> float:
        """Factor by which it is worse or better; infinite where it ended in another way."""
        if self.turned:
            return math.inf
        return self.worst.factor if self.worst else 1.0


@dataclass(frozen=True)
class Diff:
    """Two runs, cell by cell.

    ``other_scene`` are cells of both whose scenes differ: there is nothing to compare. A cell of
    one run only is ``missing`` or ``added``.
    """

    old: StoredRun
    new: StoredRun
    factor: float
    pairs: tuple[CellPair, ...]
    missing: tuple[StoredCell, ...]
    added: tuple[StoredCell, ...]
    other_scene: tuple[StoredCell, ...]

    def those(self, word: Word) -> tuple[CellPair, ...]:
        """Return the cells that are worse, better or equal, the largest change first."""
        alike = [pair for pair in self.pairs if pair.word == word]
        return tuple(sorted(alike, key=lambda pair: -pair.factor_of_change))

    def code(self, strict: bool = False) -> int:
        """Return the exit code: 1 where something is worse; ``strict``: or could not be compared.

        A run that failed is a row with its status, so a cell is missing only where it was not
        requested: that is reported, and is no fault unless ``strict``.
        """
        lost = strict and (self.missing or self.other_scene)
        return int(bool(lost or any(pair.word == "worse" for pair in self.pairs)))


def compare(old: StoredRun, new: StoredRun, factor: float = FACTOR) -> Diff:
    """Compare two runs.

    Raises
    ------
    CrankcheckError
        A factor that is not at least 1; no cell that both runs have, of the same scene; a cell that
        may be lost in a damaged run.
    """
    if not (math.isfinite(factor) and factor >= 1.0):
        raise CrankcheckError(f"--factor {factor:g}: give a number of at least 1, such as 1.1")
    refuse_gone(old, new)
    both = [name for name in new.cells if name in old.cells]
    if not both:
        raise CrankcheckError(f"no cell in common: {old.holds}; {new.holds}")
    alike = [name for name in both if _same_scene(old.cells[name], new.cells[name])]
    if not alike:
        scenes = ", ".join(dict.fromkeys(name.scene for name in both))
        raise CrankcheckError(
            f"{old.label}, {new.label}: every scene of both changed in between ({scenes}); run "
            "the old one again with the scenes as they are now"
        )
    other = set(both) - set(alike)
    return Diff(
        old=old,
        new=new,
        factor=factor,
        pairs=tuple(_pair(old.cells[name], new.cells[name], factor) for name in alike),
        missing=tuple(cell for name, cell in old.cells.items() if name not in new.cells),
        added=tuple(cell for name, cell in new.cells.items() if name not in old.cells),
        other_scene=tuple(cell for name, cell in new.cells.items() if name in other),
    )


def floor(quantity: str, steps_per_turn: float) -> float:
    """Return the share of an error that rounding may cause, pure (see `reports.judge.tolerance`).

    The step is taken as an equal part of a turn, as for a driver of constant speed.
    """
    tolerance = {**FREE, **ELASTIC}[quantity]
    step_rad = math.tau / steps_per_turn
    return tolerance.floor + AT_ROUNDING / step_rad**tolerance.differenced


def other_settings(pairs: Iterable[CellPair]) -> Mapping[tuple[str, str], Mapping[str, str]]:
    """Return the settings that an engine held otherwise, by engine and variant: not the version
    alone changed. Each comes with both values of one example."""
    differing: dict[tuple[str, str], dict[str, str]] = {}
    for pair in pairs:
        was, now = pair.old.settings, pair.new.settings
        for name in was.keys() & now.keys():
            before, after = json.dumps(was[name]), json.dumps(now[name])
            if before != after:
                here = differing.setdefault((pair.name.engine, pair.name.variant), {})
                here.setdefault(name, f"{name} {before} -> {after}")
    return {key: dict(sorted(here.items())) for key, here in differing.items()}


def _same_scene(old: StoredCell, new: StoredCell) -> bool:
    """True if both are of one scene, as far as the runs know."""
    told = old.scene_digest and new.scene_digest
    return not told or old.scene_digest == new.scene_digest


def _pair(old: StoredCell, new: StoredCell, factor: float) -> CellPair:
    if not (old.ok and new.ok):
        word: Word = "equal" if old.ok == new.ok else "better" if new.ok else "worse"
        return CellPair(old, new, (), word, factor)
    changes = tuple(_changes(old, new))
    words = {change.word(factor) for change in changes}
    word = "worse" if "worse" in words else "better" if "better" in words else "equal"
    return CellPair(old, new, changes, word, factor)


def _changes(old: StoredCell, new: StoredCell) -> Iterator[ErrorChange]:
    """Yield the change of every quantity that both runs know, and either has a number for."""
    for quantity in (q for q in COMPARED if q in old.errors and q in new.errors):
        was, now = old.errors[quantity], new.errors[quantity]
        if math.isfinite(was) or math.isfinite(now):
            yield ErrorChange(quantity, was, now, floor(quantity, new.name.steps_per_turn))


def refuse_gone(old: StoredRun, new: StoredRun) -> None:
    """Refuse to compare where a lost cell may be one that the other run has.

    Damage in a run does not matter where it has every cell of the other one: a lost cell was not
    requested then. Otherwise a cell may be lost or may never have existed, and could be worse; so
    too where both have lost some, which may be the same.

    Raises
    ------
    CrankcheckError
        Names the missing cells, and the damage.
    """
    for run, other in ((old, new), (new, old)):
        if not run.gone:
            continue
        missing = [name for name in other.cells if name not in run.cells]
        if missing:
            which = f"{count(len(missing), 'cell')} of {other.label}, such as {missing[0].label},"
        elif run.lost and other.lost:
            which = f"cells that {other.label} lost too"
        else:
            continue
        busy = any(BUSY in each for each in run.gone)
        raise CrankcheckError(
            f"{run.label}: {which} may be among the missing cells there "
            f"({'; '.join(run.gone)}); {'let its sweep end' if busy else 'repair it'} first, or "
            "compare with a whole run"
        )
