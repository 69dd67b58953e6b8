"""The names of cells: a hash of all that a result depends on."""

from __future__ import annotations

import hashlib
import json
import tomllib
from collections.abc import Mapping

from reports.judge.cell import Cell
from sim.engine import SettingValue

MEASURE = 2
"""Raised whenever the same run would be measured differently: older rows are then not reused."""


def digest(text: str) -> str:
    """The hash of a scene's text, in which comments and layout do not count.

    The order of its tables does: engines solve joints in that order, and err otherwise in another.
    """
    return _hash(tomllib.loads(text))


def shape_digest(text: str) -> str:
    """The hash of a scene's text, in which the size and direction of the driver's speed do not
    count either: without a time scale of their own, scenes alike in this have the same angles at
    the same steps in a turn."""
    table = tomllib.loads(text)
    driver = table.get("driver")
    if isinstance(driver, dict):
        driver.pop("speed_rad_s", None)
    return _hash(table)


def line_key(
    cell: Cell, turns: float, scene_digest: str, version: str, settings: Mapping[str, SettingValue]
) -> str:
    """What all cells share that differ in step only.

    ``turns`` is what was asked for, which the steps of a cell may not divide; ``settings`` is the
    complete set. Engines did not always take loads and friction: rows of that time, which say
    "unsupported", have another name than those of today.
    """
    return _hash(
        [
            MEASURE,
            scene_digest,
            cell.engine,
            version,
            sorted(settings.items()),
            cell.drive,
            turns,
            *(["forces"] if cell.with_forces else ()),
            *(["loads"] if cell.scene.loads else ()),
            *(["friction"] if cell.scene.friction else ()),
            *(["elastic", cell.segments, cell.springs] if cell.scene.elastic else ()),
        ]
    )


def cell_key(line: str, cell: Cell) -> str:
    """The key of a cell on its line."""
    return _hash([line, cell.dt_s.hex(), cell.steps])


def _hash(value: object) -> str:
    """160 bits are enough for any store, and short enough for a file name."""
    text = json.dumps(value, default=str)
    return hashlib.sha256(text.encode()).hexdigest()[:40]
