r"""Description of a mechanism: links, pins, sliders, one driver, the assembly branch, loads.

Pins are shared point names: two links, or a link and the ground, that list the same point are
pinned there. A slider lets a point, or a whole link, run along a line of another body::

    block (no `link`)                     sliding link (`link = "yoke"`)

      rod                                        |  yoke
        \                                        |
    -----[C]------  line of `on`          =====[  Y  ]=====  line of `on`
     the block is pinned to the rod        the yoke does not turn against the line

All lengths in m, angles in rad, masses in kg. Counter-clockwise is positive.
"""

from __future__ import annotations

import pickle
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NoReturn, TypeVar

from models.scene.elastic import Beam, ElasticLink, Shape
from models.scene.laws import Law
from models.scene.loads import CoulombFriction, Friction, Load, Spring
from models.scene.pairs import CamPair, Gear

K = TypeVar("K")
V = TypeVar("V")


class FixedMapping(dict[K, V]):
    """A dict that cannot be changed; ``{**old, ...}`` makes another."""

    def _refuse(self, *_: object, **__: object) -> NoReturn:
        raise TypeError("a scene is not changed; make another one with dataclasses.replace")

    __setitem__ = __delitem__ = __ior__ = _refuse
    clear = pop = popitem = setdefault = update = _refuse

    def __reduce__(self) -> tuple[type[FixedMapping[K, V]], tuple[dict[K, V]]]:
        return FixedMapping, (dict(self),)


def _fix(made: object, *names: str) -> None:
    """Make mappings of a frozen dataclass ones that cannot be changed, copies. Raises TypeError."""
    for name in names:
        object.__setattr__(made, name, FixedMapping(getattr(made, name)))


@dataclass(frozen=True)
class Start:
    """Angles [rad] and angular velocities [rad/s] of links, displacements [m] and speeds [m/s] of
    sliders at time 0, by name.

    In a mechanism of mobility 1 they repeat the driver's own angle and speed, and are checked
    against them; with more freedoms they are the rest of the start.
    """

    angles_rad: Mapping[str, float] = field(default_factory=dict)
    rates_rad_s: Mapping[str, float] = field(default_factory=dict)
    displacements_m: Mapping[str, float] = field(default_factory=dict)
    speeds_m_s: Mapping[str, float] = field(default_factory=dict)
    shape: Shape | None = None

    def __post_init__(self) -> None:
        _fix(self, "angles_rad", "rates_rad_s", "displacements_m", "speeds_m_s")

    def __bool__(self) -> bool:
        return any(vars(self).values())


Point = tuple[float, float]
GROUND = "ground"
KEPT = 64
"""Scenes whose derived results are kept: more than are shipped."""


@dataclass(frozen=True)
class Link:
    """A rigid link. ``points`` and ``centre_m`` (the centre of mass) are in the link's own frame;
    ``inertia_kg_m2`` is about the centre of mass."""

    name: str
    points: Mapping[str, Point]
    mass_kg: float
    centre_m: Point
    inertia_kg_m2: float

    def __post_init__(self) -> None:
        _fix(self, "points")


@dataclass(frozen=True)
class Slider:
    """A prismatic pair: ``point`` runs on the line of body ``on``.

    The line passes through ``through_m`` in direction ``direction_rad``, both in the frame of
    ``on``; the displacement of the slider is measured from ``through_m`` along the direction.
    Without ``link`` the slider is a block pinned at ``point``, with its own mass (0: no body is
    needed) and with the orientation of the line. With ``link`` that link itself slides: its frame
    keeps the angle ``angle_rad`` to the line, and ``point`` is one of its points.
    """

    name: str
    point: str
    on: str
    through_m: Point
    direction_rad: float
    link: str | None = None
    angle_rad: float = 0.0
    mass_kg: float = 0.0
    inertia_kg_m2: float = 0.0


@dataclass(frozen=True)
class Driver:
    """The driven joint, and the law of its coordinate.

    Body ``link`` moves against body ``base``. With neither ``pin`` nor ``slider`` it is a link
    about its pin to the ground, and the coordinate its angle [rad]. With ``pin`` the coordinate is
    the angle of the link less the base's, two bodies that share this pin [rad]; with ``slider`` the
    displacement of that slider [m], whose sliding body is ``link`` (a link or a block).
    """

    link: str
    law: Law
    base: str = GROUND
    pin: str | None = None
    slider: str | None = None

    @property
    def is_crank(self) -> bool:
        """True if the coordinate is the link's own angle, at its pin to the ground."""
        return self.pin is None and self.slider is None

    @property
    def is_inner(self) -> bool:
        """True if it drives two moving bodies against each other."""
        return self.base != GROUND and self.link != GROUND

    @property
    def joint(self) -> str:
        """Name of the driven joint in a message."""
        if self.slider is not None:
            return f"slider {self.slider}"
        return self.link if self.pin is None else f"pin {self.pin} of {self.base} and {self.link}"

    @property
    def name(self) -> str:
        """Name in a table: the slider, or the turning link."""
        return self.slider or self.link

    @property
    def unit(self) -> str:
        """Unit of its coordinate: rad or m."""
        return "rad" if self.slider is None else "m"

    @property
    def effort(self) -> str:
        """Kind of its effort: a torque, or for a slider a force along its line."""
        return "torque" if self.slider is None else "force"

    @property
    def effort_unit(self) -> str:
        """Unit of its effort: N m or N."""
        return "N m" if self.slider is None else "N"


