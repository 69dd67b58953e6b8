"""What stands under the tables of a verification: units, steps and versions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import cast

from rich.markup import escape

from reports.judge.cell import Checked
from reports.verify.cell_table import Part

UNITS, LINK_UNITS, OF_FORCES, MORE_UNITS, MORE_STEPS, NOTES, STEPS = range(7)
"""Places of parts: units and steps of cells stand there, those of free motion between."""
FORCES = (
    "Forces against kinetostatics at the instants that they act at; F largest reaction, M largest "
    "torque over the run."
)


def footer(checked: Sequence[Checked], facts: Mapping[str, str]) -> str:
    """Units, steps and versions."""
    of_all: list[Part] = [(OF_FORCES, _of_forces), (NOTES, _notes)]
    own = {part: [*checked] for part in of_all}
    for one in checked:
        for part in cast(Sequence[Part], one.cell.way.part("footer")):
            own.setdefault(part, []).append(one)
    parts = sorted(own, key=lambda part: part[0])
    lines = [line for part in parts for line in part[1](own[part])]
    lines.append(", ".join(f"{name} {value}" for name, value in facts.items()))
    return escape("\n".join(lines))


def _of_forces(checked: Sequence[Checked]) -> Sequence[str]:
    return [FORCES] * any(one.cell.with_forces for one in checked)


def _notes(checked: Sequence[Checked]) -> list[str]:
    """What is to be said of forces, and of free motion, once for a scene: counts may differ by a
    sample."""
    notes = dict[tuple[str, str], str]()
    for one in checked:
        told = one.cell.with_forces or one.cell.way.noted
        for note in one.errors.notes if told and one.errors else ():
            words = "".join(letter for letter in note if not letter.isdigit())
            notes.setdefault((one.cell.scene.name, words), f"{one.cell.scene.name}: {note}.")
    return list(notes.values())


def span(values: Sequence[float]) -> str:
    """One value, or the smallest and the largest."""
    low, high = f"{values[0]:.4g}", f"{values[-1]:.4g}"
    return low if low == high else f"{low} to {high}"
