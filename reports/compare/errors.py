"""Result of a comparison: one `Error` per quantity and body, and facts of the run in groups."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence, Set
from dataclasses import dataclass, field
from functools import cached_property
from typing import ClassVar, Literal

from analytic.forces.late_impulses import ON_TIME, LateImpulses
from reports.quantities import named
from reports.quantities.limits import BENDING, DEFAULTS
from reports.quantities.quantity import BodyKind, Source, Tolerance, tolerance_name
from sim.engine import AT_ROUNDING

FACETED, STEPPED = 3.0, 3.0
"""Factors of the errors of cams by contact, by facets and by steps: observed are up to half."""


@dataclass(frozen=True)
class FacetFacts:
    """Facets of a cam, as pure numbers: ``sagitta`` of the profile over a facet, ``corner``, by
    which the follower's speed changes from one facet to the next, and the acceleration ``closing``
    the contact by springs, weights and loads."""

    sagitta: float
    corner: float
    closing: float

    def error(self, rate: int, step_rad: float) -> float:
        """Return the pure error of a rate of this order. A follower flies over each corner, and
        lands within a step; accelerations are those of impacts, and have no limit."""
        flight = 0.5 * self.corner**2 / self.closing if self.closing > 0.0 else 0.0
        faceted = (self.sagitta + flight, self.corner, math.inf)[rate]
        return FACETED * faceted + STEPPED * self.closing * step_rad ** (2 - rate)


@dataclass(frozen=True)
class SceneFacts:
    """Difficulty of a scene, at its step.

    ``curvature`` is the largest pure acceleration of the reference (at least 1) and
    ``conditioning`` its smallest sine of a transmission angle, away from the change points on its
    way. ``step_rad`` is the driver's peak speed times the time between two steps. ``summed_rad`` is
    the largest effect of rounding on the driver's angle in an engine that adds it up step by step:
    it grows with the number of steps (`reports.compare.whole_errors`). ``jolt`` is the most that an
    engine may make up for at its start, over a step, as a pure number
    (`analytic.forces.late_impulses`), ``worst_jolt`` its maximum over the run, and ``mass_ratio``
    the mass of the heaviest body over that of the lightest. ``drives_within`` is True if the driver
    moves two moving bodies against each other, and ``starts_in_passage`` if one of the first
    samples is near a change point. ``uneven`` is the departure of bodies from even motion with the
    driver, ``uneven_rates`` those of them whose rates depart too (`reports.compare.hardness`).
    ``floor`` is the pure error that rounding leaves in the engine (`sim.engine.Engine`).
    ``law_jumps`` are the largest jumps of acceleration and jerk in the laws of cams, pure;
    ``parting`` is the acceleration with which loads would part its gears and cams at the start, and
    ``facets`` the facts of cams by contact.
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
    floor: float = AT_ROUNDING
    law_jumps: tuple[float, float] = (0.0, 0.0)
    parting: float = 0.0
    facets: FacetFacts | None = None

    def jumping(self, rate: int) -> float:
        """Return the pure error of a rate of this order in and beside the jumps of laws of cams: a
        step over one has some of each side, and a stiff joint answers a jump of the acceleration by
        as much again to the other."""
        acceleration, jerk = self.law_jumps
        return (3.0 * acceleration + 0.5 * jerk * self.step_rad) * self.step_rad ** (2 - rate)


@dataclass(frozen=True)
class Unbalanced:
    """Largest sum of the forces of a pin, as a share of the largest reaction."""

    point: str
    share: float


@dataclass(frozen=True)
class ForceFacts:
    """Effects of loads, and properties of an engine's forces.

    ``contradictions`` are those between the engine's own numbers and its forces, ``unbalanced`` the
    pin with the largest sum of forces, None where there are none; ``start_load`` is the largest
    force at the start, as a share of the largest of its kind, where the engine's forces are those
    of steps, which start with half a step. ``loading`` is the shaking of the bodies by loads alone,
    ``load_slopes`` the change of loads over a displacement, in reactions and in the torque, and
    ``inertia_share`` the most of the largest reaction due to inertia (`reports.compare.hardness`).
    """

    contradictions: tuple[str, ...] = ()
    unbalanced: Unbalanced | None = None
    start_load: float = 0.0
    loading: float = 0.0
    load_slopes: Mapping[str, float] = field(default_factory=dict)
    inertia_share: float = 1.0


