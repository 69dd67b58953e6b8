"""Interface of a quantity: one entry holds all data of it that the other rooms need."""

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from models.array import Array
from models.motion import Bound, Motion, Order
from models.scene import Scene
from sim.engine import Run

BodyKind = Literal["driver", "link", "slider", "point", "gear", "cam", "mechanism"]
Source = Literal["reported", "differenced"]
Role = Literal["drive", "place", "closure", "derived", "force", "free", "elastic"]
"""Convergence, geometric errors and differences are computed for role "place". Derived quantities
follow from these, and forces go with them: the first samples, and those near change points, are
separate rows. Forces are compared on request only, role "free" in free motion, which has no drive,
and role "elastic" where links bend."""
Series = Mapping[str, Array]
"""A number (T,) or two (T, 2) per sample, by body."""


@dataclass(frozen=True)
class Measure:
    """A quantity of one kind of body, in ``unit``.

    ``column`` names its largest error in the frame of cells, and has ``_error_`` in it where there
    are errors of several kinds. ``truth`` is the reference's series, and determines the compared
    bodies: none without a request. ``logged`` is the engine's, ``bound`` the uncertainty of the
    reference (T,), empty where it is unknown. ``scale`` makes a pure number of an error, a multiple
    of ``share``: L the longest link, w the driver's peak speed.
    """

    body_kind: BodyKind
    column: str
    unit: str
    share: str
    scale: Callable[[Scene, Motion], float]
    truth: Callable[[Scene, Motion], Series]
    logged: Callable[[Scene, Run], Series]
    bound: Callable[[Scene, Motion], Series] = lambda scene, reference: {}


@dataclass(frozen=True)
class Tolerance:
    """The numbers of a default limit, with their reason; `reports.judge.tolerance` has the formula,
    `reports.judge.rules.limits` that of ``jump``, ``parts`` and ``makes_up``. ``lasting``,
    ``drifting``, ``opening``, ``arc`` and ``late`` are for free motion, whose errors grow with its
    length; a limit that ``bends`` is a share of the largest deflection."""

    reason: str
    cap: float = math.inf
    coefficient: float = 0.0
    order: int = 2
    power: float = 0.0
    conditioned: bool = False
    closes: bool = False
    share: float = 0.0
    share_order: int = 0
    load_share: float = 0.0
    slope: Literal["", "reaction", "torque"] = ""
    floor: float = 0.0
    differenced: int = 0
    rate: int = 0
    jump: float = 0.0
    parts: bool = False
    makes_up: bool = False
    lasting: float = 0.0
    drifting: float = 0.0
    opening: float = 0.0
    arc: float = 0.0
    late: float = 0.0
    bends: bool = False


@dataclass(frozen=True)
class Criterion:
    """Criterion for the errors of one source: the words of a rule, and its tolerance.

    ``short`` is the rule in the verdict table, ``diagram`` the error in the page's list of
    diagrams, which omits it where that is empty. ``free_motion`` is the tolerance of free motion,
    None where the error is only shown there.
    """

    id: str
    title: str
    explanation: str
    cure: str
    short: str
    tolerance: Tolerance
    diagram: str = ""
    free_motion: Tolerance | None = None

    @property
    def source(self) -> Source:
        return "differenced" if self.tolerance.differenced else "reported"


@dataclass(frozen=True)
class Quantity:
    """A compared quantity, for all kinds of bodies that have it.

    ``head`` is its column of the verdict table, with others of that head ("" in none). ``instants``
    are those of the engine's numbers, None where they are those of the positions; ``silent`` is
    True for a run whose engine has no such numbers, which is no fault.
    """

    name: str
    role: Role
    measures: tuple[Measure, ...]
    criteria: tuple[Criterion, ...]
    head: str = ""
    instants: Callable[[Run], Array | None] = lambda run: None
    silent: Callable[[Run], bool] = lambda run: False

    @property
    def share(self) -> str:
        """The unit of its pure numbers, lengths apart."""
        return self.measures[0].share

    def of(self, kind: BodyKind) -> Measure:
        """Return the quantity of a kind of body."""
        return next(each for each in self.measures if each.body_kind == kind)


def tolerance_name(quantity: str, source: Source) -> str:
    """Return the name of a quantity and source in `--tol`, scenes and pure columns."""
    return quantity if source == "reported" else f"{quantity}-{source}"


MovingKind = Literal["link", "slider", "point"]


def moving(kind: MovingKind, order: Order, column: str) -> Measure:
    """Return angles, displacements or positions of moving bodies of a kind, or a rate of them."""
    turns = kind == "link"

    def scale(scene: Scene, _: Motion) -> float:
        speed = scene.pace_rad_s**order
        return speed if turns else scene.longest_m * speed

    def truth(scene: Scene, reference: Motion) -> Series:
        """Omit points of the ground, and the driver's coordinate, which is the drive."""
        own = scene.driver
        crank = (own.link,) if order == 0 and own.is_crank else ()
        slider = (own.slider,) if order == 0 and own.slider is not None else ()
        still: Mapping[MovingKind, Collection[str]] = {
            "link": crank,
            "slider": slider,
            "point": scene.ground,
        }
        bodies = _read(reference, kind, order).items()
        return {name: series for name, series in bodies if name not in still.get(kind, ())}

    return Measure(
        body_kind=kind,
        column=column,
        unit=("rad" if turns else "m") + ("", "/s", "/s^2")[order],
        share=(("rad", "w", "w^2") if turns else ("L", "w L", "w^2 L"))[order],
        scale=scale,
        truth=truth,
        logged=lambda _, run: _read(run.motion, kind, order),
        bound=lambda _, reference: _read(reference.bound, kind, order),
    )


def every_place(kind: MovingKind, column: str) -> Measure:
    """Return the positions of all moving bodies of a kind, including the driver."""

    def truth(scene: Scene, reference: Motion) -> Series:
        still = scene.ground if kind == "point" else ()
        return {name: at for name, at in _read(reference, kind, 0).items() if name not in still}

    return replace(moving(kind, 0, column), truth=truth)


FIELDS: Mapping[MovingKind, Sequence[str]] = {
    "link": ("theta", "omega", "alpha"),
    "slider": ("displacement", "speed", "acceleration"),
    "point": ("position", "velocity", "acceleration"),
}
"""Attributes of a motion for a position, and its rates."""


def _read(motion: Motion | Bound | None, kind: MovingKind, order: Order) -> Series:
    """Return the series of a motion, or of a bound, if it is there."""
    bodies = () if motion is None else getattr(motion, f"{kind}s").items()
    return {name: getattr(body, FIELDS[kind][order]) for name, body in bodies}
