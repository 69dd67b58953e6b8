"""What a comparison found: one `Error` per quantity and body, and facts of the run in groups."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

from reports.compare.facts import DRIVEN, RIGID, ForceFacts, LinkFacts, MotionFacts, SceneFacts
from reports.quantities.quantity import BodyKind, Source, Tolerance, tolerance_name

ErrorKind = Literal["total", "geometric", "start", "passage", "raw", "chain"]


@dataclass(frozen=True)
class Error:
    """One error series in numbers, in ``unit``.

    ``scale`` makes a pure number of it: 1 rad for angles, the longest link for lengths, the
    driver's speed (times that length) for velocities, its square for accelerations. Rates of the
    first steps, in which an engine takes up its pins, are of kind ``start``, those of later ones
    near a change point of kind ``passage`` (`reports.compare.change_points`). Of free motion they
    are all over the sensitivity, and those of kind ``raw`` are not. Those of kind ``chain`` are of
    the exact chain of segments, without an engine. ``bound`` is the largest error
    of the reference itself [unit]. ``driver_at_maximum_rad`` is in ``driver_unit``: m of a slider.
    """

    quantity: str
    body_kind: BodyKind
    body: str
    source: Source
    kind: ErrorKind
    unit: str
    scale: float
    maximum: float
    rms: float
    final: float
    time_of_maximum_s: float
    driver_at_maximum_rad: float
    bound: float
    samples: int
    driver_unit: str = "rad"

    @property
    def pure(self) -> float:
        """The maximum as a pure number."""
        return self.maximum / self.scale

    @property
    def pure_bound(self) -> float:
        """The reference's own error as a pure number."""
        return self.bound / self.scale

    @property
    def tolerance(self) -> str:
        """The name of the tolerance that a total error is held to."""
        return tolerance_name(self.quantity, self.source)

    @property
    def finite(self) -> bool:
        return math.isfinite(self.maximum)


@dataclass(frozen=True)
class Departure:
    """Where a run went over to the other assembly: link, time [s] and commanded place of the
    driver, in ``driver_unit``."""

    link: str
    time_s: float
    driver_rad: float
    driver_unit: str = "rad"


@dataclass(frozen=True)
class Errors:
    """All errors of one run, and what is known of it beside them, in groups.

    ``missing`` names what the scene has and the log has not; ``incomplete`` says what the time
    stamps lack of those that were commanded, and is empty where they are whole. ``uncertain`` is
    what the reference may be wrong by, per quantity and body over the whole run, as a pure number:
    the same for every engine, whatever it reports. ``departure`` is None where the run stayed on
    its branch.
    """

    rows: tuple[Error, ...]
    not_reported: tuple[str, ...]
    notes: tuple[str, ...]
    of_scene: SceneFacts
    of_forces: ForceFacts = field(default_factory=ForceFacts)
    of_motion: MotionFacts = DRIVEN
    of_links: LinkFacts = RIGID
    missing: tuple[str, ...] = ()
    incomplete: str = ""
    uncertain: Mapping[tuple[str, str], float] = field(default_factory=dict)
    departure: Departure | None = None

    @cached_property
    def limits(self) -> Mapping[str, Tolerance]:
        """The tolerances of such a run, by name."""
        return {**self.of_motion.limits, **self.of_links.limits}

    def compared_with(self, moved: str = "") -> str:
        """The reference of the errors, and the letters of their shares: it stands under every table
        of them. ``moved`` says what moves a closed form."""
        return self.of_links.compared_with(self.of_motion, moved)

    def worst(
        self, quantity: str, source: Source = "reported", kind: ErrorKind = "total"
    ) -> Error | None:
        """The largest error of a quantity as a pure number (not finite counts as largest)."""
        return largest(
            row
            for row in self.rows
            if (row.quantity, row.source, row.kind) == (quantity, source, kind)
        )


def largest(rows: Iterable[Error]) -> Error | None:
    """The row with the largest pure error; one that is not finite is larger than any."""
    return max(rows, key=lambda row: row.pure if row.finite else math.inf, default=None)
