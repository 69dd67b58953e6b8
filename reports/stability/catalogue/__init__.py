"""The hard cases, by name; each file is one group of the catalogue.

Another case is another `Case` in the tuple ``CASES`` of its group's file; another group is another
file and its name in `GROUPS`.
"""

from __future__ import annotations

from reports.stability.case import Case
from reports.stability.catalogue import (
    change_points,
    driving,
    duration,
    levers,
    limits,
    masses,
    redundancy,
    scales,
    slider_cranks,
    starts,
    stepping,
)

GROUPS = (
    change_points,
    slider_cranks,
    limits,
    driving,
    masses,
    scales,
    redundancy,
    starts,
    duration,
    stepping,
    levers,
)
CATALOGUE: dict[str, Case] = {case.name: case for group in GROUPS for case in group.CASES}
