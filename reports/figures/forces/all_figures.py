"""The figures of forces by name, which is that of their file. To add one, add a file and a line
here."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from matplotlib.figure import Figure

from reports.figures.forces import efficiency, hodographs, loaded, reaction_sizes, reduced, torque
from reports.figures.forces.force_turn import ForceTurn

FORCE_FIGURES: Mapping[str, Callable[[ForceTurn], Figure | None]] = {
    "torque": torque.draw,
    "reactions": reaction_sizes.draw,
    "efficiency": efficiency.draw,
    "reduced": reduced.draw,
    "forces": loaded.draw,
    "reactions-polar": hodographs.draw,
}
"""Each gives None where a scene has nothing to draw: with redundant links there are no
reactions, without friction there is no efficiency, and where friction locks nearly all of a turn
there are no forces."""
