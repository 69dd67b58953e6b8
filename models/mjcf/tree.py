"""A mechanism as a tree of bodies and the pins that close its loops, for engines that need one.

Kruskal's rule chooses the joints of the tree with this priority: the driver's pin, then prismatic
pairs and slots (an engine can close a loop at a pin, not at a slide), then ground pins, then the
other pins in the order of the file; pins named in ``close`` come last. In a four-bar A B C D this
closes the loop at C. Where the masses differ by more than `UNEQUAL` the pins of the lightest bodies
come first, so that loops close at heavy ones.
"""

import itertools
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

from models.errors import EngineError
from models.files.inputs import names_in
from models.motion import State
from models.scene import GROUND, Point, Scene, Slider, joints

UNEQUAL = 25.0
"""Least ratio of the heaviest body to the lightest at which loops close between heavy bodies. Below
it a stiff closure of MuJoCo yields elsewhere by (1 - 0.9999) (3 dt)^2 25 = 0.02 dt^2 times an
acceleration: a fiftieth of a step's own error."""


@dataclass(frozen=True)
class Freedom:
    """One joint coordinate of a body in the tree.

    ``anchor`` [m] (of a hinge) and ``axis_rad`` (of a slide, its direction) are in the body's own
    frame; ``ref`` is the coordinate at the assembled state, read as the angle of the body against
    its parent [rad] or as the displacement of the slider [m]; ``rate`` is its rate there.
    """

    name: str
    kind: Literal["hinge", "slide"]
    anchor: Point
    axis_rad: float
    ref: float
    rate: float

    @property
    def axis(self) -> Point:
        """Direction of a slide in the frame of the body, exact along the axes."""
        return joints.turned((1.0, 0.0), self.axis_rad)


@dataclass(frozen=True)
class Limb:
    """A body of the tree: its place in its parent when assembled, and its joints in order.

    ``point`` is the pin to its parent or the sliding point, ``slider`` its slider; a limb of a
    user's own model has neither.
    """

    body: str
    parent: str
    offset: Point
    angle_rad: float
    freedoms: tuple[Freedom, ...]
    point: str = ""
    slider: Slider | None = None


@dataclass(frozen=True)
class LoopPin:
    """A pin that closes a loop: both bodies carry the point."""

    point: str
    bodies: tuple[str, str]


@dataclass(frozen=True)
class Tree:
    """The limbs depth first, as MuJoCo numbers them, and the pins that close the loops; the sliders
    that close further loops, where they may."""

    limbs: tuple[Limb, ...]
    closures: tuple[LoopPin, ...]
    slides: tuple[joints.Prism | joints.Slot, ...] = ()


@dataclass(frozen=True)
class _Edge:
    """A joint that may stay in the tree."""

    a: str
    b: str
    point: str
    slider: Slider | None = None
    turns: bool = True


class _Groups:
    """Groups of connected bodies (union-find)."""

    def __init__(self) -> None:
        self._parent: dict[object, object] = {}

    def root(self, item: object) -> object:
        """Return the representative of the group of an item."""
        while (parent := self._parent.get(item, item)) != item:
            item = parent
        return item

    def join(self, a: object, b: object) -> bool:
        """Tie two groups; False if they are one already."""
        a, b = self.root(a), self.root(b)
        if a == b:
            return False
        self._parent[b] = a
        return True


