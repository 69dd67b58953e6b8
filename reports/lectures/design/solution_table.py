"""The solutions of a synthesis as a table: what each is, and what is wrong with it."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from rich.table import Table

from analytic.lectures.synthesis.examine import Examined
from analytic.lectures.synthesis.solutions import Solutions
from reports.output.console import plain_table
from reports.output.numbers import count

if TYPE_CHECKING:
    import pandas as pd  # a third of a second: not for what is only shown

DEFECT_FREE = "none"


def remarks(one: Examined) -> list[str]:
    """What a task wished and a mechanism does not have, and how well it does it, in words."""
    doubt = one.proposal.doubt
    return [*one.unfulfilled, *one.notes, *([doubt] if doubt else [])]


def counted(solutions: Solutions, listed: int) -> str:
    """How many solutions there are, of how many, in words."""
    many, sound = len(solutions.examined), len(solutions.sound)
    told = f"{count(solutions.looked, 'mechanism')} looked at, {many} examined"
    told += f", {sound} without a defect"
    if solutions.refused:
        told += f"; {len(solutions.refused)} are none ({solutions.refused[0]})"
    return told + (f"; the best {listed} listed" if listed < many else "")


def solution_table(every: Sequence[Examined]) -> Table:
    """A row for each, numbered from 1."""
    table = plain_table(gap=2)
    for head in ("", "defect", "driver", "trans. deg", "size m", "type", "chosen, remarks"):
        table.add_column(head, overflow="fold")
    for number, one in enumerate(every, 1):
        table.add_row(
            str(number),
            ", ".join(one.defects) or DEFECT_FREE,
            "turns" if one.turns_fully else "swings",
            f"{math.degrees(one.least_transmission_rad):.2f}",
            f"{one.extent_m:.4g}",
            one.grashof,
            "; ".join([*_chosen(one), *remarks(one)]),
        )
    return table


def solution_frame(every: Sequence[Examined]) -> pd.DataFrame:
    """The same with all digits, and the lengths: a row for each."""
    import pandas as pd

    rows = []
    for number, one in enumerate(every, 1):
        angles = [math.degrees(position.driver_rad) for position in one.positions]
        row: dict[str, object] = {
            "solution": number,
            "defect": ", ".join(one.defects) or DEFECT_FREE,
            "turns_fully": one.turns_fully,
            "least_transmission_rad": one.least_transmission_rad,
            "extent_m": one.extent_m,
            "type": one.grashof,
            "chosen": "; ".join(_chosen(one)),
            "remarks": "; ".join(remarks(one)),
            "largest_miss": max(one.off),
            "largest_torque_n_m": one.torque_n_m,
        }
        row |= {f"driver_{k}_deg": angle for k, angle in enumerate(angles, 1)}
        for name, place in one.scene.ground.items():
            row |= {f"{name}_x_m": place[0], f"{name}_y_m": place[1]}
        for link in one.scene.links.values():
            points = list(link.points.items())
            for (first, p), (second, q) in itertools.pairwise(points):
                row[f"{link.name}_{first}{second}_m"] = math.dist(p, q)
        rows.append(row)
    return pd.DataFrame(rows)


def _chosen(one: Examined) -> list[str]:
    torque = [] if one.torque_n_m is None else [f"torque up to {one.torque_n_m:.4g} N m"]
    return [f"{name} {value}" for name, value in one.proposal.chosen.items()] + torque
