"""What engines made of the positions that were asked, as a table."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from rich.table import Table

from reports.output.columns import plain_table
from reports.synthesis.proof import Met, in_words, unit_of

if TYPE_CHECKING:
    import pandas as pd  # a third of a second: not for what is only shown


def proof_table(proofs: Mapping[int, Sequence[Met]]) -> Table:
    """By number of the solution: for each engine the position and the thing that it missed most,
    over what is allowed."""
    table = plain_table(gap=2)
    for head in ("", "solution", "engine", "worst at", "driver deg", "what", "off", "allowed"):
        table.add_column(head, overflow="fold")
    for number, every in proofs.items():
        for engine in dict.fromkeys((one.engine, one.profile) for one in every):
            own = [one for one in every if (one.engine, one.profile) == engine]
            worst = max(own, key=_share)
            unit = unit_of(worst.asked)
            off = worst.reason or "did not come there"
            table.add_row(
                "ok" if all(one.within for one in own) else "OUT",
                str(number),
                " ".join(filter(None, engine)),
                f"position {worst.position}",
                f"{math.degrees(worst.driver_rad):.4f}",
                in_words(worst.asked),
                off if math.isnan(worst.off) else f"{worst.off:.1e} {unit}",
                f"{worst.limit:.1e} {unit}",
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
