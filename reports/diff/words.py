"""A diff in words and rows, which the terminal, Markdown and JUnit share."""

import math
import statistics
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from reports.output.numbers import count
from reports.results import runs
from reports.results.candidates import equal, noise_of
from reports.results.changes import CellPair, Diff, ErrorChange, Word, other_settings

REASON = 120
"""Characters of an engine's reason for its ending."""


@dataclass(frozen=True)
class PrintedRow:
    """Cells that differ in step only, as one row: the worst of them, and the other steps."""

    cells: Mapping[str, str]
    reason: str = ""


HEADS = ("scene", "engine", "steps\na turn", "quantity", "old:", "new:", "ratio:")


def headline(diff: Diff) -> str:
    """Return the number of cells of each kind."""
    parts = [f"{len(diff.those(word))} {word}" for word in ("worse", "better", "equal")]
    parts += [f"{len(diff.added)} new", f"{len(diff.missing)} missing"]
    if diff.other_scene:
        parts.append(f"{len(diff.other_scene)} of a scene that changed")
    return ", ".join(parts)


def verdict(diff: Diff, strict: bool = False) -> str:
    """Return the exit code in words."""
    if diff.those("worse"):
        return "WORSE"
    return "NOT WHOLE (--strict)" if diff.code(strict) else "NOT WORSE"


def lines(diff: Diff, word: Word) -> list[PrintedRow]:
    """Return the cells that are worse, or better, one row for those that differ in step only."""
    compared = runs.grouped((pair.name.line, pair.name.steps_per_turn) for pair in diff.pairs)
    groups = runs.grouped((pair.name.line, pair) for pair in diff.those(word))
    several = _several(diff)
    return [
        _line(members, compared[line], _engine(members[0], several))
        for line, members in groups.items()
    ]


def left_out(cells: Iterable[runs.StoredCell]) -> list[str]:
    """Return the cells of one run, one text for those that differ in step only."""
    groups = runs.grouped((cell.name.line, cell.name) for cell in cells).values()
    return [f"{names[0].scene}, {_called(names[0])}, {runs.steps_told(names)}" for names in groups]


def remarks(diff: Diff) -> list[str]:
    """Return notes that a reader needs for the numbers."""
    texts = [versions(diff), *diff.old.notes]
    texts += [note for note in diff.new.notes if note not in diff.old.notes]
    scenes = list(dict.fromkeys(cell.name.scene for cell in diff.other_scene))
    if scenes:
        number = count(len(diff.other_scene), "cell")
        texts.append(f"the text of {runs.each_once(scenes, 10)} changed: {number} not compared")
    failed = [pair.new.status for pair in diff.pairs if pair.failed]
    if failed:
        texts.append(f"{len(failed)} of the equal ones failed in both ({runs.each_once(failed)})")
    for (engine, variant), changed in other_settings(diff.pairs).items():
        texts.append(
            f"settings of {engine} {variant} differ: {runs.each_once(changed.values(), 6)}"
        )
    return [text for text in (*texts, cost_text(diff)) if text]


def footer(diff: Diff) -> list[str]:
    """Return units, the rule of the verdict, and the origin of both runs."""
    return [
        "Largest errors against the reference as pure numbers: angles in rad, lengths over the "
        "longest link, rates over the driver's peak speed and its square.",
        f"Worse: an error above {diff.factor:g} times the old one by more than rounding "
        "explains, or a cell that succeeded before.",
        f"old: {origin(diff.old)}",
        f"new: {origin(diff.new)}",
    ]


def origin(run: runs.StoredRun) -> str:
    """Return the origin of a run."""
    names = ("crankcheck", "processor", "made")
    facts = [f"{name} {run.facts[name]}" for name in names if run.facts.get(name)]
    return ", ".join([run.label, *facts])


def versions(diff: Diff) -> str:
    """Return the versions of every engine, old and new, each pair once."""
    by_engine = runs.grouped((pair.name.engine, _versions(pair)) for pair in diff.pairs)
    return "; ".join(f"{engine} {runs.each_once(each)}" for engine, each in by_engine.items())


def told(pair: CellPair) -> str:
    """Return the change of a cell in one line."""
    if pair.turned:
        failed = pair.old if pair.new.ok else pair.new
        why = f": {failed.reason[:REASON]}" if failed.reason else ""
        return f"ended as {pair.new.status}, before as {pair.old.status}{why}"
    if pair.failed:
        return f"failed in both: {pair.new.status}, before {pair.old.status}"
    change = pair.worst
    if change is None:
        return "nothing to compare"
    return f"{change.quantity} {size(change.old)} to {size(change.new)} (ratio {ratio(change)})"


