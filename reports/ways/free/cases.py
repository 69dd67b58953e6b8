"""Hard cases of free motion, by the group of the catalogue."""

from reports.stability.catalogue import (
    free_motion,
    toggles,
)

CASES = {
    "free motion": free_motion.CASES,
    "free motion at a toggle": toggles.CASES,
}
