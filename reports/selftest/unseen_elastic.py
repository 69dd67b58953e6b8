"""What no rule sees of elastic links, and need not."""

from __future__ import annotations

from reports.selftest.node_changes import at_quarter, in_chain_log
from reports.selftest.segment_changes import in_chain, segments, springs, stiffer, turning_light
from reports.selftest.unseen import Unseen

UNSEEN_ELASTIC = (
    Unseen(
        "node-elsewhere",
        "a node away from the middle, 1 % too far out",
        "How far the middle is from the line between the pins is what is compared; a chain that is "
        "bent otherwise elsewhere moves otherwise in its middle, too, unless only its log is off.",
        in_chain_log(lambda truth, motion, size: at_quarter(truth, motion, 1e-2 * size)),
        shows=False,  # nothing of it is among the errors
    ),
    Unseen(
        "modulus-hardly",
        "the modulus, by 0.01 %",
        "Within what an engine may be off by at this step; 1 % is seen (modulus-off).",
        in_chain(springs(lambda one, n, size: stiffer(one, n, 1e-4 * size))),
    ),
    Unseen(
        "turning-inertia",
        "segments with 1 % less inertia about their centre",
        "Most of the inertia of a chain is that of its masses across; what rods have about their "
        "own centre falls as 1/n^2, and three times as much of it is seen (inertia-at-ends).",
        in_chain(segments(lambda link, size: turning_light(link, 1e-2 * size))),
    ),
)
