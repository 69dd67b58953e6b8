"""How one hypothesis accounts for errors, and what it costs to believe it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from reports.causes.world import World

CAUSE, CHOICE, NUMBER = 0.5, 0.5, 1.0
"""What it takes to believe that there is a cause at all, that it is one of several, and that a
number in it is what it is, in powers of ten of what is left of an error: a cause with one more
number has to leave ten times less."""

BOUNDED = 0.05
"""What counts as left of an error that has the size and the shape that it may have from some fault,
where that does not tell each number."""


@dataclass(frozen=True)
class Account:
    """What one hypothesis says.

    ``rests`` is what it leaves of each error that it explains, by column, and ``lefts`` the largest
    error that is left over the one that there was. ``phrase`` has ``{who}`` for the channels, and
    verbs as ``{is}``, ``{has}``, ``{belongs}`` or ``{s}``; without them it is about the log as a
    whole, and accounts with the same phrase are told as one. ``corrections`` is what to write in
    the map, by column. A ``world`` is what the whole log is of, if this is so. ``order`` is the
    place of the hypothesis in its list.
    """

    name: str
    cost: float
    rests: Mapping[str, float]
    lefts: Mapping[str, float]
    phrase: str
    corrections: Mapping[str, Mapping[str, object]] = field(default_factory=dict)
    world: World | None = None
    order: int = 0

    @property
    def columns(self) -> tuple[str, ...]:
        return tuple(self.rests)
