"""The result of a search, beside the profile, on the terminal."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from rich.console import Console
from rich.text import Text

from reports.output.console import grid
from reports.quantities import QUANTITIES, named
from reports.results.lines import value_text
from reports.tune.attempt import Attempt, Goal, Row, Taken
from sim.registry.offers import SearchSpace

OTHERS = {
    f"{name}_pure": f"{name} / {QUANTITIES[name].share}" for name in named("closure", "derived")
}
"""Errors that are shown, and not searched for: a column of a cell's row to its label."""


@dataclass(frozen=True)
class Side:
    """One column of the table: settings, the rows of their runs, and their times."""

    title: str
    attempt: Attempt
    rows: Sequence[Row]
    taken: Taken | None = None


def show(console: Console, goal: Goal, space: SearchSpace, sides: Sequence[Side]) -> None:
    """Print the table, and the ratio of the last side to the first."""
    names = ", ".join(scene.name for scene in goal.scenes)
    console.print(Text(f"{names}, {goal.engine}: error of place up to {goal.target:g}", "bold"))
    table = grid(["", *(f"{side.title}:" for side in sides)])
    for label, cells in _lines(goal, space, sides):
        changed = (
            len(cells) == 2 and label in {k.name for k in space.knobs} and cells[0] != cells[1]
        )
        table.add_row(
            label, *(Text(c, "bold" if changed and i else "") for i, c in enumerate(cells))
        )
    console.print(table, highlight=False)
    if ratio := _ratio(sides):
        console.print(Text(ratio), highlight=False)
    last = sides[-1].attempt
    if last.reached and last.tried == goal.least:
        console.print(
            f"{goal.least} steps per turn are the fewest that a run of {goal.turns:g} turns may "
            "have; with more --turns there may be fewer",
            highlight=False,
        )


def _lines(goal: Goal, space: SearchSpace, sides: Sequence[Side]) -> list[tuple[str, list[str]]]:
    lines = [
        (knob.name, [value_text(side.attempt.settings[knob.targets[0]]) for side in sides])
        for knob in space.knobs
    ]
    lines.append(("steps per turn", [str(side.attempt.tried) for side in sides]))
    lines.append(("error of place", [_error(side.attempt, goal.target) for side in sides]))
    if len(goal.scenes) > 1:
        lines.append(("worst in", [side.attempt.scene or "-" for side in sides]))
    for column, label in OTHERS.items():
        lines.append((label, [_worst(side.rows, column) for side in sides]))
    over = "" if len(goal.scenes) == 1 else f", {len(goal.scenes)} scenes"
    if all(side.taken for side in sides):
        taken = [side.taken for side in sides if side.taken]
        lines.append((f"us per step{over}", [f"{each.us_per_step:.2f}" for each in taken]))
        lines.append((f"ms per turn{over}", [f"{1e3 * each.s_per_turn:.3g}" for each in taken]))
    return lines


def _ratio(sides: Sequence[Side]) -> str:
    first, last = sides[0], sides[-1]
    if first is last or not (first.attempt.reached and last.attempt.reached):
        return ""
    what = f"cost of a turn, {last.title} over {first.title}"
    model = f"{last.attempt.cost_us / first.attempt.cost_us:.2f} by the model of the search"
    if first.taken is None or last.taken is None:
        return f"{what}: {model}"
    ratio = last.taken.s_per_turn / first.taken.s_per_turn
    noise = max(first.taken.noise, last.taken.noise)
    words = (
        "no difference" if abs(math.log(ratio)) <= noise else "cheaper" if ratio < 1 else "DEARER"
    )
    return f"{what}: {ratio:.2f} measured ({words}; A/A noise {noise:.1%}), {model}"


def _worst(rows: Sequence[Row], column: str) -> str:
    """Return the largest of a column over the scenes; a dash where there is none."""
    numbers = [float(value) for row in rows if isinstance(value := row[column], float)]
    if not numbers:
        return "-"
    return f"{max(numbers, key=lambda x: x if math.isfinite(x) else math.inf):.1e}"


def _error(attempt: Attempt, target: float) -> str:
    if math.isinf(attempt.error):
        return "none"
    return f"{attempt.error:.2e}" + ("" if attempt.reached else " OVER")


def footer(goal: Goal, how: str, facts: Mapping[str, str]) -> str:
    """Return the meaning of the numbers, the method, and the machine."""
    turned = f"{goal.turns:g} turn" + ("" if goal.turns == 1.0 else "s")
    return "\n".join(
        [
            f"Largest errors of {turned} against the closed form; place: angle [rad], position and "
            "displacement / L; L longest link, w driver's peak speed. Steps per turn: the fewest "
            "that reach the target, to 1 %; 1.4 and 2 times as many reach it too.",
            how,
            ", ".join(f"{name} {value}" for name, value in facts.items()),
        ]
    )
