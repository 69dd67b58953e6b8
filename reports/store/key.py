"""The names of cells: a hash of all that a result depends on."""

from __future__ import annotations

import hashlib
import json
import tomllib
from collections.abc import Mapping

from reports.cell import Cell
from sim.engine import SettingValue

MEASURE = 1
"""Raised whenever the same run would be measured differently: older rows are then not reused."""


def digest(text: str) -> str:
    """The hash of a scene's text, in which comments and layout do not count."""
    return _hash(tomllib.loads(text))


def line_key(
    cell: Cell, scene_digest: str, version: str, settings: Mapping[str, SettingValue]
) -> str:
    """What all cells share that differ in step only. ``settings`` is the complete set."""
    return _hash(
        [
            MEASURE,
            scene_digest,
            cell.engine,
            version,
            dict(settings),
            cell.drive,
            round(cell.turns, 6),
        ]
    )


def cell_key(line: str, cell: Cell) -> str:
    """The key of a cell on its line."""
    return _hash([line, cell.dt_s.hex(), cell.steps])


def _hash(value: object) -> str:
    """160 bits are enough for any store, and short enough for a file name."""
    text = json.dumps(value, sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()[:40]
