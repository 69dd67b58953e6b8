"""What a comparison found: one `Error` per quantity and body, and the reference's own facts."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Set
from dataclasses import dataclass, field
from typing import Literal

from analytic.forces.late_impulses import ON_TIME, LateImpulses
from reports.compare.elastic.elastic_facts import ElasticFacts
from reports.compare.free.free_facts import FreeFacts
from reports.quantities.quantity import BodyKind, Source, tolerance_name

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
class Unbalanced:
    """What the forces of a pin add up to at most, as a share of the largest reaction."""

    point: str
    share: float


@dataclass(frozen=True)
class Errors:
    """All errors of one run.

    ``curvature`` is the largest pure acceleration of the reference (at least 1) and
    ``conditioning`` its smallest sine of a transmission angle, away from the change points that it
    goes through: both say how hard the scene is. ``step_rad`` is the driver's peak speed times the
    time between two steps. ``missing`` names what the scene has and the log has not; ``incomplete``
    says what the time stamps lack of those that were commanded, and is empty where they are whole.
    ``uncertain`` is what the reference may be wrong by, per quantity and body over the whole run,
    as a pure number: the same for every engine, whatever it reports. ``departure`` is None where
    the run stayed on its branch. ``summed_rad`` is the most that rounding makes of the driver's
    angle in an engine that adds it up step by step: it is what grows with the number of steps
    (`reports.compare.drive_rounding`). ``jolt`` is how much an engine may make up for at its start,
    over a step, as a pure number (`analytic.forces.late_impulses`), ``worst_jolt`` the most of it
    over the run, and ``mass_ratio`` the mass of the heaviest body over that of the lightest.
    ``drives_within`` says that the driver moves two moving bodies against each other, and
    ``starts_in_passage`` says that one of the first samples is near a change point. ``uneven`` is
    how far bodies depart from moving evenly with the driver, ``uneven_rates`` those of them whose
    rates do too (`reports.compare.uneven`). ``contradictions`` is what the engine's own numbers say
    against its forces, ``unbalanced`` the pin whose forces add up to most,
    None where there are none; ``start_load`` the largest force at the start, as a share of the
    largest of its kind, where the engine's forces are those of steps, which start with half a step.
    ``loading`` is how loads would shake the bodies by themselves, ``load_slopes`` how much they
    change over a displacement, in reactions and in the torque, and ``inertia_share`` what inertia
    may have of the largest reaction (`reports.compare.loading`). ``travel_rad`` is the angle
    that a driver which was let go turns through, weighed with the square of its speed over the
    largest, ``drifted_rad`` the most that it has turned through over the sensitivity of then, and
    ``late`` what impulses that come a step late may make of its energy, all 0 of one that is
    driven; ``free`` is what else there is to know of a run that was let go, None
    of one that was driven; ``elastic`` what there is to know where links bend, else None.
    """

    rows: tuple[Error, ...]
    not_reported: tuple[str, ...]
    notes: tuple[str, ...]
    curvature: float
    conditioning: float
    step_rad: float
    missing: tuple[str, ...] = ()
    incomplete: str = ""
    uncertain: Mapping[tuple[str, str], float] = field(default_factory=dict)
    departure: Departure | None = None
    summed_rad: float = 0.0
    jolt: float = 0.0
    worst_jolt: float = 0.0
    mass_ratio: float = 1.0
    drives_within: bool = False
    starts_in_passage: bool = False
    uneven: Mapping[tuple[BodyKind, str], float] = field(default_factory=dict)
    uneven_rates: Set[tuple[BodyKind, str]] = frozenset()
    contradictions: tuple[str, ...] = ()
    unbalanced: Unbalanced | None = None
    start_load: float = 0.0
    loading: float = 0.0
    load_slopes: Mapping[str, float] = field(default_factory=dict)
    inertia_share: float = 1.0
    travel_rad: float = 0.0
    drifted_rad: float = 0.0
    late: LateImpulses = ON_TIME
    free: FreeFacts | None = None
    elastic: ElasticFacts | None = None

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
