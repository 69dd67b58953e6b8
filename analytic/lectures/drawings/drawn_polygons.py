"""Both polygons of a mechanism at one instant, drawn group by group.

The image of a link's points is the link itself times one complex number: i omega of velocities,
i alpha - omega^2 of accelerations. Where that is 0, the image is one point. Source: lecture "Phan
tich dong hoc", part III.
"""

import cmath
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np

from analytic.lectures.drawings import polygon
from analytic.lectures.drawings.dyad_polygon import (
    DyadPolygon,
    Known,
    NodeMotion,
    Origin,
    dyad_polygon,
)
from analytic.lectures.drawings.polygon import (
    STILL,
    BodyRates,
    DriverState,
    PlacedMechanism,
    quarter_turn,
)
from analytic.structure.groups import Bridge, Group
from analytic.structure.mobility import refuse_other_than_cranked
from models.array import Array
from models.scene import GROUND, Scene

QUANTITIES: tuple[polygon.Quantity, polygon.Quantity] = ("velocity", "acceleration")


@dataclass(frozen=True)
class DrawnPolygons:
    """Polygons of a mechanism in ``placement``, and the resulting rates of its bodies.
    ``undetermined`` names the groups that could not be drawn, with reasons; ``flat`` those whose
    directions hardly cross, with angles."""

    placement: PlacedMechanism
    velocity: polygon.Polygon
    acceleration: polygon.Polygon
    rates: Mapping[str, BodyRates]
    flat: tuple[str, ...] = ()

    @property
    def undetermined(self) -> tuple[str, ...]:
        return self.velocity.undetermined


def draw_polygons(scene: Scene, driver: DriverState) -> DrawnPolygons:
    """Draw the velocity and the acceleration polygon of a scene with its driver in a state.

    Where two directions of a group are parallel (a limit position, a change point) it and later
    groups on it are left out and named. Raises as `analytic.kinematics.solve`, and CrankcheckError
    where the driver is no crank or a group is of class III.
    """
    return polygons_of(PlacedMechanism.of(scene, driver))


def polygons_of(placement: PlacedMechanism) -> DrawnPolygons:
    """Draw as `draw_polygons`, from a placed mechanism."""
    refuse_other_than_cranked(placement.scene, "a vector polygon", placement.structure)
    table = _Table(placement)
    table.draw_driver()
    undetermined = [
        said
        for part in placement.structure.order
        if isinstance(part, Group | Bridge) and (said := table.draw(part))
    ]
    velocity, acceleration = (
        polygon.Polygon(
            quantity,
            tuple(table.steps[quantity]),
            polygon.images_of(placement, table.rates, quantity),
            tuple(undetermined),
        )
        for quantity in QUANTITIES
    )
    return DrawnPolygons(placement, velocity, acceleration, table.rates, tuple(table.flat))


