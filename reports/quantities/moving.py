"""How places and rates of links, sliders and points are read from a motion."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import Literal

from models.motion import Bound, Motion, Order
from models.scene import Scene
from reports.quantities.quantity import Measure, Series

MovingKind = Literal["link", "slider", "point"]


def moving(kind: MovingKind, order: Order, column: str) -> Measure:
    """Angles, displacements or positions of the moving bodies of a kind, or a rate of them."""
    turns = kind == "link"

    def scale(scene: Scene, _: Motion) -> float:
        speed = scene.pace_rad_s**order
        return speed if turns else scene.longest_m * speed

    def truth(scene: Scene, reference: Motion) -> Series:
        """Without points of the ground, and without the driver's coordinate, which is the drive."""
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
    """The places of all moving bodies of a kind, the driver with them."""

    def truth(scene: Scene, reference: Motion) -> Series:
        still = scene.ground if kind == "point" else ()
        return {name: at for name, at in _read(reference, kind, 0).items() if name not in still}

    return replace(moving(kind, 0, column), truth=truth)


def _read(motion: Motion | Bound | None, kind: MovingKind, order: Order) -> Series:
    """The series of a motion, or of a bound, if it is there."""
    if motion is None:
        return {}
    if kind == "link":
        return {n: (m.theta, m.omega, m.alpha)[order] for n, m in motion.links.items()}
    if kind == "slider":
        sliders = motion.sliders.items()
        return {n: (m.displacement, m.speed, m.acceleration)[order] for n, m in sliders}
    points = motion.points.items()
    return {n: (m.position, m.velocity, m.acceleration)[order] for n, m in points}
