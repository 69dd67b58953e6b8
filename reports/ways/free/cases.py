"""Hard cases of free motion, by the group of the catalogue."""

from reports.stability.catalogue.free_motion import FREE_MOTION, TOGGLES

CASES = {"free motion": FREE_MOTION, "free motion at a toggle": TOGGLES}
