"""The same mechanism sped up; the rest is in `analytic.check.moved_scene`."""

from __future__ import annotations

from dataclasses import replace

from models.friction import ConstantFriction, Friction
from models.laws import Accelerating, ConstantSpeed, FromRest, Law, Oscillating, SpeedChange
from models.loads import Load, Stroke
from models.released import Released
from models.scene import Driver, Scene
from models.springs import Spring

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
    """The scene driven ``factor`` times as fast through the same angles, in similar motion, or let
    go so.

    Loads, springs and constant friction grow as inertia does. Where the factor is below 0 a stroke
    forward becomes one backward; friction turns round with the motion, and dampers do, so forces
    with them are others then.
    """
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