def plan(
    scene: Scene,
    state: State,
    close: str | Sequence[str] = (),
    *,
    delay_s: float = 0.0,
    at_slides: bool = False,
) -> Tree:
    """Plan the tree of a scene at an assembled state, with the loops closed at pins, and, with
    ``at_slides``, a loop of sliders at one of them.

    The rates of the coordinates belong to ``delay_s`` later (see `models.scene.joints.frames`).

    Raises EngineError for a pin in ``close`` that does not exist or cannot close a loop; a slider
    that would have to close a loop and so needs a mass; an unconnected body.
    """
    close = names_in(close, "close")
    _check_close(scene, close)
    together, at_point = _Groups(), _Groups()
    edges: list[_Edge] = []
    outside: list[Slider] = []
    for choices in _choices(scene, close):
        kept = next((e for e in choices if together.join(e.a, e.b)), None)
        if kept is not None:
            edges.append(kept)
            if kept.slider is None:
                at_point.join((kept.point, kept.a), (kept.point, kept.b))
        elif choices[0].slider is not None:
            if not at_slides:
                raise EngineError(_needs_mass(choices[0].slider))
            outside.append(choices[0].slider)
    closures = _closures(scene, at_point)
    for point in close:
        if point not in {c.point for c in closures}:
            raise EngineError(f"close = {point}: no loop of {scene.name} closes there")
    slides = tuple(slide for slide in joints.joints(scene).slides if slide.slider in outside)
    return Tree(_limbs(scene, joints.frames(scene, state, delay_s), edges), closures, slides)


def _choices(scene: Scene, close: Sequence[str]) -> Iterator[list[_Edge]]:
    """Yield the joints by priority; each entry lists equally good ways to hold one joint."""
    driver, ties = scene.driver, joints.joints(scene)
    if driver.slider is None:
        yield [_Edge(driver.base, driver.link, scene.driver_pivot)]
    for slide in sorted(ties.slides, key=lambda slide: slide.slider.name != driver.slider):
        yield _slides(slide)
    pairs = [
        (pin.point, _Edge(a, b, pin.point))
        for pin in ties.pins
        for i, a in enumerate(pin.bodies)
        for b in pin.bodies[i + 1 :]
    ]
    lightness = _lightness(scene)  # where it says nothing, ground pins come first
    for _, edge in sorted(pairs, key=lambda pair: (pair[0] in close, -lightness(pair[1]))):
        yield [edge]


def _lightness(scene: Scene) -> Callable[[_Edge], float]:
    """Return the lightness of a pin's two bodies [1/kg], equal for all pins of masses alike.

    A soft constraint yields by its force times the inverse masses of its bodies, of which the
    lighter has more. Closed between a light body and a heavy one it yields by the ratio of their
    masses; at a pin of heavy bodies as much as if all were alike. Nothing moves the ground and the
    driver.
    """
    if joints.mass_ratio(scene) <= UNEQUAL:
        return lambda edge: 0.0
    firm = (GROUND, scene.driver.link)

    def lightness(edge: _Edge) -> float:
        masses = (joints.mass_of(scene, body)[0] for body in (edge.a, edge.b) if body not in firm)
        return sum(1.0 / mass if mass else math.inf for mass in masses)

    return lightness


def _slides(slide: joints.Prism | joints.Slot) -> list[_Edge]:
    slider = slide.slider
    if isinstance(slide, joints.Prism):
        return [_Edge(slider.on, slide.body, slider.point, slider, turns=False)]
    if not slide.bodies:
        raise EngineError(_needs_mass(slider))
    return [_Edge(slider.on, body, slider.point, slider) for body in slide.bodies]


def _needs_mass(slider: Slider) -> str:
    return (
        f"slider {slider.name}: a massless block cannot be held here, as loops close only at "
        f"pins; give sliders.{slider.name} a mass_kg above 0"
    )


def _check_close(scene: Scene, close: Sequence[str]) -> None:
    pins = [pin.point for pin in joints.joints(scene).pins]
    for point in close:
        if point not in pins or point == scene.driver_pivot:
            able = ", ".join(p for p in pins if p != scene.driver_pivot)
            raise EngineError(f"close = {point}: not a pin that can close a loop; one of {able}")


def _closures(scene: Scene, at_point: _Groups) -> tuple[LoopPin, ...]:
    """Return the pins outside the tree: one closure between each two groups at a point."""
    closures: list[LoopPin] = []
    for pin in joints.joints(scene).pins:
        first = pin.bodies[0]
        closures += [
            LoopPin(pin.point, (first, body))
            for body in pin.bodies[1:]
            if at_point.join((pin.point, first), (pin.point, body))
        ]
    return tuple(closures)


