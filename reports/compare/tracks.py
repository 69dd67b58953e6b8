"""Pair what an engine logged with the reference: one track per body and quantity."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Literal, TypeVar

import numpy as np

from models.array import Array
from models.motion import LinkMotion, Motion, PointMotion, SliderMotion
from models.scene import Scene
from reports.compare.series import angle_error
from reports.quantities.quantity import BodyKind

Order = Literal[0, 1, 2]
ORDERS: tuple[Order, ...] = (0, 1, 2)
Part = TypeVar("Part")
QUANTITIES: dict[BodyKind, tuple[str, str, str]] = {
    "link": ("angle", "velocity", "acceleration"),
    "slider": ("displacement", "velocity", "acceleration"),
    "point": ("position", "velocity", "acceleration"),
}


@dataclass(frozen=True)
class Track:
    """One quantity of one body over time.

    ``error`` is engine less reference [unit], (T,) or (T, 2); ``bound`` (T,) what the reference
    may be wrong by; ``magnitude`` the largest number in the log, which rounding is relative to;
    ``scale`` makes a pure number of the error.
    """

    quantity: str
    body_kind: BodyKind
    body: str
    error: Array
    bound: Array
    magnitude: float
    scale: float
    unit: str


def tracks(scene: Scene, motion: Motion, reference: Motion, order: Order) -> Iterator[Track]:
    """Tracks of every link, slider and moving point: the place itself (0), or a rate of it.

    It is the reference that says which there are: what the engine's motion lacks, or has another
    number of samples of, is an error that is NaN throughout. Points of the ground can not move and
    are left out, as is the driver's angle: it is the drive.
    """
    speed = scene.driver.law.peak_speed_rad_s**order
    suffix = ("", "/s", "/s^2")[order]
    for kind, body, engine, right, bound in _pairs(motion, reference, order):
        if kind == "link" and order == 0 and body == scene.driver.link:
            continue
        if kind == "point" and body in scene.ground:
            continue
        turns = kind == "link"
        yield Track(
            quantity=QUANTITIES[kind][order],
            body_kind=kind,
            body=body,
            error=angle_error(engine, right) if turns and order == 0 else engine - right,
            bound=np.zeros(right.shape[0]) if bound is None else bound,
            magnitude=float(np.max(np.abs(right), initial=0.0)),
            scale=speed if turns else scene.longest_m * speed,
            unit=("rad" if turns else "m") + suffix,
        )


def _pairs(
    motion: Motion, reference: Motion, order: Order
) -> Iterator[tuple[BodyKind, str, Array, Array, Array | None]]:
    """Body kind, body, the engine's series, the reference's, and the reference's bound."""
    known = reference.bound
    for name, link in reference.links.items():
        sure = None if known is None else _link(known.links[name], order)
        right = _link(link, order)
        yield "link", name, _given(motion.links, name, _link, order, right), right, sure
    for name, slider in reference.sliders.items():
        sure = None if known is None else _slider(known.sliders[name], order)
        right = _slider(slider, order)
        yield "slider", name, _given(motion.sliders, name, _slider, order, right), right, sure
    for name, point in reference.points.items():
        sure = None if known is None else _point(known.points[name], order)
        right = _point(point, order)
        yield "point", name, _given(motion.points, name, _point, order, right), right, sure


def _given(
    moved: Mapping[str, Part],
    name: str,
    part: Callable[[Part, Order], Array],
    order: Order,
    like: Array,
) -> Array:
    """The engine's series; NaN in the shape of ``like`` where it gave none of that shape."""
    return fitting(part(moved[name], order) if name in moved else None, like)


def fitting(series: Array | None, like: Array) -> Array:
    """The series, or NaN throughout where there is none of the shape of ``like``."""
    if series is None or series.shape != like.shape:
        return np.full_like(like, np.nan)
    return series


def lacking(motion: Motion, reference: Motion) -> list[str]:
    """The links, sliders and points of the reference that the engine's motion has not got."""
    pairs: tuple[tuple[str, Mapping[str, object], Mapping[str, object]], ...] = (
        ("link", motion.links, reference.links),
        ("slider", motion.sliders, reference.sliders),
        ("point", motion.points, reference.points),
    )
    return [
        f"{kind} {name}" for kind, moved, wanted in pairs for name in wanted if name not in moved
    ]


def _link(motion: LinkMotion, order: Order) -> Array:
    return (motion.theta, motion.omega, motion.alpha)[order]


def _slider(motion: SliderMotion, order: Order) -> Array:
    return (motion.displacement, motion.speed, motion.acceleration)[order]


def _point(motion: PointMotion, order: Order) -> Array:
    return (motion.position, motion.velocity, motion.acceleration)[order]
