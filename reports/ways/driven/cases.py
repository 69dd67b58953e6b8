"""Hard cases of driven scenes, by the group of the catalogue."""

from reports.stability.catalogue import change_points
from reports.stability.catalogue.bodies import MASSES, SCALES, STARTS
from reports.stability.catalogue.cams import CAMS
from reports.stability.catalogue.driving import AT_LIMITS, DRIVING, DURATION, NEAR_LIMITS, STEPPING

CASES = {
    "change points": change_points.CHANGE_POINTS,
    "slider-crank, rod as long as the crank": change_points.SLIDER_CRANKS,
    "toggle and locking": AT_LIMITS,
    "close to a limit position": NEAR_LIMITS,
    "speed and its changes": DRIVING,
    "mass ratios": MASSES,
    "scale, place and direction": SCALES,
    "redundancy": change_points.REDUNDANCY,
    "bad starts": STARTS,
    "duration": DURATION,
    "step and solver": STEPPING,
    "slotted lever, crank through the pivot": change_points.LEVERS,
    "cams by contact": CAMS,
}
