"""The second opinion: all constraints of the mechanism at once, Phi(q, t) = 0, by Newton's method.

Nothing here knows of dyads. Every body has coordinates (x, y, theta) of its frame; every pin, every
prismatic pair and the driver gives its equations; position, velocity and acceleration follow from

    Phi(q, t) = 0        Phi_q q' = -Phi_t        Phi_q q'' = gamma

Source: E. J. Haug, Computer Aided Kinematics and Dynamics of Mechanical Systems, chapters 3 and 4.
It starts from a rough guess of one position, and follows the mechanism from there in small steps of
the driver; so it also serves groups that have no closed form.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analytic.structure import sliding_body
from models.errors import CrankcheckError
from models.joints import block_name, local_point
from models.motion import LinkMotion, Motion, PointMotion, SliderMotion
from models.scene import GROUND, Point, Scene, Slider

Array = NDArray[np.float64]

LONGEST_STEP_RAD = 0.05
"""The driver turns at most so far between two positions: the predictor stays on its branch."""
MOST_ITERATIONS = 25
EPS = float(np.finfo(np.float64).eps)


@dataclass(frozen=True)
class Guess:
    """A rough position: per body (links, and ``block NAME`` for slider blocks) x, y [m], theta."""

    bodies: Mapping[str, tuple[float, float, float]]


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

    def _pairs_of_pins(self) -> list[tuple[str, Point, str, Point]]:
        """Each pin as pairs of bodies, with the place of the pin in the frame of each."""
        places: dict[str, list[tuple[str, Point]]] = {}
        for point, bodies in self.scene.pins.items():
            places[point] = [(body, local_point(self.scene, body, point)) for body in bodies]
        for slider in self.scene.sliders.values():
            if slider.link is None:
                places.setdefault(slider.point, []).append((block_name(slider), (0.0, 0.0)))
        return [(*held[0], *other) for held in places.values() for other in held[1:]]

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
            self._add_point(rows[r : r + 2], a, self._point(q, a, at_a)[1], np.eye(2))
            self._add_point(rows[r : r + 2], b, self._point(q, b, at_b)[1], -np.eye(2))
            r += 2
        for slider in self.scene.sliders.values():
            body, tip = self.tip(slider)
            along, across = self._line(q, slider)
            p, arm = self._point(q, body, tip)
            g, guide = self._point(q, slider.on, slider.through_m)
            self._add_point(rows[r : r + 1], body, arm, across[None, :])
            self._add_point(rows[r : r + 1], slider.on, guide, -across[None, :])
            self._add_angle(rows[r], slider.on, -float(along @ (p - g)))
            self._add_angle(rows[r + 1], body, 1.0)
            self._add_angle(rows[r + 1], slider.on, -1.0)
            r += 2
        self._add_angle(rows[r], self.scene.driver.link, 1.0)
        return rows

    def _add_point(self, rows: Array, body: str, arm: Array, weight: Array) -> None:
        """Add weight times the derivative of a point of ``body`` by its coordinates."""
        if body != GROUND:
            i = self.at[body]
            rows[:, i : i + 2] += weight
            rows[:, i + 2] += weight @ np.array([-arm[1], arm[0]])

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


def solve(scene: Scene, time_s: Array, guess: Guess) -> Motion:
    """The motion of a scene from its full constraint equations.

    Parameters
    ----------
    scene : Scene
        A mechanism of mobility 1; its groups need no closed form.
    time_s : Array
        Increasing times [s], shape (T,).
    guess : Guess
        A rough position at the first time; it decides the branch.

    Returns
    -------
    Motion
        All links, points and sliders, without bounds.

    Raises
    ------
    CrankcheckError
        Newton's method does not converge from the guess, or the Jacobian is singular on the way.
    """
    system = Constraints(scene)
    law = scene.driver.law
    q = np.array([c for body in system.bodies for c in guess.bodies[body]])
    positions, rates, seconds = [], [], []
    before: float | None = None
    for t in np.asarray(time_s, dtype=np.float64):
        theta, omega, alpha = (float(a[0]) for a in law.at(np.array([t])))
        start = theta if before is None else before
        for angle in _stations(start, theta):
            if before is not None:
                lead = np.zeros(system.size)
                lead[-1] = angle - before
                q = q + _solved(system, q, lead, before)
            q = _closed(system, q, angle)
            before = angle
        drive = np.zeros(system.size)
        drive[-1] = omega
        qd = _solved(system, q, drive, theta)
        positions.append(q)
        rates.append(qd)
        seconds.append(_solved(system, q, system.gamma(q, qd, alpha), theta))
    return _motion(system, np.asarray(time_s, dtype=np.float64), positions, rates, seconds)


def _stations(start: float, end: float) -> Array:
    """Driver angles from ``start`` (exclusive) to ``end`` in steps that keep the branch."""
    count = max(1, math.ceil(abs(end - start) / LONGEST_STEP_RAD))
    stations: Array = start + (end - start) * np.arange(1, count + 1) / count
    return stations


def _solved(system: Constraints, q: Array, right: Array, theta: float) -> Array:
    """The solution of Phi_q x = right."""
    try:
        solution: Array = np.linalg.solve(system.jacobian(q), right).astype(np.float64)
        return solution
    except np.linalg.LinAlgError:
        raise CrankcheckError(
            f"{system.scene.name}: the constraints are singular at {math.degrees(theta):.6g} deg"
        ) from None


def _closed(system: Constraints, q: Array, theta: float) -> Array:
    """Newton's method from q at driver angle theta, down to rounding."""
    last = math.inf
    unit = np.tile([system.scene.longest_m, system.scene.longest_m, 1.0], len(q) // 3)
    for _ in range(MOST_ITERATIONS):
        step = _solved(system, q, -system.phi(q, theta), theta)
        q = q + step
        size = float(np.max(np.abs(step) / unit))
        if size <= EPS or (size < 1e-9 and size >= 0.5 * last):
            return q  # the steps no longer matter, or no longer shrink: what is left is rounding
        last = size
    raise CrankcheckError(
        f"{system.scene.name}: Newton's method does not converge at {math.degrees(theta):.6g} deg "
        f"(last step {last:.3g}); give a better guess"
    )


def _motion(
    system: Constraints,
    time_s: Array,
    positions: list[Array],
    rates: list[Array],
    seconds: list[Array],
) -> Motion:
    """The coordinates of all samples as a motion of links, points and sliders."""
    scene = system.scene
    q, qd, qdd = np.array(positions), np.array(rates), np.array(seconds)

    def link(body: str) -> LinkMotion:
        i = system.at[body] + 2
        return LinkMotion(q[:, i], qd[:, i], qdd[:, i])

    def point(body: str, local: Point) -> PointMotion:
        if body == GROUND:
            rest = np.zeros((len(q), 2))
            return PointMotion(rest + np.array(local), rest, rest.copy())
        i = system.at[body]
        c, s = np.cos(q[:, i + 2]), np.sin(q[:, i + 2])
        arm = np.stack([c * local[0] - s * local[1], s * local[0] + c * local[1]], axis=1)
        turned = np.stack([-arm[:, 1], arm[:, 0]], axis=1)
        w, g = qd[:, i + 2, None], qdd[:, i + 2, None]
        at = slice(i, i + 2)
        return PointMotion(
            q[:, at] + arm, qd[:, at] + w * turned, qdd[:, at] + g * turned - w * w * arm
        )

    def slider(s: Slider) -> SliderMotion:
        tip, guide = point(*system.tip(s)), point(s.on, s.through_m)
        rest = np.zeros(len(q))
        on = LinkMotion(rest, rest, rest) if s.on == GROUND else link(s.on)
        angle = on.theta + s.direction_rad
        along = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        across = np.stack([-along[:, 1], along[:, 0]], axis=1)
        away = tip.position - guide.position
        va, vb = tip.velocity - guide.velocity, tip.acceleration - guide.acceleration
        displacement = np.sum(along * away, axis=1)
        speed = np.sum(along * va, axis=1) + on.omega * np.sum(across * away, axis=1)
        acceleration = (
            np.sum(along * vb, axis=1)
            + 2.0 * on.omega * np.sum(across * va, axis=1)
            + on.alpha * np.sum(across * away, axis=1)
            - on.omega**2 * displacement
        )
        return SliderMotion(displacement, speed, acceleration)

    carriers = {
        p: (bodies[0], local_point(scene, bodies[0], p)) for p, bodies in scene.pins.items()
    }
    for s in scene.sliders.values():
        carriers.setdefault(s.point, system.tip(s))
    return Motion(
        time_s,
        {name: link(name) for name in scene.links},
        {name: point(*carrier) for name, carrier in carriers.items()},
        {name: slider(s) for name, s in scene.sliders.items()},
    )