def _limbs(
    scene: Scene, where: dict[str, joints.Frame], edges: Sequence[_Edge]
) -> tuple[Limb, ...]:
    placed = [GROUND]

    def grown(parent: str) -> list[Limb]:
        limbs: list[Limb] = []
        for edge in edges:
            child = {edge.a: edge.b, edge.b: edge.a}.get(parent)
            if child is not None and child not in placed:
                placed.append(child)
                limbs += [_limb(scene, where, edge, parent, child), *grown(child)]
        return limbs

    limbs = tuple(grown(GROUND))
    loose = [body for body in joints.bodies(scene) if body not in placed]
    if loose:
        raise EngineError(
            f"{scene.name}: {', '.join(loose)} is pinned to nothing; pin it to a link"
        )
    return limbs


def _limb(
    scene: Scene, where: dict[str, joints.Frame], edge: _Edge, parent: str, child: str
) -> Limb:
    """Place one body against its parent, its joint written as one or two coordinates."""
    base, body = where[parent], where[child]
    angle = body.theta - base.theta
    rate = body.omega - base.omega

    def hinge(anchor: Point) -> Freedom:
        return Freedom(f"{child}.{edge.point}", "hinge", anchor, 0.0, angle, rate)

    if edge.slider is None:
        anchor = joints.local_point(scene, child, edge.point)
        arm = joints.turned(anchor, angle)
        pivot = joints.local_point(scene, parent, edge.point)
        offset = (pivot[0] - arm[0], pivot[1] - arm[1])
        return Limb(child, parent, offset, angle, (hinge(anchor),), edge.point)
    slider, guide = edge.slider, where[edge.slider.on]
    rider = edge.b
    place = where[rider].at(joints.local_point(scene, rider, edge.point))
    ref, speed = joints.along(slider, guide, place, where[rider].velocity_at(place))
    rides = child == rider  # else the child is the guide, and moves backwards under the rider
    axis = slider.direction_rad + (-angle if rides else math.pi)
    slide = Freedom(f"{child}.{slider.name}.slide", "slide", (0.0, 0.0), axis, ref, speed)
    offset = base.into(body.origin)
    if not edge.turns:
        return Limb(child, parent, offset, angle, (slide,), edge.point, slider)
    turns = hinge(body.into(place))
    both = (slide, turns) if rides else (turns, slide)
    return Limb(child, parent, offset, angle, both, edge.point, slider)


def closings(scene: Scene, state: State) -> Iterator[tuple[str, ...]]:
    """Yield values of ``close`` in `plan` that close other pins than the default. The fewest pins
    first; each choice of closures once. Raises EngineError as `plan` does."""
    default = plan(scene, state).closures
    seen = {frozenset(default)}
    pins = [pin.point for pin in joints.joints(scene).pins if pin.point != scene.driver_pivot]
    for count in range(1, len(default) + 1):
        for close in itertools.combinations(pins, count):
            try:
                closures = frozenset(plan(scene, state, close).closures)
            except EngineError:
                continue  # no loop closes at all of them
            if closures not in seen:
                seen.add(closures)
                yield close


def driven_freedom(scene: Scene, limbs: Sequence[Limb]) -> tuple[str, float]:
    """Return the name of the driven freedom, and 1.0 if it reads as the driver's own coordinate, or
    -1.0 if the driven link carries its base. Raises EngineError if the driven joint is not in
    it."""
    driver = scene.driver
    if driver.is_crank:
        return f"{driver.link}.{scene.driver_pivot}", 1.0
    for limb in limbs:
        if limb.slider is not None:
            if limb.slider.name == driver.slider:
                return next(f.name for f in limb.freedoms if f.kind == "slide"), 1.0
        elif limb.point == driver.pin and {limb.body, limb.parent} == {driver.base, driver.link}:
            return limb.freedoms[0].name, 1.0 if limb.body == driver.link else -1.0
    raise EngineError(f"{scene.name}: the tree closes a loop at {driver.joint}, which is driven")
