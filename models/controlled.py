"""A driver that a torque holds to a constant speed: how well it does comes from masses and forces.

The torque is what the rigid mechanism needs at that speed, less what the driver is ahead of it, in
angle and in speed, times the gains of a controller::

    tau = tau_d(t) - kP (theta - theta_d(t)) - kD (theta' - theta_d')

A rigid mechanism that starts on its way keeps to it; with elastic links the driver gives way, and
takes energy out of their vibration. Source: Thesis on vibration of planar mechanisms with elastic
links (2018), control of the crank.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from models.characteristics import Characteristic, Polynomial
from models.laws import ConstantSpeed
from models.loads import Load, Over


@dataclass(frozen=True)
class Controlled(ConstantSpeed):
    """The speed that is asked for, and the gains kP [N m/rad] and kD [N m s/rad]. Raises ValueError
    for gains below 0."""

    kp_n_m_rad: float
    kd_n_m_s: float

    def __post_init__(self) -> None:
        super().__post_init__()
        if min(self.kp_n_m_rad, self.kd_n_m_s) < 0.0:
            raise ValueError(
                f"kp_n_m_rad is {self.kp_n_m_rad:g} and kd_n_m_s {self.kd_n_m_s:g}: a controller "
                "drives back what is ahead; give gains of 0 or more"
            )

    def loads(self, link: str, needed: Characteristic) -> Iterator[Load]:
        """The torque of the controller as loads on the driver, ``link``, that is let go: over time
        what is ``needed``; and the gains, over time, over the driver's angle and over its angular
        velocity."""
        kp, kd, speed = self.kp_n_m_rad, self.kd_n_m_s, self.speed_rad_s
        parts: list[tuple[str, Over, Characteristic]] = [("needed", "time", needed)]
        if kp:
            parts += [
                ("asked", "time", Polynomial((kp * self.start_rad, kp * speed))),
                ("angle", "angle", Polynomial((0.0, -kp))),
            ]
        if kd:
            parts.append(("speed", "omega", Polynomial((kd * speed, -kd))))
        for name, over, characteristic in parts:
            yield Load(f"controller-{name}", link, None, characteristic, over)
