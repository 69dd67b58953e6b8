"""The constraint equations of a whole mechanism, with their derivatives.

Nothing here knows of dyads. Every body has coordinates (x, y, theta) of its frame; every pin, every
prismatic pair and the driver gives its equations. Source: E. J. Haug, Computer Aided Kinematics and
Dynamics of Mechanical Systems, chapters 3 and 4.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from analytic.structure.mobility import sliding_body
from models.array import Array
from models.errors import CrankcheckError
from models.joints import block_name, local_point
from models.scene import GROUND, Point, Scene, Slider


class Constraints:
    """The constraint equations of a scene, as functions of the coordinates of its bodies.

    Coordinates q (3 n,): x, y [m], theta [rad] of each body in the order of ``bodies``. Equations
    (3 n,): two per pair, and the driver's last.
    """

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        blocks = [block_name(s) for s in scene.sliders.values() if s.link is None]
        self.bodies = (*scene.links, *blocks)
        self.at = {body: 3 * i for i, body in enumerate(self.bodies)}
        self._pins = self._pairs_of_pins()
        self.size = 3 * len(self.bodies)
        equations = 2 * len(self._pins) + 2 * len(scene.sliders) + 1
        if equations != self.size:
            raise CrankcheckError(
                f"{scene.name}: {equations} constraint equations for {self.size} coordinates; "
                "a mechanism of mobility 1 has as many of each"
            )

    def pin_pairs(self) -> Iterator[tuple[str, str, str]]:
        """The point and the two bodies of every two equations of pins, in the order of ``phi``."""
        for point, held in self._places_of_pins().items():
            for other, _ in held[1:]:
                yield point, held[0][0], other

    def _pairs_of_pins(self) -> list[tuple[str, Point, str, Point]]:
        """Each pin as pairs of bodies, with the place of the pin in the frame of each."""
        places = self._places_of_pins()
        return [(*held[0], *other) for held in places.values() for other in held[1:]]

    def _places_of_pins(self) -> dict[str, list[tuple[str, Point]]]:
        """The bodies at every point, with its place in the frame of each."""
        places: dict[str, list[tuple[str, Point]]] = {}
        for point, bodies in self.scene.pins.items():
            places[point] = [(body, local_point(self.scene, body, point)) for body in bodies]
        for slider in self.scene.sliders.values():
            if slider.link is None:
                places.setdefault(slider.point, []).append((block_name(slider), (0.0, 0.0)))
        return places

    def tip(self, slider: Slider) -> tuple[str, Point]:
        """The body that slides and the place of its point on the line."""
        body = sliding_body(slider)
        return body, local_point(self.scene, body, slider.point)

    def _point(self, q: Array, body: str, local: Point) -> tuple[Array, Array]:
        """Position of a point, and its arm R r from the frame's origin."""
        if body == GROUND:
            return np.array(local), np.zeros(2)
        i = self.at[body]
        c, s = math.cos(q[i + 2]), math.sin(q[i + 2])
        arm = np.array([c * local[0] - s * local[1], s * local[0] + c * local[1]])
        return q[i : i + 2] + arm, arm

    def _angle(self, q: Array, body: str) -> float:
        return 0.0 if body == GROUND else float(q[self.at[body] + 2])

    def _line(self, q: Array, slider: Slider) -> tuple[Array, Array]:
        """Unit vectors along and across (to the left of) the slider's line."""
        angle = self._angle(q, slider.on) + slider.direction_rad
        c, s = math.cos(angle), math.sin(angle)
        return np.array([c, s]), np.array([-s, c])

    def phi(self, q: Array, theta: float) -> Array:
        """The violation of each equation [m or rad] at driver angle ``theta``."""
        rows: list[float] = []
        for a, at_a, b, at_b in self._pins:
            rows.extend(self._point(q, a, at_a)[0] - self._point(q, b, at_b)[0])
        for slider in self.scene.sliders.values():
            body, tip = self.tip(slider)
            _, across = self._line(q, slider)
            away = self._point(q, body, tip)[0] - self._point(q, slider.on, slider.through_m)[0]
            lean = self._angle(q, body) - self._angle(q, slider.on)
            rows.append(float(across @ away))
            rows.append(lean - slider.direction_rad - slider.angle_rad)
        rows.append(self._angle(q, self.scene.driver.link) - theta)
        return np.array(rows)

    def jacobian(self, q: Array) -> Array:
        """Phi_q (3 n, 3 n)."""
        rows = np.zeros((self.size, self.size))
        r = 0
        for a, at_a, b, at_b in self._pins:
            for body, local, sign in ((a, at_a, 1.0), (b, at_b, -1.0)):
                if body != GROUND:
                    i, (x, y) = self.at[body], self._point(q, body, local)[1].tolist()
                    rows[r, i] = rows[r + 1, i + 1] = sign
                    rows[r, i + 2], rows[r + 1, i + 2] = -sign * y, sign * x
            r += 2
        for slider in self.scene.sliders.values():
            body, tip = self.tip(slider)
            along, across = self._line(q, slider)
            p, arm = self._point(q, body, tip)
            g, guide = self._point(q, slider.on, slider.through_m)
            self._add_point(rows[r], body, arm, across)
            self._add_point(rows[r], slider.on, guide, -across)
            self._add_angle(rows[r], slider.on, -float(along @ (p - g)))
            self._add_angle(rows[r + 1], body, 1.0)
            self._add_angle(rows[r + 1], slider.on, -1.0)
            r += 2
        self._add_angle(rows[r], self.scene.driver.link, 1.0)
        return rows

    def _add_point(self, row: Array, body: str, arm: Array, weight: Array) -> None:
        """Add weight times the derivative of a point of ``body`` by its coordinates."""
        if body != GROUND:
            i = self.at[body]
            row[i : i + 2] += weight
            row[i + 2] += weight[1] * arm[0] - weight[0] * arm[1]

    def _add_angle(self, row: Array, body: str, weight: float) -> None:
        if body != GROUND:
            row[self.at[body] + 2] += weight

    def gamma(self, q: Array, rates: Array, alpha: float) -> Array:
        """The right side of the acceleration equations: what q'' has to balance (3 n,)."""
        rows: list[float] = []
        for a, at_a, b, at_b in self._pins:
            rows.extend(self._pull(q, rates, a, at_a) - self._pull(q, rates, b, at_b))
        for slider in self.scene.sliders.values():
            body, tip = self.tip(slider)
            along, across = self._line(q, slider)
            w = self._angle(rates, slider.on)
            away = self._point(q, body, tip)[0] - self._point(q, slider.on, slider.through_m)[0]
            relative = self._velocity(q, rates, body, tip) - self._velocity(
                q, rates, slider.on, slider.through_m
            )
            pull = self._pull(q, rates, body, tip) - self._pull(
                q, rates, slider.on, slider.through_m
            )
            rows.append(float(across @ pull + 2.0 * w * (along @ relative) + w * w * across @ away))
            rows.append(0.0)
        rows.append(alpha)
        return np.array(rows)

    def _pull(self, q: Array, rates: Array, body: str, local: Point) -> Array:
        """The centripetal part of a point's acceleration, with the sign it has on the right."""
        return self._point(q, body, local)[1] * self._angle(rates, body) ** 2

    def _velocity(self, q: Array, rates: Array, body: str, local: Point) -> Array:
        if body == GROUND:
            return np.zeros(2)
        _, arm = self._point(q, body, local)
        i = self.at[body]
        velocity: Array = rates[i : i + 2] + rates[i + 2] * np.array([-arm[1], arm[0]])
        return velocity
