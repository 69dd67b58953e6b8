"""Vector polygons of a mechanism: velocities and accelerations, group by group from the pole.

Every vector is found as on paper: known vectors are laid end to end from the pole, and two
directions cross in the image of the group's inner joint
(`analytic.lectures.drawings.dyad_polygon`). Only the positions of the reference go in, not its
rates, so that the two are two computations.

Source: lecture "Phan tich dong hoc", part III: v_B = v_A + v_BA; a_B = a_A + a^n + a^t;
v_A2 = v_A1 + v_A2A1; a_A2 = a_A1 + a^k + a^r, a^k = 2 omega v_A2A1 turned in the sense of omega.

Each crossing is an equation of two ways to a point, over one link and over another; on each, one
vector has a known direction u and an unknown length::

    base1 + known1 + a u1  =  base2 + known2 + b u2
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from analytic.kinematics import solve_driven
from analytic.structure.mobility import Structure, analyse
from models.array import Array
from models.motion import Motion
from models.scene import GROUND, Scene
from models.scene.joints import sliding_angle, sliding_body


@dataclass(frozen=True)
class DriverState:
    """Angle [rad], angular velocity [rad/s] and acceleration [rad/s^2] of the driver."""

    theta: float
    omega: float
    alpha: float = 0.0


@dataclass(frozen=True)
class PlacedMechanism:
    """Places of all points [m], (2,) each, and angles of all bodies [rad], with blocks and the
    ground; no rates, which the polygons find."""

    scene: Scene
    structure: Structure
    driver: DriverState
    points: Mapping[str, Array]
    angles: Mapping[str, float]

    @staticmethod
    def of(scene: Scene, driver: DriverState) -> PlacedMechanism:
        """Place the scene with its driver in a state. Raises as `analytic.kinematics.solve`."""
        one = np.ones(1)
        motion = solve_driven(
            scene, driver.theta * one, driver.omega * one, driver.alpha * one, bound=False
        )
        return PlacedMechanism.standing(scene, motion, driver)

    @staticmethod
    def standing(
        scene: Scene, motion: Motion, driver: DriverState | None = None, sample: int = 0
    ) -> PlacedMechanism:
        """Place the scene in a sample of a motion, driven or free, on any branch; its driver moves
        as there by default."""
        angles = {GROUND: 0.0} | {n: float(m.theta[sample]) for n, m in motion.links.items()}
        for slider in scene.sliders.values():
            if slider.link is None:
                angles[sliding_body(slider)] = angles[slider.on] + sliding_angle(slider)
        points = {name: np.array(point.position[sample]) for name, point in motion.points.items()}
        if driver is None:
            moves = motion.links[scene.driver.link]
            theta, omega, alpha = (
                float(series[sample]) for series in (moves.theta, moves.omega, moves.alpha)
            )
            driver = DriverState(theta, omega, alpha)
        return PlacedMechanism(scene, analyse(scene), driver, points, angles)

    def along(self, slider: str) -> Array:
        """Return the unit vector along the line of a slider."""
        guide = self.scene.sliders[slider]
        angle = self.angles[guide.on] + guide.direction_rad
        return np.array([np.cos(angle), np.sin(angle)])


def quarter_turn(vector: Array) -> Array:
    """Return the vector turned by a quarter turn counter-clockwise."""
    return np.array([-vector[1], vector[0]])


@dataclass(frozen=True)
class BodyRates:
    """Body by its point at ``place`` [m], with that point's ``velocity`` [m/s] and ``acceleration``
    [m/s^2], (2,) each, and by ``omega`` [rad/s] and ``alpha`` [rad/s^2]."""

    place: Array
    velocity: Array
    acceleration: Array
    omega: float
    alpha: float

    def velocity_at(self, place: Array) -> Array:
        """Return the velocity of the body's point at a place [m/s], (2,)."""
        return np.asarray(self.velocity + self.omega * quarter_turn(place - self.place))

    def acceleration_at(self, place: Array) -> Array:
        """Return the acceleration of the body's point at a place [m/s^2], (2,)."""
        arm = place - self.place
        turning = self.alpha * quarter_turn(arm) - self.omega**2 * arm
        return np.asarray(self.acceleration + turning)


STILL = BodyRates(np.zeros(2), np.zeros(2), np.zeros(2), 0.0, 0.0)
"""Rates of the ground."""


Kind = Literal["whole", "rotation", "normal", "tangential", "coriolis", "sliding"]
"""Kinds: ``whole``, of a point against the ground; ``rotation``, of a point about another of its
link; ``sliding``, of a point against the one of another body that lies under it."""
SUPERSCRIPTS: dict[Kind, str] = {
    "whole": "", "rotation": "", "normal": "n", "tangential": "t", "coriolis": "k", "sliding": "r",
}  # fmt: skip
PARALLEL = 1e-9
"""Sine of the angle between two directions below which they do not cross anywhere near."""


FLAT = 1e-2
"""Sine of the angle below which directions cross so flatly that a hand can not draw it."""


class ParallelError(Exception):
    """The two directions of a vector equation are parallel: it has no solution, or many."""


