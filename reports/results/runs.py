"""A run for comparison: cells by their names, from any writer."""

from __future__ import annotations

import json
import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeVar

from models.errors import few
from reports.judge.cell import Cell, Checked
from reports.judge.rows import cell_row
from reports.output.numbers import count
from reports.protocol.length import SECONDS, TURNS, Clock, clock_of, common_clock
from reports.quantities.limits import EVERY
from reports.results.candidates import apart

COMPARED = EVERY
"""Compared quantities: the largest error of each, as a pure number."""
CellRow = Mapping[str, object]
Key = TypeVar("Key")
Value = TypeVar("Value")


@dataclass(frozen=True)
class CellName:
    """Name of a cell in every run; without the engine's version, which is compared across."""

    scene: str
    engine: str
    variant: str
    drive: str
    steps_per_turn: float
    turns: float

    @property
    def line(self) -> tuple[str, str, str, str, float]:
        """Name in common with the cells that differ in step only."""
        return self.scene, self.engine, self.variant, self.drive, self.turns

    @property
    def label(self) -> str:
        servo = "" if self.drive == "prescribed" else f", drive {self.drive}"
        long = self.clock.lasts(self.turns)
        return f"{self.scene}, {self.engine} {self.variant}{servo}, {steps_told([self])}{long}"

    @property
    def clock(self) -> Clock:
        """Clock of its steps and length."""
        return clock_of(self.drive)


def steps_told(names: Collection[CellName]) -> str:
    """Return the steps of cells of one line, in words: in a turn, or a second of free motion."""
    turn = common_clock(name.drive for name in names).name
    steps = sorted({name.steps_per_turn for name in names})
    return f"{', '.join(f'{each:g}' for each in steps)} steps a {turn}"


@dataclass(frozen=True)
class CellCost:
    """Cost of a step [microseconds], relative difference of two timings, and their processor."""

    us_per_step: float
    noise: float
    processor: str


@dataclass(frozen=True)
class StoredCell:
    """One cell of a run: its ending, and its largest errors by quantity, as pure numbers.

    An error is infinite where the run has no number for it: it was not finite, or nothing of the
    kind was reported. A quantity that the run does not know is not there. Beside the compared ones
    there are ``pin gap`` and ``slider gap``, of which ``gap`` is the larger. ``verdict`` and
    ``scene_digest`` are empty where the run does not have them.
    """

    name: CellName
    version: str
    status: str
    reason: str
    errors: Mapping[str, float]
    settings: Mapping[str, object] = field(default_factory=dict)
    scene_digest: str = ""
    cost: CellCost | None = None
    verdict: str = ""

    @property
    def ok(self) -> bool:
        return self.status == "ok"

    @property
    def passes(self) -> bool:
        """True if it was within tolerance, or failed as was known."""
        return self.verdict in ("within", "known")


@dataclass(frozen=True)
class StoredRun:
    """All cells of a run; ``label`` is its name, ``facts`` its versions, processor, time.

    ``notes`` say which parts were left out, and why. ``notice`` names damage in it, and ``gone``
    the damage that may hide cells that it had (``lost``), or was to have.
    """

    label: str
    cells: Mapping[CellName, StoredCell]
    facts: Mapping[str, str] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    notice: tuple[str, ...] = ()
    gone: tuple[str, ...] = ()
    lost: bool = False

    def only(self, names: Collection[CellName]) -> StoredRun:
        """Return the same run with these cells alone."""
        return replace(self, cells={n: cell for n, cell in self.cells.items() if n in names})

    @property
    def holds(self) -> str:
        """Content to compare, in a sentence."""
        names = list(self.cells)
        turning, timed = ([n for n in names if n.clock is each] for each in (TURNS, SECONDS))
        parts = [
            f"{count(len(names), 'cell')}: scenes {each_once(name.scene for name in names)}",
            each_once(f"{name.engine} {name.variant}" for name in names),
            *([steps_told(turning), f"{_each_long(turning)} turns"] if turning else []),
            *([f"free motion, {steps_told(timed)}", f"for {_each_long(timed)} s"] if timed else []),
            f"drive {each_once(name.drive for name in names)}",
        ]
        return f"{self.label} holds {'; '.join(parts)}"


def _each_long(names: Collection[CellName]) -> str:
    return each_once(f"{name.turns:g}" for name in names)