@dataclass
class _Table:
    """Drawing table: the steps of both polygons, and the known bodies."""

    placement: PlacedMechanism
    rates: dict[str, BodyRates] = field(default_factory=lambda: {GROUND: STILL})
    steps: dict[polygon.Quantity, list[polygon.PolygonStep]] = field(
        default_factory=lambda: {q: [] for q in QUANTITIES}
    )
    flat: list[str] = field(default_factory=list)

    def draw_driver(self) -> None:
        """Draw the crank's points from the pole: a^n towards the pivot, a^t across."""
        scene, state = self.placement.scene, self.placement.driver
        link, pivot = scene.driver.link, scene.driver_pivot
        place = self.placement.points[pivot]
        still = np.zeros(2)
        self.rates[link] = BodyRates(place, still, still, state.omega, state.alpha)
        velocity, acceleration, nodes = [], [], {}
        for point in scene.links[link].points:
            if point in scene.ground:
                continue
            arm = self.placement.points[point] - place
            subscript = point + pivot
            whole = polygon.Term(subscript, "rotation", state.omega * quarter_turn(arm))
            parts = [polygon.Term(subscript, "normal", -(state.omega**2) * arm)]
            if state.alpha:
                parts.append(polygon.Term(subscript, "tangential", state.alpha * quarter_turn(arm)))
            velocity += _laid("velocity", still, [whole])
            acceleration += _laid("acceleration", still, parts)
            nodes[point] = place + arm
        for quantity, vectors in zip(QUANTITIES, (velocity, acceleration), strict=True):
            ends = {
                name: polygon.end_of(self.rates[link], at, quantity) for name, at in nodes.items()
            }
            self.steps[quantity].append(polygon.PolygonStep(f"driver {link}", tuple(vectors), ends))

    def draw(self, part: Group | Bridge) -> str:
        """Draw a group or a redundant link; return the reason where it can not be drawn."""
        if missing := self._missing(part):
            return f"{_title(part)}: depends on {missing}, which is not determined"
        if isinstance(part, Bridge):
            self._bridge(part)
            return ""
        dyad = dyad_polygon(self.placement, self.rates, part)
        try:
            self._draw_dyad(dyad)
        except polygon.ParallelError:
            told = " and ".join(arm.velocity_way().unknown.direction for arm in dyad.arms)
            return f"{_title(part)}: both directions ({told}) are parallel"
        return ""

    def _draw_dyad(self, dyad: DyadPolygon) -> None:
        ways = [arm.velocity_way() for arm in dyad.arms]
        velocity, drawn_v = self._crossed("velocity", ways, dyad)
        ways = [arm.acceleration_way(velocity) for arm in dyad.arms]
        acceleration, drawn_a = self._crossed("acceleration", ways, dyad)
        title = _title(dyad.group)
        if abs(sine := polygon.sine_between(*ways)) < polygon.FLAT:
            told = f"{math.degrees(math.asin(abs(sine))):.2g} deg"
            self.flat.append(f"{title}: its directions cross at {told}, near a limit position")
        both = ((drawn_v, velocity), (drawn_a, acceleration))
        for quantity, ((vectors, begun), node) in zip(QUANTITIES, both, strict=True):
            step = polygon.PolygonStep(title, vectors, begun | {dyad.node: node})
            self.steps[quantity].append(step)
        self.rates |= dyad.rates(self.placement, NodeMotion(velocity, acceleration))

    def _crossed(
        self, quantity: polygon.Quantity, ways: list[polygon.EquationSide], dyad: DyadPolygon
    ) -> tuple[Array, tuple[tuple[polygon.Vector, ...], dict[str, Array]]]:
        """Return the node, and the vectors to it with their new origins."""
        lengths = polygon.crossing(*ways)
        vectors: list[polygon.Vector] = []
        begun: dict[str, Array] = {}
        for way, length, arm in zip(ways, lengths, dyad.arms, strict=True):
            if self._is_new(quantity, arm.origin) and arm.origin.name not in begun:
                begun[arm.origin.name] = way.start
                whole = polygon.Term(arm.origin.name, "whole", way.start)
                vectors += _laid(quantity, np.zeros(2), [whole])
            vectors += _laid(quantity, way.start, way.with_length(length))
        one = ways[0]
        return one.before + lengths[0] * one.unknown.value, (tuple(vectors), begun)

    def _is_new(self, quantity: polygon.Quantity, origin: Origin) -> bool:
        """True if a point has no image yet; the ground's is the pole."""
        drawn = any(origin.name in step.nodes for step in self.steps[quantity])
        return not drawn and origin.body is not STILL

    def _missing(self, part: Group | Bridge) -> str:
        """Return an unknown body that a part needs."""
        structure = self.placement.structure
        if isinstance(part, Bridge):
            known = Known(self.placement, self.rates)
            without = [pin for pin in part.pins if not known.has(pin)]
            return "" if len(part.pins) - len(without) > 1 else f"pin {without[0]}"
        for kind, joint in zip(part.kind[::2], (part.outer1, part.outer2), strict=True):
            bodies = structure.pins[joint] if kind == "R" else structure.prismatics[joint]
            if not any(body in self.rates for body in bodies):
                return next(body for body in bodies if body not in part.bodies)
        return ""

    def _bridge(self, part: Bridge) -> None:
        """Draw a redundant link, by two of its pins."""
        known = Known(self.placement, self.rates)
        one, other = [known.pin(pin) for pin in part.pins if known.has(pin)][:2]
        across = quarter_turn(other.place - one.place)
        size = float(across @ across)
        self.rates[part.link] = BodyRates(
            one.place,
            one.velocity,
            one.acceleration,
            float(across @ (other.velocity - one.velocity)) / size,
            float(across @ (other.acceleration - one.acceleration)) / size,
        )


def _laid(
    quantity: polygon.Quantity, start: Array, terms: Iterable[polygon.Term]
) -> list[polygon.Vector]:
    """Return vectors end to end."""
    vectors = []
    for term in terms:
        end = np.asarray(start + term.value)
        name = polygon.name_of(quantity, term.kind, term.subscript)
        vectors.append(polygon.Vector(name, term.kind, start, end, term.direction))
        start = end
    return vectors


def _title(part: Group | Bridge) -> str:
    if isinstance(part, Bridge):
        return f"redundant link {part.link}"
    return f"{part.kind} ({part.first}, {part.second})"


POINT = 1e-12
"""Size of an image over the largest vector, below which it is one point: the rest is the rounding
of the crossing."""


@dataclass(frozen=True)
class Similarity:
    """Map from a link to its image: ``scale`` [1/s or 1/s^2], turned by ``turn_rad``
    counter-clockwise; for a link that does not turn the scale is 0, and the image a point."""

    scale: float
    turn_rad: float

    @property
    def is_point(self) -> bool:
        return self.scale == 0.0


def similarity(drawn: DrawnPolygons, link: str, quantity: polygon.Quantity) -> Similarity:
    """Return the map of a drawn link's velocities or accelerations."""
    body = drawn.rates[link]  # its places being x + iy
    factor = 1j * body.omega if quantity == "velocity" else 1j * body.alpha - body.omega**2
    if _is_rounding(drawn, link, quantity, abs(factor)):
        return Similarity(0.0, 0.0)
    return Similarity(abs(factor), cmath.phase(factor))


def link_rates(drawn: DrawnPolygons, link: str) -> tuple[float, float]:
    """Return omega [rad/s] and alpha [rad/s^2] of a drawn link, 0 where they are rounding."""
    body = drawn.rates[link]
    omega, alpha = (
        0.0 if _is_rounding(drawn, link, quantity, abs(rate)) else rate
        for rate, quantity in zip((body.omega, body.alpha), QUANTITIES, strict=True)
    )
    return omega, alpha


def _is_rounding(drawn: DrawnPolygons, link: str, quantity: polygon.Quantity, scale: float) -> bool:
    """True if an image of the link at a scale [1/s or 1/s^2] is as small as the rounding."""
    whole = drawn.velocity if quantity == "velocity" else drawn.acceleration
    places = np.array([*drawn.placement.scene.links[link].points.values()])
    reach = float(np.hypot(*np.ptp(places, axis=0)))
    return scale * reach <= POINT * whole.largest
