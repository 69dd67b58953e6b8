"""What stands in another room, by its name: so that lectures are found, and not imported."""

from __future__ import annotations

from importlib import import_module
from typing import Any

FAMILY = "lectures.drawing.workbook.solve_family:run_family"
"""`solve --family`."""
LIVE_SHEET = "lectures.drawing.workbook.live_workbook:live_sheet"
"""Formulas and charts beside the values of `solve -o FILE.xlsx`."""


def named(place: str) -> Any:
    """What has that place, ``room.module:name``, in a room beside this one; loaded now."""
    module, _, name = place.partition(":")
    return getattr(import_module(f"..{module}", __package__), name)
