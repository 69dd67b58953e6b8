"""Position of a mechanism at one instant, before the first vector is drawn."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from analytic.kinematics import solve_driven
from analytic.structure.mobility import Structure, analyse
from models.array import Array
from models.motion import Motion
from models.scene import GROUND, Scene
from models.scene.joints import sliding_angle, sliding_body


@dataclass(frozen=True)
class DriverState:
    """Angle [rad], angular velocity [rad/s] and acceleration [rad/s^2] of the driver."""

    theta: float
    omega: float
    alpha: float = 0.0


@dataclass(frozen=True)
class PlacedMechanism:
    """Places of all points [m], (2,) each, and angles of all bodies [rad], with blocks and the
    ground; no rates, which the polygons find."""

    scene: Scene
    structure: Structure
    driver: DriverState
    points: Mapping[str, Array]
    angles: Mapping[str, float]

    @staticmethod
    def of(scene: Scene, driver: DriverState) -> PlacedMechanism:
        """Place the scene with its driver in a state. Raises as `analytic.kinematics.solve`."""
        one = np.ones(1)
        motion = solve_driven(
            scene, driver.theta * one, driver.omega * one, driver.alpha * one, bound=False
        )
        return PlacedMechanism.standing(scene, motion, driver)

    @staticmethod
    def standing(
        scene: Scene, motion: Motion, driver: DriverState | None = None, sample: int = 0
    ) -> PlacedMechanism:
        """Place the scene in a sample of a motion, driven or free, on any branch; its driver moves
        as there by default."""
        angles = {GROUND: 0.0} | {n: float(m.theta[sample]) for n, m in motion.links.items()}
        for slider in scene.sliders.values():
            if slider.link is None:
                angles[sliding_body(slider)] = angles[slider.on] + sliding_angle(slider)
        points = {name: np.array(point.position[sample]) for name, point in motion.points.items()}
        if driver is None:
            moves = motion.links[scene.driver.link]
            theta, omega, alpha = (
                float(series[sample]) for series in (moves.theta, moves.omega, moves.alpha)
            )
            driver = DriverState(theta, omega, alpha)
        return PlacedMechanism(scene, analyse(scene), driver, points, angles)

    def along(self, slider: str) -> Array:
        """Return the unit vector along the line of a slider."""
        guide = self.scene.sliders[slider]
        angle = self.angles[guide.on] + guide.direction_rad
        return np.array([np.cos(angle), np.sin(angle)])


def quarter_turn(vector: Array) -> Array:
    """Return the vector turned by a quarter turn counter-clockwise."""
    return np.array([-vector[1], vector[0]])


@dataclass(frozen=True)
class BodyRates:
    """Body by its point at ``place`` [m], with that point's ``velocity`` [m/s] and ``acceleration``
    [m/s^2], (2,) each, and by ``omega`` [rad/s] and ``alpha`` [rad/s^2]."""

    place: Array
    velocity: Array
    acceleration: Array
    omega: float
    alpha: float

    def velocity_at(self, place: Array) -> Array:
        """Return the velocity of the body's point at a place [m/s], (2,)."""
        return np.asarray(self.velocity + self.omega * quarter_turn(place - self.place))

    def acceleration_at(self, place: Array) -> Array:
        """Return the acceleration of the body's point at a place [m/s^2], (2,)."""
        arm = place - self.place
        turning = self.alpha * quarter_turn(arm) - self.omega**2 * arm
        return np.asarray(self.acceleration + turning)


STILL = BodyRates(np.zeros(2), np.zeros(2), np.zeros(2), 0.0, 0.0)
"""Rates of the ground."""