def run_of(
    checked: Sequence[Checked], facts: Mapping[str, str], digests: Mapping[str, str]
) -> StoredRun:
    """Return the run of a verification just made; ``digests`` of the scenes by name."""
    rows = (cell_row(one) | {"scene_digest": digests.get(one.cell.scene.name)} for one in checked)
    cells = (stored_cell(row, facts) for row in rows)
    return StoredRun("this run", {cell.name: cell for cell in cells}, facts)


def planned_run(cells: Sequence[Cell], digests: Mapping[str, str]) -> StoredRun:
    """Return the run of a verification still to be made: the names of its cells, without errors."""
    planned = {}
    for cell in cells:
        steps, turns = same(cell.steps_per_turn), same(cell.turns)
        name = CellName(cell.scene.name, cell.engine, cell.profile, cell.drive, steps, turns)
        planned[name] = StoredCell(name, "", "", "", {}, scene_digest=digests.get(name.scene, ""))
    return StoredRun("the request", planned)


def stored_cell(row: CellRow, facts: Mapping[str, str]) -> StoredCell:
    """Return one cell of a row as `reports.judge.rows.cell_row` makes it, of a store or of a CSV
    file, with the ``scene_digest`` where that is known.

    Raises
    ------
    KeyError, ValueError
        A column that names the cell is not there; a number or settings that can not be read.
    """
    engine = text(row["engine"])
    steps, turns = (_positive(row[key], key) for key in ("steps_per_turn", "turns"))
    name = CellName(
        scene=text(row["scene"]),
        engine=engine,
        variant=text(row.get("variant")) or text(row["profile"]),
        drive=text(row["drive"]),
        steps_per_turn=same(steps),
        turns=same(turns),
    )
    columns = {each: f"{each.replace('-', '_')}_pure" for each in COMPARED}
    return StoredCell(
        name=name,
        version=text(row["version"]) or facts.get(engine, "?"),
        status=text(row["status"]),
        reason=" ".join(text(row["reason"]).split()),
        errors={q: _error(row[c]) for q, c in columns.items() if c in row} | _gaps(row),
        settings=_settings(text(row.get("settings")) or "{}"),
        scene_digest=text(row.get("scene_digest")),
        cost=_cost(row),
        verdict=text(row.get("verdict")),
    )


def _error(value: object) -> float:
    found = number(value)
    if found is not None and found < 0.0:
        raise ValueError(f"an error of {found:g}")
    return math.inf if found is None else found


def _gaps(row: CellRow) -> dict[str, float]:
    """Return the gaps of pins and of sliders over the longest link, from the larger of both."""
    pure = number(row.get("gap_pure"))
    measured_m = {kind: number(row.get(f"{kind}_gap_m")) for kind in ("pin", "slider")}
    gaps = {f"{kind} gap": gap_m for kind, gap_m in measured_m.items() if gap_m is not None}
    if pure is None or not gaps:
        return {}
    share = pure / max(gaps.values()) if pure else 0.0
    return {name: gap_m * share for name, gap_m in gaps.items()}


def _positive(value: object, column: str) -> float:
    found = number(value)
    if found is None or found <= 0.0:
        raise ValueError(f"{column} {value!r}")
    return found


def _settings(content: str) -> Mapping[str, object]:
    found = json.loads(content)
    if not isinstance(found, dict):
        raise ValueError(f"settings {content[:40]!r}")
    return found


def _cost(row: CellRow) -> CellCost | None:
    least, a, b = (number(row.get(f"us_per_step{part}")) for part in ("", "_a", "_b"))
    if not (least and a and b):
        return None
    return CellCost(least, apart(a, b), text(row.get("processor")))


def same(value: float) -> float:
    """Round a number of steps or turns to the digits that are equal however it was computed."""
    return float(f"{value:.9g}")


def number(value: object) -> float | None:
    """Return a number of a table, None where there is none. Raises ValueError for words."""
    if value is None or value == "":
        return None
    found = float(str(value))
    return found if math.isfinite(found) else None


def text(value: object) -> str:
    """Return a text of a table, empty where there is none."""
    return value if isinstance(value, str) else ""


def grouped(pairs: Iterable[tuple[Key, Value]]) -> dict[Key, list[Value]]:
    """Return the values of each key, in order."""
    groups: dict[Key, list[Value]] = {}
    for key, value in pairs:
        groups.setdefault(key, []).append(value)
    return groups


def each_once(values: Iterable[str], most: int = 4) -> str:
    """Return each value once, and the number of values beyond the first few."""
    return few(dict.fromkeys(values), most)