@dataclass(frozen=True, kw_only=True)
class MotionFacts:
    """Growth of errors with a motion: with a driver that follows its law they do not grow.

    ``limits`` are the tolerances of the motion, ``closing`` the quantities that finer runs keep
    within theirs. ``cancels`` is True if errors may cancel from step to step, and ``solved`` is the
    share of a limit below which an error that does not shrink is no floor of a model.
    ``least_order`` is an order of the step that any engine may reach, and ``step_option`` sets the
    step. ``travel_rad`` is the angle that a free driver turns through, weighed with the square of
    its speed over the largest, ``drifted_rad`` the largest angle turned over the sensitivity at
    that time, and ``late`` the effect on its energy of impulses that come a step late.
    """

    limits: ClassVar[Mapping[str, Tolerance]] = DEFAULTS
    closing: ClassVar[Sequence[str]] = named("place", "closure")
    cancels: ClassVar[bool] = False
    solved: ClassVar[float] = 0.0
    least_order: ClassVar[int] = 0
    step_option: ClassVar[str] = "--steps-per-turn"
    over_g: ClassVar[Sequence[str]] = ()
    """Quantities over the sensitivity, in words, beside other words of errors."""
    sensitivity: float = 1.0
    """Growth of a small change of the start until the end."""
    travel_rad: float = 0.0
    drifted_rad: float = 0.0
    late: LateImpulses = ON_TIME

    @property
    def has_order(self) -> bool:
        """True if errors at finer steps show an order."""
        return True

    def rounding(self, explained: float, summed_rad: float, bound: float) -> float:
        """Return the pure error of position that no engine can avoid: ``explained`` by rounding of
        the driver, or by summation of its angle, or by the ``bound`` of the reference."""
        return explained

    def compared_with(self, moved: str) -> str:
        """Return reference and shares of the errors; ``moved`` is a change of the closed form."""
        return (
            f"Largest errors against the closed form{moved}; L longest link, w driver's peak speed."
        )


DRIVEN = MotionFacts()


@dataclass(frozen=True)
class LinkFacts:
    """Contribution of the links to the limits of errors: none for rigid ones.

    ``followed`` are groups of quantities; the largest error of the first that has any is followed
    from step to step. ``segments`` are those of each link, ``pushed`` is the error of the elements'
    acceleration at the start, over the square of the driver's speed, and ``slender`` the longest
    link over the largest deflection.
    """

    limits: ClassVar[Mapping[str, Tolerance]] = {}
    shut: ClassVar[Sequence[str]] = named("place")
    """Quantities that show whether joints are closed in their places."""
    followed: ClassVar[Sequence[Sequence[str]]] = (("phase", *named("place")),)
    segments: int = 1
    slender: float = math.inf
    pushed: float = 0.0

    @property
    def locked(self) -> float:
        """Twice the locking of elements, as a share of the largest deflection."""
        return 0.0

    def beyond(self, name: str) -> float:
        """Return the model error of the links in a quantity, as a pure number."""
        return 0.0

    def deflecting(self, budget: float, step: float) -> float:
        """Return a budget of positions as one of deflections, at a ``step`` [rad]."""
        return budget

    def compared_with(self, motion: MotionFacts, moved: str) -> str:
        """Return the words of the motion."""
        return motion.compared_with(moved)


RIGID = LinkFacts()


ErrorKind = Literal["total", "geometric", "start", "passage", "raw", "chain"]


@dataclass(frozen=True)
class Error:
    """One error series in numbers, in ``unit``.

    ``scale`` makes a pure number of it: 1 rad for angles, the longest link for lengths, the
    driver's speed (times that length) for velocities, its square for accelerations. Rates of the
    first steps, in which an engine takes up its pins, are of kind ``start``, those of later ones
    near a change point of kind ``passage`` (`reports.compare.hardness`). For free motion all are
    over the sensitivity, except those of kind ``raw``. Kind ``chain`` is the exact chain of
    segments, without an engine. ``bound`` is the largest error of the reference itself [unit].
    ``driver_at_maximum_rad`` is in ``driver_unit``: m of a slider.
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
        """The name of the tolerance for a total error."""
        return tolerance_name(self.quantity, self.source)

    @property
    def finite(self) -> bool:
        return math.isfinite(self.maximum)


@dataclass(frozen=True)
class Departure:
    """Place where a run changed to the other assembly: link, time [s] and commanded place of the
    driver, in ``driver_unit``."""

    link: str
    time_s: float
    driver_rad: float
    driver_unit: str = "rad"


@dataclass(frozen=True)
class Errors:
    """All errors of one run, and its facts in groups.

    ``missing`` names the parts of the scene that the log lacks; ``incomplete`` describes the gap of
    the time stamps against the commanded ones, and is empty without one. ``uncertain`` is the
    uncertainty of the reference, per quantity and body over the whole run, as a pure number: the
    same for every engine, whatever it reports. ``departure`` is None where the run stayed on its
    branch.
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
        """Return the reference of the errors, and the letters of their shares, as shown below every
        table of them. ``moved`` names a change of a closed form."""
        return self.of_links.compared_with(self.of_motion, moved)

    def worst(
        self, quantity: str, source: Source = "reported", kind: ErrorKind = "total"
    ) -> Error | None:
        """Return the largest pure error of a quantity (not finite counts as largest)."""
        return self._largest.get((quantity, source, kind))

    @cached_property
    def _largest(self) -> Mapping[tuple[str, str, str], Error]:
        groups = dict[tuple[str, str, str], list[Error]]()
        for row in self.rows:
            groups.setdefault((row.quantity, row.source, row.kind), []).append(row)
        return {key: max(rows, key=_size) for key, rows in groups.items()}


