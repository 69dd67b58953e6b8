"""From the table `[start]` of a scene file to a start, and what is wrong with its names."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

from models.errors import cut, few
from models.schema import StartTable
from models.start import Start

OF_LINKS, OF_SLIDERS = ("angles_deg", "rates_rad_s"), ("displacements_m", "speeds_m_s")


def start_of(table: StartTable) -> Start:
    """The start, angles in radians."""
    return Start(
        {link: math.radians(angle) for link, angle in table.angles_deg.items()},
        dict(table.rates_rad_s),
        dict(table.displacements_m),
        dict(table.speeds_m_s),
        table.shape,
    )


def faults_of_start(
    start: Mapping[str, Any], links: Mapping[str, Any], sliders: Mapping[str, Any]
) -> Iterator[str]:
    """One line per link or slider of the raw table that the scene has not."""
    for keys, known in ((OF_LINKS, links), (OF_SLIDERS, sliders)):
        for key in keys:
            table = start.get(key)
            for name in table if isinstance(table, Mapping) else ():
                if name not in known:
                    have = f"use one of {few(map(cut, known), 12)}" if known else "there is none"
                    yield f"start.{key}: found {cut(name)}; {have}"
