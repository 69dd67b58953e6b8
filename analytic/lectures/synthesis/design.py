"""Mechanism proposed by a synthesis: its scene, its required positions, and its construction."""

import itertools
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from analytic.kinematics import solve_driven
from analytic.lectures.synthesis.pose import PlanePose, PoseDyad
from models.array import Array
from models.lectures.draft import SPEED_RAD_S, Draft, bar, plate
from models.motion import Motion
from models.scene import Scene


@dataclass(frozen=True)
class AskedAngle:
    """Required angle of a link [rad], whole turns apart."""

    link: str
    angle: float

    def value(self, motion: Motion) -> NDArray[np.complex128]:
        """Return the angle in a motion as a turn exp(i angle), (T,)."""
        return np.asarray(np.exp(1j * motion.links[self.link].theta))

    def off(self, motion: Motion) -> Array:
        """Return the error of a motion [rad], (T,), with its sign."""
        off = motion.links[self.link].theta - self.angle
        return np.asarray(off - math.tau * np.round(off / math.tau))


@dataclass(frozen=True)
class AskedPlace:
    """Required place of a point [m]."""

    point: str
    place: complex

    def value(self, motion: Motion) -> NDArray[np.complex128]:
        """Return the place in a motion [m], (T,)."""
        place = motion.points[self.point].position
        return np.asarray(place[:, 0] + 1j * place[:, 1])

    def off(self, motion: Motion) -> Array:
        """Return the distance of a motion from it [m], (T,)."""
        way = motion.points[self.point].position - (self.place.real, self.place.imag)
        return np.asarray(np.hypot(way[:, 0], way[:, 1]))


@dataclass(frozen=True)
class AskedSlide:
    """Required displacement of a slider [m]."""

    slider: str
    displacement: float

    def value(self, motion: Motion) -> NDArray[np.complex128]:
        """Return the displacement in a motion [m], (T,)."""
        return motion.sliders[self.slider].displacement.astype(complex)

    def off(self, motion: Motion) -> Array:
        """Return the error of a motion [m], (T,), with its sign."""
        return np.asarray(motion.sliders[self.slider].displacement - self.displacement)


Asked = AskedAngle | AskedPlace | AskedSlide


@dataclass(frozen=True)
class PrecisionPosition:
    """Requirements at an angle of the driver [rad], measured as in the scene."""

    driver_rad: float
    asked: tuple[Asked, ...]

    def off(self, motion: Motion, size_m: float) -> Array:
        """Return the largest error of a motion, (T,): angles in rad, lengths over the size."""
        scales = [1.0 if isinstance(each, AskedAngle) else size_m for each in self.asked]
        off = [np.abs(each.off(motion)) / by for each, by in zip(self.asked, scales, strict=True)]
        return np.asarray(np.max(off, axis=0))


def names_of(positions: Sequence[PrecisionPosition]) -> tuple[list[str], list[str], list[str]]:
    """Return the links, points and sliders with a requirement."""
    every = [each for position in positions for each in position.asked]
    links = dict.fromkeys(each.link for each in every if isinstance(each, AskedAngle))
    points = dict.fromkeys(each.point for each in every if isinstance(each, AskedPlace))
    sliders = dict.fromkeys(each.slider for each in every if isinstance(each, AskedSlide))
    return list(links), list(points), list(sliders)


def asked_motion(scene: Scene, positions: Sequence[PrecisionPosition]) -> Motion:
    """Solve the scene at the driver's angles of positions (P,), for required quantities alone.
    Raises ReachError for an angle at which it can not be assembled."""
    links, points, sliders = names_of(positions)
    return solve_driven(
        scene,
        np.array([position.driver_rad for position in positions]),
        np.ones(1),
        np.zeros(1),
        links=links,
        points=points,
        sliders=sliders,
        bound=False,
    )


Look = Literal["given", "auxiliary", "result"]
"""Role of an element: given by the task, auxiliary in the construction, or a resulting link."""


@dataclass(frozen=True)
class Dot:
    """Point with its letter; ``fixed`` is drawn as a pivot of the ground."""

    place: complex
    letter: str
    look: Look = "auxiliary"
    fixed: bool = False


@dataclass(frozen=True)
class Segment:
    """Straight line between two places, extended by ``beyond`` of its length past both ends."""

    start: complex
    end: complex
    look: Look = "auxiliary"
    beyond: float = 0.0


@dataclass(frozen=True)
class DrawnCircle:
    """Circle, or an arc of it counter-clockwise from one direction to another [rad]."""

    centre: complex
    radius: float
    look: Look = "auxiliary"
    arc: tuple[float, float] | None = None


@dataclass(frozen=True)
class DrawnCurve:
    """Curve through many places, in pieces."""

    pieces: tuple[tuple[complex, ...], ...]
    look: Look = "auxiliary"


Element = Dot | Segment | DrawnCircle | DrawnCurve


def numbered(letter: str, places: Iterable[complex], look: Look = "auxiliary") -> list[Dot]:
    """Return the dots of a point in its positions, from 1 on."""
    return [Dot(place, f"{letter}{number}", look) for number, place in enumerate(places, 1)]