def largest(rows: Iterable[Error]) -> Error | None:
    """Return the row with the largest pure error; a value that is not finite counts as largest."""
    return max(rows, key=_size, default=None)


def _size(row: Error) -> float:
    return row.pure if row.finite else math.inf


BENT = (
    "Elastic links: largest errors against the solved motion of the beam with foreshortening at "
    "the same time"
)


@dataclass(frozen=True, kw_only=True)
class ElasticFacts(LinkFacts):
    """Facts of elastic links: ``segments`` of each link, with a kind of ``springs``, or elements
    where that is "beam"; ``ratio`` is their lowest frequency over the driver's speed, and
    ``cycles`` the number of its swings over the run, 0 where the motion is periodic. ``slender`` is
    the longest link over the largest deflection.

    ``straight`` links start so, and ring with all their deflection; ``pushed`` is the error of the
    elements' acceleration at the start, over the square of the driver's speed.

    As shares of the largest deflection: ``doubt`` is the uncertainty of the beam, and ``linear``
    the error of the linear theory, without foreshortening. ``apart`` is the distance of the exact
    chain from the beam, as a pure number by quantity, for free motion with the uncertainty of the
    beam; for a driven motion that is not periodic it is ``estimated`` from a chain of a few
    segments, and for elements from their locking.
    """

    limits: ClassVar[Mapping[str, Tolerance]] = BENDING
    shut: ClassVar[Sequence[str]] = named("closure")
    followed: ClassVar[Sequence[Sequence[str]]] = (("segments",), ("deflection",))
    springs: str
    ratio: float
    cycles: float
    doubt: float
    linear: float
    apart: Mapping[str, float] = field(default_factory=dict)
    estimated: bool = False
    straight: bool = False

    @staticmethod
    def of(errors: Errors | None) -> ElasticFacts | None:
        """Return the facts of elastic links, None for rigid ones."""
        facts = errors.of_links if errors else None
        return facts if isinstance(facts, ElasticFacts) else None

    @property
    def of_beam(self) -> bool:
        """True if they are elements of a beam."""
        return self.springs == "beam"

    @property
    def pieces(self) -> str:
        """The number and kind of the pieces, in words."""
        return f"{self.segments} {'elements' if self.of_beam else 'segments'}"

    @property
    def chain(self) -> float:
        """Error of the segments in the deflection, as a share of the largest."""
        return self.apart.get("deflection", 0.0)

    @property
    def locked(self) -> float:
        return 2.0 * self.chain if self.of_beam else 0.0

    def beyond(self, name: str) -> float:
        """Return the model error of the segments (or beam elements), and of the beam theory."""
        if name == "segments":
            return 0.0
        own = self.apart.get(name.removesuffix("-differenced"), 0.0)
        own *= 2.0 if self.estimated else 1.0
        return own + (self.doubt if name == "deflection" else 0.0)

    def deflecting(self, budget: float, step: float) -> float:
        return budget * (1.0 if self.of_beam else self.slender) + self._swung(step)

    def _swung(self, step: float) -> float:
        """Return the error of the swings of springs; a step makes (r step)^2/24 of the phase.

        Links that start straight ring as under an even load: k half-waves, k odd, with 1/k^5 of the
        deflection, k^2 times as fast, and so with k^6 of the phase, up to their whole swing. The
        sum of these falls as the step to the power 4/3.
        """
        phase = (self.ratio * step) ** 2 * (1.0 + math.tau * self.cycles) / 12.0
        if not self.straight:
            return phase
        return sum(min(2.0, k**6 * phase) / k**5 for k in range(1, self.segments, 2))

    def compared_with(self, motion: MotionFacts, moved: str) -> str:
        parts = [BENT + ", segments against the exact chain of as many" * (not self.of_beam)]
        parts += [*motion.over_g, "D largest deflection, L longest link, w driver's peak speed."]
        return "; ".join(parts)