def size(error: float) -> str:
    """Return a pure error; a dash where there is no number."""
    return f"{error:.2e}" if math.isfinite(error) else "-"


def ratio(change: ErrorChange) -> str:
    """Return new over old in three digits; a dash where one is no number, or the old one 0."""
    if not math.isfinite(change.ratio) or not math.isfinite(change.old):
        return "-"
    return f"{change.ratio:#.3g}".removesuffix(".")


def _line(members: Sequence[CellPair], compared: Sequence[float], engine: str) -> PrintedRow:
    """Return pairs of one line, the largest change first, as a row."""
    first, change = members[0], members[0].worst
    unit = first.name.clock.per
    steps = _steps([pair.name.steps_per_turn for pair in members], compared, unit)
    if first.turned or change is None:
        failed = first.old if first.new.ok else first.new
        was, now = first.old.status, first.new.status
        reason = failed.reason[:REASON]
        seen = ("status", was, now, "-")
    else:
        reason = ""
        seen = (change.quantity, size(change.old), size(change.new), ratio(change))
    cells = zip(HEADS, (first.name.scene, engine, steps, *seen), strict=True)
    return PrintedRow(dict(cells), reason)


def _steps(changed: Sequence[float], compared: Sequence[float], unit: str) -> str:
    """Return the step of the largest change, and the other changed steps, in a ``unit``."""
    first, *others = [f"{each:g}{unit}" for each in changed]
    if len(changed) > 2 and len(changed) == len(compared):
        return f"{first} (all {len(changed)}: {min(changed):g}{unit} to {max(changed):g}{unit})"
    return f"{first} (also {', '.join(others)})" if others else first


def _engine(pair: CellPair, several: frozenset[str]) -> str:
    """Return engine and variant; with its versions where they differ from cell to cell."""
    called = _called(pair.name, "turns" in several)
    return f"{called} ({_versions(pair)})" if pair.name.engine in several else called


def _called(name: runs.CellName, turns: bool = False) -> str:
    parts = [f"{name.engine} {name.variant}"]
    parts += [f"drive {name.drive}"] if name.drive != "prescribed" else []
    parts += [f"{name.turns:g} {name.clock.unit}"] if turns else []
    return ", ".join(parts)


def _versions(pair: CellPair) -> str:
    was, now = pair.old.version, pair.new.version
    return was if was == now else f"{was} -> {now}"


def _several(diff: Diff) -> frozenset[str]:
    """Return engines with several pairs of versions, and ``turns`` where cells differ in these."""
    pairs = {(pair.name.engine, _versions(pair)) for pair in diff.pairs}
    engines = [engine for engine, _ in pairs]
    several = {engine for engine in engines if engines.count(engine) > 1}
    if len({pair.name.turns for pair in diff.pairs}) > 1:
        several.add("turns")
    return frozenset(several)


LEAST_NOISE = 0.1
"""Least noise between sweeps, larger than within one: another machine of the same kind, or one with
other work beside. Costs are equal up to this, even if timings within a sweep are nearer."""


@dataclass(frozen=True)
class CostChange:
    """An engine and variant: the median over its cells of new cost over old."""

    engine: str
    variant: str
    ratio: float
    cells: int


def cost_changes(diff: Diff) -> tuple[list[CostChange], float]:
    """Return the change of every engine and variant with cells timed on the same processor, and the
    relative difference up to which costs are equal, from the pairs of timings of each cell."""
    ratios: dict[tuple[str, str], list[float]] = {}
    noises: list[float] = []
    for pair in diff.pairs:
        was, now = pair.old.cost, pair.new.cost
        if was and now and was.processor == now.processor:
            key = (pair.name.engine, pair.name.variant)
            ratios.setdefault(key, []).append(now.us_per_step / was.us_per_step)
            noises += [was.noise, now.noise]
    costs = [CostChange(*key, statistics.median(each), len(each)) for key, each in ratios.items()]
    return costs, max([LEAST_NOISE, *([noise_of(noises)] if noises else [])])


def cost_text(diff: Diff) -> str:
    """Return the costs that changed in a sentence, empty where none can be compared."""
    costs, noise = cost_changes(diff)
    if not costs:
        return ""
    unequal = [
        f"{cost.engine} {cost.variant} {cost.ratio:.2f} x (median of {count(cost.cells, 'cell')})"
        for cost in sorted(costs, key=lambda cost: -cost.ratio)
        if not equal(cost.ratio, 1.0, noise)
    ]
    rest = f"inside the noise of {noise:.0%}"
    if not unequal:
        return f"time of a step, as advice: equal {rest}"
    others = f"; the others equal {rest}" if len(unequal) < len(costs) else ""
    return f"time of a step, new over old, as advice: {runs.each_once(unequal, 6)}{others}"
