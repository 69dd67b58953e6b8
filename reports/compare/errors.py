"""What a comparison found: one `Error` per quantity and body, and facts of the run in groups."""

import math
from collections.abc import Iterable, Mapping, Sequence, Set
from dataclasses import dataclass, field
from functools import cached_property
from typing import ClassVar, Literal

from analytic.forces.late_impulses import ON_TIME, LateImpulses
from reports.quantities import named
from reports.quantities.limits import DEFAULTS
from reports.quantities.quantity import BodyKind, Source, Tolerance, tolerance_name


@dataclass(frozen=True)
class SceneFacts:
    """How hard a scene is, at its step.

    ``curvature`` is the largest pure acceleration of the reference (at least 1) and
    ``conditioning`` its smallest sine of a transmission angle, away from the change points that it
    goes through. ``step_rad`` is the driver's peak speed times the time between two steps.
    ``summed_rad`` is the most that rounding makes of the driver's angle in an engine that adds it
    up step by step: it grows with the number of steps (`reports.compare.whole_errors`). ``jolt`` is
    how much an engine may make up for at its start, over a step, as a pure number
    (`analytic.forces.late_impulses`), ``worst_jolt`` the most of it over the run, and
    ``mass_ratio`` the mass of the heaviest body over that of the lightest. ``drives_within`` says
    that the driver moves two moving bodies against each other, and ``starts_in_passage`` that one
    of the first samples is near a change point. ``uneven`` is how far bodies depart from moving
    evenly with the driver, ``uneven_rates`` those of them whose rates do too
    (`reports.compare.hardness`).
    """

    curvature: float
    conditioning: float
    step_rad: float
    summed_rad: float = 0.0
    jolt: float = 0.0
    worst_jolt: float = 0.0
    mass_ratio: float = 1.0
    drives_within: bool = False
    starts_in_passage: bool = False
    uneven: Mapping[tuple[BodyKind, str], float] = field(default_factory=dict)
    uneven_rates: Set[tuple[BodyKind, str]] = frozenset()


@dataclass(frozen=True)
class Unbalanced:
    """What the forces of a pin add up to at most, as a share of the largest reaction."""

    point: str
    share: float


@dataclass(frozen=True)
class ForceFacts:
    """What loads do, and what an engine's forces say.

    ``contradictions`` is what the engine's own numbers say against its forces, ``unbalanced`` the
    pin whose forces add up to most, None where there are none; ``start_load`` the largest force at
    the start, as a share of the largest of its kind, where the engine's forces are those of steps,
    which start with half a step. ``loading`` is how loads would shake the bodies by themselves,
    ``load_slopes`` how much they change over a displacement, in reactions and in the torque, and
    ``inertia_share`` what inertia may have of the largest reaction (`reports.compare.hardness`).
    """

    contradictions: tuple[str, ...] = ()
    unbalanced: Unbalanced | None = None
    start_load: float = 0.0
    loading: float = 0.0
    load_slopes: Mapping[str, float] = field(default_factory=dict)
    inertia_share: float = 1.0


@dataclass(frozen=True, kw_only=True)
class MotionFacts:
    """How errors grow with a motion: those of a driver that follows its law do not.

    ``limits`` are the tolerances of the motion, ``closing`` the quantities that finer runs keep
    within theirs. ``cancels`` says that errors may cancel from step to step, and ``solved`` is the
    share of a limit below which an error that does not shrink is no floor of a model.
    ``least_order`` is an order of the step that any engine may reach, and ``step_option`` sets the
    step. ``travel_rad`` is the angle that a free driver turns through, weighed with the square of
    its speed over the largest, ``drifted_rad`` the most that it has turned through over the
    sensitivity of then, and ``late`` what impulses that come a step late may make of its energy.
    """

    limits: ClassVar[Mapping[str, Tolerance]] = DEFAULTS
    closing: ClassVar[Sequence[str]] = named("place", "closure")
    cancels: ClassVar[bool] = False
    solved: ClassVar[float] = 0.0
    least_order: ClassVar[int] = 0
    step_option: ClassVar[str] = "--steps-per-turn"
    over_g: ClassVar[Sequence[str]] = ()
    """What is over the sensitivity, in words, beside other words of errors."""
    sensitivity: float = 1.0
    """By how much a small change of the start has grown by the end."""
    travel_rad: float = 0.0
    drifted_rad: float = 0.0
    late: LateImpulses = ON_TIME

    @property
    def has_order(self) -> bool:
        """Whether errors at finer steps say an order."""
        return True

    def rounding(self, explained: float, summed_rad: float, bound: float) -> float:
        """The pure error of place that no engine is to blame for: ``explained`` by the rounding of
        the driver, or by what its angle is summed to, or by the ``bound`` of the reference."""
        return explained

    def compared_with(self, moved: str) -> str:
        """The reference of the errors, and the letters of their shares; ``moved`` says what moves
        the closed form."""
        return (
            f"Largest errors against the closed form{moved}; L longest link, w driver's peak speed."
        )


DRIVEN = MotionFacts()


@dataclass(frozen=True)
class LinkFacts:
    """What links add to the limits of errors: rigid ones nothing.

    ``followed`` are groups of quantities; the largest error of the first that has any is followed
    from step to step. ``segments`` are those of each link, ``pushed`` is the acceleration that
    elements start off by, over the square of the driver's speed, and ``slender`` the longest link
    over the largest deflection.
    """

    limits: ClassVar[Mapping[str, Tolerance]] = {}
    shut: ClassVar[Sequence[str]] = named("place")
    """Quantities that tell whether joints are closed in their places."""
    followed: ClassVar[Sequence[Sequence[str]]] = (("phase", *named("place")),)
    segments: int = 1
    slender: float = math.inf
    pushed: float = 0.0

    @property
    def locked(self) -> float:
        """What elements lock by, twice, as a share of the largest deflection."""
        return 0.0

    def beyond(self, name: str) -> float:
        """The model error of the links in a quantity, as a pure number."""
        return 0.0

    def deflecting(self, budget: float, step: float) -> float:
        """A budget of places as one of deflections, at a ``step`` [rad]."""
        return budget

    def compared_with(self, motion: MotionFacts, moved: str) -> str:
        """As of the motion."""
        return motion.compared_with(moved)


RIGID = LinkFacts()


ErrorKind = Literal["total", "geometric", "start", "passage", "raw", "chain"]


@dataclass(frozen=True)
class Error:
    """One error series in numbers, in ``unit``.

    ``scale`` makes a pure number of it: 1 rad for angles, the longest link for lengths, the
    driver's speed (times that length) for velocities, its square for accelerations. Rates of the
    first steps, in which an engine takes up its pins, are of kind ``start``, those of later ones
    near a change point of kind ``passage`` (`reports.compare.hardness`). Of free motion they
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
