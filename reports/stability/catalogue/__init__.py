"""The hard cases, by name; each file is one group of the catalogue.

Another case is another `Case` in the tuple ``CASES`` of its group's file; another group is another
file and its line in `GROUPS`.
"""

from __future__ import annotations

from dataclasses import replace

from reports.stability.case import Case
from reports.stability.catalogue import (
    change_points,
    driving,
    duration,
    elastic_links,
    free_motion,
    levers,
    limits,
    masses,
    near_limits,
    redundancy,
    scales,
    slider_cranks,
    starts,
    stepping,
    toggles,
)

GROUPS = {
    "change points": change_points.CASES,
    "slider-crank, rod as long as the crank": slider_cranks.CASES,
    "toggle and locking": limits.CASES,
    "close to a limit position": near_limits.CASES,
    "speed and its changes": driving.CASES,
    "mass ratios": masses.CASES,
    "scale, place and direction": scales.CASES,
    "redundancy": redundancy.CASES,
    "bad starts": starts.CASES,
    "duration": duration.CASES,
    "step and solver": stepping.CASES,
    "slotted lever, crank through the pivot": levers.CASES,
    "free motion": free_motion.CASES,
    "free motion at a toggle": toggles.CASES,
    "elastic links": elastic_links.CASES,
}
CATALOGUE: dict[str, Case] = {
    case.name: replace(case, group=group) for group, cases in GROUPS.items() for case in cases
}