@dataclass(frozen=True)
class Term:
    """Vector of an equation: its ``subscript`` (CB for C about B), its kind, and its value (2,);
    ``direction`` names the line that it is parallel or perpendicular to."""

    subscript: str
    kind: Kind
    value: Array
    direction: str = ""


@dataclass(frozen=True)
class EquationSide:
    """Side of the equation: from ``start`` (2,) in the polygon over ``known`` vectors, and on along
    the direction of ``unknown``, whose value is a unit vector."""

    start: Array
    known: Sequence[Term]
    unknown: Term

    @property
    def before(self) -> Array:
        """Start of the unknown vector (2,)."""
        return np.asarray(self.start + sum((term.value for term in self.known), np.zeros(2)))

    def with_length(self, length: float) -> tuple[Term, ...]:
        """Return all vectors of the way, the unknown one with its length, which may be below 0."""
        return (*self.known, replace(self.unknown, value=length * self.unknown.value))


def sine_between(one: EquationSide, other: EquationSide) -> float:
    """Return the sine of the angle from the direction of one way to that of the other."""
    u, v = one.unknown.value, other.unknown.value
    return float(u[0] * v[1] - u[1] * v[0])


def crossing(one: EquationSide, other: EquationSide) -> tuple[float, float]:
    """Return the lengths of the unknown vectors of both ways. Raises ParallelError."""
    u, v = one.unknown.value, other.unknown.value
    gap = other.before - one.before
    sine = sine_between(one, other)
    if abs(sine) < PARALLEL:
        raise ParallelError
    return (
        float(gap[0] * v[1] - gap[1] * v[0]) / sine,
        float(gap[0] * u[1] - gap[1] * u[0]) / sine,
    )


Quantity = Literal["velocity", "acceleration"]
SYMBOLS: Mapping[Quantity, str] = {"velocity": "v", "acceleration": "a"}
UNITS: Mapping[Quantity, str] = {"velocity": "m/s", "acceleration": "m/s^2"}


@dataclass(frozen=True)
class Vector:
    """Drawn vector from ``start`` to ``end`` (2,) [m/s or m/s^2], the pole at the origin. ``name``
    is as in books (v_CB, a^n_CB); ``direction`` names the line that it is parallel or perpendicular
    to if a crossing gave its length, and is empty if it was known before."""

    name: str
    kind: Kind
    start: Array
    end: Array
    direction: str = ""

    @property
    def value(self) -> Array:
        return np.asarray(self.end - self.start)

    @property
    def size(self) -> float:
        """Its length [m/s or m/s^2]."""
        return float(np.hypot(*self.value))


@dataclass(frozen=True)
class PolygonStep:
    """Step of drawing: the driver, or a group; ``nodes`` are its images."""

    title: str
    vectors: tuple[Vector, ...]
    nodes: Mapping[str, Array]


@dataclass(frozen=True)
class Polygon:
    """Polygon, steps in the order of drawing. ``images`` holds for every moving link the ends of
    the vectors of its points, by name (2,): similar to the link, and turned. ``undetermined`` names
    groups that could not be drawn, with reasons."""

    quantity: Quantity
    steps: tuple[PolygonStep, ...]
    images: Mapping[str, Mapping[str, Array]]
    undetermined: tuple[str, ...] = ()

    @property
    def vectors(self) -> tuple[Vector, ...]:
        return tuple(vector for step in self.steps for vector in step.vectors)

    @property
    def nodes(self) -> dict[str, Array]:
        """Every drawn image, by the name of its point; the pole is at the origin."""
        return {name: at for step in self.steps for name, at in step.nodes.items()}

    @property
    def ends(self) -> dict[str, Array]:
        """Ends of the vectors of all points of moving links, and the other images, by name."""
        of_links = {name: at for image in self.images.values() for name, at in image.items()}
        return of_links | self.nodes

    @property
    def largest(self) -> float:
        """Greatest distance of two of its points [m/s or m/s^2]."""
        ends = [np.zeros(2), *self.nodes.values()]
        ends += [end for vector in self.vectors for end in (vector.start, vector.end)]
        places = np.array(ends)
        return float(np.linalg.norm(places[:, None] - places[None], axis=-1).max())


def name_of(quantity: Quantity, kind: Kind, subscript: str) -> str:
    """Return a vector's name: v_CB, a^n_CB."""
    raised = SUPERSCRIPTS[kind] if quantity == "acceleration" else ""
    return f"{SYMBOLS[quantity]}{'^' * bool(raised)}{raised}_{subscript}"


def images_of(
    placement: PlacedMechanism, rates: Mapping[str, BodyRates], quantity: Quantity
) -> dict[str, dict[str, Array]]:
    """Return the ends of the vectors of all points of all placed moving links."""
    return {
        name: {
            point: end_of(rates[name], placement.points[point], quantity) for point in link.points
        }
        for name, link in placement.scene.links.items()
        if name in rates and name != GROUND
    }


def end_of(body: BodyRates, place: Array, quantity: Quantity) -> Array:
    """Return the vector of a body's point at a place, from the pole (2,)."""
    return body.velocity_at(place) if quantity == "velocity" else body.acceleration_at(place)
