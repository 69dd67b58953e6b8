"""The solutions of a synthesis as a table: their properties and their defects."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from rich.table import Table

from analytic.lectures.synthesis.examine import Examined
from analytic.lectures.synthesis.sensitivity import Sensitivity, Spread
from analytic.lectures.synthesis.solutions import Solutions
from reports.lectures.design.proof import Met, in_words, unit_of
from reports.output.console import grid
from reports.output.numbers import count

if TYPE_CHECKING:
    import pandas as pd


DEFECT_FREE = "none"


def remarks(one: Examined) -> list[str]:
    """Unfulfilled wishes of a task, and notes on the quality of a mechanism, in words."""
    doubt = one.proposal.doubt
    return [*one.unfulfilled, *one.notes, *([doubt] if doubt else [])]


def counted(solutions: Solutions, listed: int) -> str:
    """The numbers of solutions examined, sound and listed, in words."""
    many, sound = len(solutions.examined), len(solutions.sound)
    told = f"{count(solutions.looked, 'mechanism')} tried, {many} examined"
    told += f", {sound} without a defect"
    if solutions.refused:
        told += f"; {len(solutions.refused)} refused ({solutions.refused[0]})"
    if solutions.no_proof:
        told += f"; {solutions.no_proof}"
    if solutions.without:
        told += f"; no solution ({solutions.without}): the first one does the nearest task"
    return told + (f"; the best {listed} listed" if listed < many else "")


def solution_table(every: Sequence[Examined]) -> Table:
    """Table of solutions, a row each, numbered from 1."""
    rows = [
        (
            str(number),
            ", ".join(one.defects) or DEFECT_FREE,
            "turns" if one.turns_fully else "swings",
            f"{math.degrees(one.least_transmission_rad):.2f}",
            f"{one.extent_m:.4g}",
            one.grashof,
            "; ".join([*_chosen(one), *remarks(one)]),
        )
        for number, one in enumerate(every, 1)
    ]
    return grid(("", "defect", "driver", "trans. deg", "size m", "type", "chosen, remarks"), rows)


def solution_frame(every: Sequence[Examined]) -> pd.DataFrame:
    """Table of solutions with all digits, and the lengths: a row for each."""
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


def proof_rows(proofs: Mapping[int, Sequence[Met]]) -> list[dict[str, object]]:
    """The rows by number of the solution, one for each engine and profile: its largest miss in
    words; ``within`` says whether all of its misses are within their limits."""
    rows = []
    for number, every in proofs.items():
        for engine in dict.fromkeys((one.engine, one.profile) for one in every):
            own = [one for one in every if (one.engine, one.profile) == engine]
            worst = max(own, key=_share)
            unit = unit_of(worst.asked)
            none = worst.reason or "did not reach it"
            rows.append(
                {
                    "within": all(one.within for one in own),
                    "solution": number,
                    "engine": " ".join(filter(None, engine)),
                    "position": worst.position,
                    "driver_deg": f"{math.degrees(worst.driver_rad):.4f}",
                    "what": in_words(worst.asked),
                    "off": none if math.isnan(worst.off) else f"{worst.off:.1e} {unit}",
                    "allowed": f"{worst.limit:.1e} {unit}",
                }
            )
    return rows


def proof_table(proofs: Mapping[int, Sequence[Met]]) -> Table:
    """Table of the rows for a terminal."""
    heads = ("", "solution", "engine", "position", "driver deg", "what", "off", "allowed")
    return grid(
        heads,
        (
            ("ok" if row["within"] else "OUT", *map(str, list(row.values())[1:]))
            for row in proof_rows(proofs)
        ),
    )


def proof_frame(proofs: Mapping[int, Sequence[Met]]) -> pd.DataFrame:
    """Table of the proof with all digits, a row for each requirement at each position."""
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


def sensitivity_table(
    found: Sensitivity, limits: Sequence[float], tolerance_m: float, spread: Spread
) -> Table:
    """Table of requirements: linear worst case and root of squares, the Monte Carlo's largest, the
    limit, and the dimension of largest influence."""
    rows: list[tuple[str, ...]] = []
    worst, usual = found.worst(tolerance_m), found.usual(tolerance_m)
    for k, (number, asked) in enumerate(found.asked):
        unit, most = unit_of(asked), int(np.argmax(np.abs(found.slopes[k])))
        cells = (worst[k], usual[k], spread.largest[k], limits[k])
        by = f"{found.dimensions[most].words} ({found.slopes[k, most]:.3g} {unit}/m)"
        sizes = (f"{value:.2e} {unit}" for value in cells)
        rows.append((str(number), in_words(asked), *sizes, by))
    heads = ("position", "what", "worst", "root sum sq.", "Monte Carlo", "allowed", "most by")
    return grid(heads, rows, f"Solution 1, errors of every dimension up to {tolerance_m:g} m")


def clearance_in_words(found: Sensitivity, limits: Sequence[float], spread: Spread) -> str:
    """The share of mechanisms that meet the task, and the largest clearance."""
    clearance, row = found.largest_clearance(limits)
    number, asked = found.asked[row]
    lost = f", {spread.lost} could not be assembled" if spread.lost else ""
    return (
        f"{100.0 * spread.share_within:.1f} % of {spread.count} mechanisms meet the task{lost}; "
        f"with a radial clearance of up to {clearance:.3g} m in every joint it is met, set by the "
        f"{in_words(asked)} at position {number}"
    )
