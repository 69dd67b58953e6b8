"""What engines made of the positions that were asked, as a table."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rich.table import Table

from reports.lectures.design.proof import Met, in_words, unit_of
from reports.output.console import plain_table

if TYPE_CHECKING:
    import pandas as pd  # a third of a second: not for what is only shown


@dataclass(frozen=True)
class ProofRow:
    """What an engine missed most of what a solution was asked, in words; ``within`` is whether all
    of it is within what is allowed."""

    within: bool
    solution: int
    engine: str
    position: int
    driver_deg: str
    what: str
    off: str
    allowed: str


def proof_rows(proofs: Mapping[int, Sequence[Met]]) -> list[ProofRow]:
    """By number of the solution, a row for each engine and profile."""
    rows = []
    for number, every in proofs.items():
        for engine in dict.fromkeys((one.engine, one.profile) for one in every):
            own = [one for one in every if (one.engine, one.profile) == engine]
            worst = max(own, key=_share)
            unit = unit_of(worst.asked)
            none = worst.reason or "did not come there"
            rows.append(
                ProofRow(
                    all(one.within for one in own),
                    number,
                    " ".join(filter(None, engine)),
                    worst.position,
                    f"{math.degrees(worst.driver_rad):.4f}",
                    in_words(worst.asked),
                    none if math.isnan(worst.off) else f"{worst.off:.1e} {unit}",
                    f"{worst.limit:.1e} {unit}",
                )
            )
    return rows


def proof_table(proofs: Mapping[int, Sequence[Met]]) -> Table:
    """The rows for a terminal."""
    table = plain_table(gap=2)
    for head in ("", "solution", "engine", "position", "driver deg", "what", "off", "allowed"):
        table.add_column(head, overflow="fold")
    for row in proof_rows(proofs):
        table.add_row(
            "ok" if row.within else "OUT",
            str(row.solution),
            row.engine,
            str(row.position),
            row.driver_deg,
            row.what,
            row.off,
            row.allowed,
        )
    return table


def proof_frame(proofs: Mapping[int, Sequence[Met]]) -> pd.DataFrame:
    """A row for each thing asked at each position, with all digits."""
    import pandas as pd

    return pd.DataFrame(
        {
            "solution": number,
            "engine": one.engine,
            "profile": one.profile,
            "position": one.position,
            "driver_rad": one.driver_rad,
            "asked": in_words(one.asked),
            "off": one.off,
            "allowed": one.limit,
            "unit": unit_of(one.asked),
            "within": one.within,
            "reason": one.reason,
        }
        for number, every in proofs.items()
        for one in every
    )


def _share(one: Met) -> float:
    return math.inf if math.isnan(one.off) else one.off / one.limit
