"""What rubs in a joint: Coulomb's friction, or one that is always as large."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class CoulombFriction:
    """Friction of ``mu`` times the normal force in the pin or slider ``joint``; in a pin it acts at
    ``radius_m`` [m] from its centre, in a slider ``radius_m`` is 0."""

    joint: str
    mu: float
    radius_m: float = 0.0


@dataclass(frozen=True)
class ConstantFriction:
    """Friction in the pin or slider ``joint`` that is ``size`` against the motion, whatever the
    joint bears: a torque [N m] in a pin, a force [N] in a slider."""

    joint: str
    size: float


Friction = CoulombFriction | ConstantFriction
