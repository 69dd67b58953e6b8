"""What a step cost in two runs: advice, which never counts for the verdict."""

from __future__ import annotations

import statistics
from dataclasses import dataclass

from reports.output.numbers import count
from reports.results.changes.changes import Diff
from reports.results.changes.runs import each_once
from reports.results.cost import equal, noise_of

LEAST_NOISE = 0.1
"""Two sweeps are further apart than two timings within one: another machine of the same kind, or
one that does something else beside. Up to this, costs are equal however near those were."""


@dataclass(frozen=True)
class CostChange:
    """An engine and variant: the median over its cells of new cost over old."""

    engine: str
    variant: str
    ratio: float
    cells: int


def cost_changes(diff: Diff) -> tuple[list[CostChange], float]:
    """The change of every engine and variant whose cells were timed on the same processor, and
    the relative difference up to which costs are equal, from the pairs of timings of each cell."""
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
    """The costs that changed in a sentence, empty where none can be compared."""
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
    return f"time of a step, new over old, as advice: {each_once(unequal, 6)}{others}"
