"""The same mechanism sped up, or otherwise changed so that what it does is known by that."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from analytic.structure.mobility import sides_of
from models.array import Array
from models.scene import Driver, Scene, moved
from models.scene.driver import Released
from models.scene.laws import Accelerating, ConstantSpeed, FromRest, Law, Oscillating, SpeedChange
from models.scene.loads import ConstantFriction, Friction, Load, Spring, Stroke

OPPOSITE: dict[Stroke, Stroke] = {"both": "both", "forward": "backward", "backward": "forward"}


def faster_law(law: Law, factor: float) -> Law:
    """The law that runs ``factor`` times as fast through the same angles."""
    match law:
        case Oscillating():
            return replace(law, frequency_rad_s=law.frequency_rad_s * factor)
        case ConstantSpeed():
            return replace(law, speed_rad_s=law.speed_rad_s * factor)
        case FromRest():
            return FromRest(law.start_rad, law.speed_rad_s * factor, law.rise_s / factor)
        case Accelerating(start, speed, gain):
            return Accelerating(start, speed * factor, gain * factor**2)
        case Released():
            return Released(law.start_rad, law.speed_rad_s * factor, law.duration_s / factor)
        case SpeedChange(start, before, after, at, rise):
            return SpeedChange(start, before * factor, after * factor, at / factor, rise / factor)
    raise TypeError(law)


def sped_up(scene: Scene, factor: float) -> Scene:
    """The scene driven, or let go, ``factor`` times as fast through the same angles. Loads, springs
    and constant friction grow as inertia does; where the factor is below 0 a stroke forward becomes
    one backward, and friction and dampers turn round with the motion."""
    g = scene.gravity_m_s2

    def load(old: Load) -> Load:
        stretch = {"time": 1.0 / factor, "speed": factor, "omega": factor}.get(old.over, 1.0)
        return replace(
            old,
            characteristic=old.characteristic.carried(factor**2, stretch=stretch),
            stroke=old.stroke if factor > 0.0 else OPPOSITE[old.stroke],
        )

    def rubbing(old: Friction) -> Friction:
        return replace(old, size=old.size * factor**2) if isinstance(old, ConstantFriction) else old

    def spring(old: Spring) -> Spring:
        return replace(old, rate=old.rate * factor**2, damping=old.damping * abs(factor))

    start = scene.start
    return replace(
        scene,
        start=replace(
            start,
            rates_rad_s={name: rate * factor for name, rate in start.rates_rad_s.items()},
            speeds_m_s={name: speed * factor for name, speed in start.speeds_m_s.items()},
        ),
        driver=Driver(scene.driver.link, faster_law(scene.driver.law, factor)),
        gravity_m_s2=(g[0] * factor**2, g[1] * factor**2),
        loads={name: load(old) for name, old in scene.loads.items()},
        friction={name: rubbing(old) for name, old in scene.friction.items()},
        springs={name: spring(old) for name, old in scene.springs.items()},
    )


@dataclass(frozen=True)
class Change:
    """What is done to a scene, and how its motion is other by that: the plane is mirrored in the
    x-axis, grows, is turned and shifted; all goes ``fast`` times as fast."""

    of: Callable[[Scene], Scene]
    turn_rad: float = 0.0
    shift_m: tuple[float, float] = (0.0, 0.0)
    grow: float = 1.0
    fast: float = 1.0
    side: float = 1.0

    def turned(self, vectors: Array) -> Array:
        """Vectors (T, 2) in the changed plane, as long as they were."""
        c, s = math.cos(self.turn_rad), math.sin(self.turn_rad)
        x, y = vectors[:, 0], self.side * vectors[:, 1]
        return np.stack([c * x - s * y, s * x + c * y], axis=1)


MOVES: dict[str, Change] = {
    "turned": Change(lambda s: moved.rotated(s, 0.7), turn_rad=0.7),
    "moved": Change(lambda s: moved.moved(s, (3.0, -2.0)), shift_m=(3.0, -2.0)),
    "mirrored": Change(lambda s: moved.mirrored(s, sides_of(s)), side=-1.0),
    "larger": Change(lambda s: moved.scaled(s, 10.0), grow=10.0),
    "smaller": Change(lambda s: moved.scaled(s, 0.1), grow=0.1),
}


def faster(factor: float) -> Change:
    return Change(lambda s: sped_up(s, factor), fast=factor)
