"""Hard cases of driven scenes, by the group of the catalogue."""

from reports.stability.catalogue import (
    change_points,
    driving,
    duration,
    levers,
    limits,
    masses,
    near_limits,
    redundancy,
    scales,
    slider_cranks,
    starts,
    stepping,
)

CASES = {
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
}