@dataclass(frozen=True)
class Scene:
    """A planar mechanism with one driver.

    ``branch`` holds +1 or -1 per assembly choice, by the name of the pin (dyad of two links: +1
    where the pin lies to the left of the line from the first outer pin to the second, the links in
    the order of the file) or of the slider (+1: along the direction of the line); the default is
    +1. For a group of class III it holds, by the name of its central link, the number of the
    assembly at time 0: from 1 on, by that link's angle in (-pi, pi]; the default is 1.
    ``tolerance`` overrides default tolerances by quantity. ``gravity_m_s2`` is zero by default;
    ``loads`` act from outside, ``friction`` in joints of two bodies, ``springs`` between bodies.
    ``start`` completes the start of free motion beyond the driver. ``elastic`` are the links that
    bend or stretch, by name; the others are rigid. ``beams`` are these links as an engine with
    nodes has them (`models.scene.cut_scenes`). ``gears`` are the pairs in mesh,
    ``cams`` those of cam and follower.
    """

    name: str
    source: str
    ground: Mapping[str, Point]
    links: Mapping[str, Link]
    sliders: Mapping[str, Slider]
    driver: Driver
    branch: Mapping[str, int] = field(default_factory=dict)
    gravity_m_s2: Point = (0.0, 0.0)
    tolerance: Mapping[str, float] = field(default_factory=dict)
    note: str = ""
    loads: Mapping[str, Load] = field(default_factory=dict)
    friction: Mapping[str, Friction] = field(default_factory=dict)
    springs: Mapping[str, Spring] = field(default_factory=dict)
    start: Start = field(default_factory=Start)
    elastic: Mapping[str, ElasticLink] = field(default_factory=dict)
    beams: Mapping[str, Beam] = field(default_factory=dict)
    gears: Mapping[str, Gear] = field(default_factory=dict)
    cams: Mapping[str, CamPair] = field(default_factory=dict)

    def __post_init__(self) -> None:
        _fix(self, "ground", "links", "sliders", "branch", "tolerance", "loads", "friction",
             "springs", "elastic", "beams", "gears", "cams")  # fmt: skip

    @cached_property
    def pins(self) -> Mapping[str, tuple[str, ...]]:
        """Every named point with the bodies that list it, ground first, then links in order."""
        bodies: dict[str, list[str]] = {point: [GROUND] for point in self.ground}
        for link in self.links.values():
            for point in link.points:
                bodies.setdefault(point, []).append(link.name)
        return FixedMapping({point: tuple(names) for point, names in bodies.items()})

    @property
    def points_of(self) -> Mapping[str, Mapping[str, Point]]:
        """Points of each body in its own frame, the ground's first."""
        return {GROUND: self.ground, **{name: link.points for name, link in self.links.items()}}

    @cached_property  # read at every step of a search
    def longest_m(self) -> float:
        """Longest distance between two points of one link: the scale of relative errors."""
        return max(span(link.points) for link in self.links.values())

    @property
    def is_free(self) -> bool:
        """True if the motion is free: the driver is released at time 0."""
        return self.driver.law.is_free

    @property
    def coulomb_joints(self) -> list[str]:
        """Joints whose friction follows from the reactions; engines do not get it."""
        return [n for n, one in self.friction.items() if isinstance(one, CoulombFriction)]

    @property
    def driver_arm_m(self) -> float:
        """Ratio of the driver's coordinate to an angle: 1 for an angle; for the displacement of a
        slider the longest length [m], so that speed over it is a rate of turning."""
        return 1.0 if self.driver.slider is None else self.longest_m

    @property
    def pace_rad_s(self) -> float:
        """Largest speed of the driver, for a slider over the longest length [rad/s]."""
        return self.driver.law.peak_speed_rad_s / self.driver_arm_m

    @property
    def driver_pivot(self) -> str:
        """The driven pin, for a crank its pin to the ground; empty for a slider."""
        if self.driver.pin is not None or self.driver.slider is not None:
            return self.driver.pin or ""
        return next(point for point in self.links[self.driver.link].points if point in self.ground)


@dataclass(frozen=True, eq=False, slots=True)
class Same:
    """A scene by identity, a key of its results: equal scenes may order links differently."""

    scene: Scene

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Same) and other.scene is self.scene

    def __hash__(self) -> int:
        return id(self.scene)


def as_bytes(scene: Scene) -> bytes:
    """Return the content of a scene without cached results: a key of slow results in any
    process."""
    return pickle.dumps(replace(scene))


def span(points: Mapping[str, Point]) -> float:
    """Return the largest distance between two of the points [m]."""
    places = list(points.values())
    return max(
        (((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2) ** 0.5 for a in places for b in places),
        default=0.0,
    )