def rays(start: complex, ends: Iterable[complex], look: Look = "auxiliary") -> list[Segment]:
    """Return the lines from a place to others."""
    return [Segment(start, end, look) for end in ends]


def chained(*places: complex) -> list[Segment]:
    """Return the resulting links from each place to the next one."""
    return [Segment(one, other, "result") for one, other in itertools.pairwise(places)]


@dataclass(frozen=True)
class DrawingStep:
    """Step of a construction: its text and its drawn elements."""

    words: str
    elements: tuple[Element, ...]


@dataclass(frozen=True)
class Proposal:
    """Result of a construction: the tables of a scene without its law, the link that drives, the
    precision positions with the driver's angles [rad] in the required order.

    ``chosen`` are the numbers that the task left open, in words and SI units; ``steps`` draw the
    construction of the rest. ``doubt`` names requirements that could not be met. ``speed_rad_s`` is
    the driver's speed, or the circular frequency of its swing. ``allowed`` is the tolerance of a
    position (angles in rad, lengths over the longest link): 0 for exact positions, more for a
    least-squares fit. ``also_rad`` are further angles that a swinging driver reaches.
    ``turns_back`` is the link or slider that has its limits in the two positions, and so goes to
    and fro between them.
    """

    draft: Draft
    driver: str
    positions: tuple[PrecisionPosition, ...]
    chosen: Mapping[str, str] = field(default_factory=dict)
    steps: tuple[DrawingStep, ...] = ()
    doubt: str = ""
    speed_rad_s: float = SPEED_RAD_S
    allowed: float = 0.0
    also_rad: tuple[float, ...] = ()
    turns_back: str = ""


def to_and_fro(
    draft: Draft,
    angles: Iterable[float],
    asked: Iterable[tuple[Asked, ...]],
    chosen: Mapping[str, str],
    steps: Iterable[DrawingStep],
    turns_back: str,
) -> Proposal:
    """Return the mechanism whose crank has two angles [rad] at the limits of a link or slider."""
    positions = tuple(map(PrecisionPosition, angles, asked))
    return Proposal(draft, "crank", positions, chosen, tuple(steps), turns_back=turns_back)


INPUT, COUPLER, OUTPUT = "input", "coupler", "output"
PIVOTS, PINS = ("O2", "O4"), "ABEFGHJKLM"
"""Fixed pivots as in the lecture, and free letters for pins."""
COINCIDING = 1e-9
"""Distance of a pin from a point of the body that is the same, over their size."""


@dataclass(frozen=True)
class CarriedBody:
    """Body in its positions, with its named points [m, own frame] of required places; ``name`` and
    ``source`` go on to its scenes."""

    name: str
    source: str
    poses: tuple[PlanePose, ...]
    points: Mapping[str, complex]

    @property
    def size(self) -> float:
        """Longest way of the body, and its reach [m]."""
        ways = (abs(b.point - a.point) for a, b in itertools.combinations(self.poses, 2))
        return max(ways) + max(map(abs, self.points.values()))

    def four_bar(
        self,
        dyads: tuple[PoseDyad, PoseDyad],
        driven: int = 0,
        *,
        chosen: Mapping[str, str] | None = None,
        steps: Sequence[DrawingStep] = (),
    ) -> Proposal:
        """Return the four-bar whose coupler the body is, held by two dyads, the first on O2;
        ``driven`` is the number of the driven one (0 or 1)."""
        pins = [self.letter(dyad.moving, which) for which, dyad in enumerate(dyads)]
        cranks = [
            bar(pivot, pin, dyad.radius(self.poses))
            for pivot, pin, dyad in zip(PIVOTS, pins, dyads, strict=True)
        ]
        own = {pin: dyad.moving for pin, dyad in zip(pins, dyads, strict=True)}
        draft = Draft(
            self.name,
            self.source,
            {pivot: dyad.fixed for pivot, dyad in zip(PIVOTS, dyads, strict=True)},
            {INPUT: cranks[driven], COUPLER: plate(own | dict(self.points)),
             OUTPUT: cranks[1 - driven]},
            {},
        )  # fmt: skip
        positions = tuple(map(self.asked, dyads[driven].turns(self.poses), self.poses))
        told = {**(chosen or {}), "driven at": PIVOTS[driven]}
        return Proposal(draft, INPUT, positions, told, tuple(steps))

    def asked(self, driver_rad: float, pose: PlanePose, link: str = COUPLER) -> PrecisionPosition:
        """Return the requirement of a pose while the driver has an angle [rad]."""
        places = (AskedPlace(point, pose.at(place)) for point, place in self.points.items())
        return PrecisionPosition(driver_rad, (AskedAngle(link, pose.angle), *places))

    def letter(self, moving: complex, which: int) -> str:
        """Return the name of a pin: that of the coincident point of the body, or a free letter."""
        near = COINCIDING * (abs(moving) + self.size)
        for name, place in self.points.items():
            if abs(place - moving) <= near:
                return name
        return letters_beside(self.points, which + 1)[which]


def letters_beside(names: Iterable[str], count: int) -> list[str]:
    """Return so many letters for pins that are not among the names."""
    taken = set(names)
    return [letter for letter in PINS if letter not in taken][:count]
