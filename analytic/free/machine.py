"""The equation of a machine with one freedom, in any coordinate u of it.

With rates v', theta' and q' of bodies and springs per unit of the rate of u::

    J u'' + J' u'^2 / 2 = Q       J = sum (m v'^2 + I theta'^2)
                                  Q = sum (F v' + M theta') - sum (pull q') - sign(u') sum (f |s'|)

J and J' follow from the kinematics to second order, in closed form. Q comes from weights, loads,
springs with their dampers, and friction f of constant size in joints that rub at s'. Source:
problem book "Bai tap co hoc may", chapter on real motion; I. I. Artobolevskii, Theory of
Mechanisms, on reduced masses.
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import cached_property

import numpy as np

from analytic.dyads.chunk import Chunk
from analytic.dyads.plane import Real
from analytic.forces.force_elements import spring_lengths
from analytic.forces.virtual_power import inertia_and_slope, loaded_bodies, torque_by_power
from analytic.free.chart import Chart, LimitedScene
from analytic.structure.mobility import analyse
from models.array import Array
from models.errors import CrankcheckError
from models.scene import Scene
from models.scene.joints import block_name
from models.scene.loads import ConstantFriction, PinSpring, Spring

Wound = Mapping[str, Real]
"""Angle q of each spring in a pin that its own is within half a turn of [rad]."""
UNWOUND: Wound = {}
TAU = 2.0 * np.pi


class Machine:
    """Scene with one freedom, reduced to a coordinate: by default the driver's angle.

    Raises CrankcheckError for friction that follows from the reactions.
    """

    def __init__(self, scene: Scene, chart: Chart | None = None) -> None:
        if scene.coulomb_joints:
            raise CrankcheckError(
                f"{scene.name}: friction.{scene.coulomb_joints[0]} follows from the reaction of "
                "the joint, unknown before free motion is solved; give it a constant size"
            )
        self.scene = scene
        self.chart = chart or Chart(LimitedScene(scene, None), None)

    def inertia(self, u: Array) -> tuple[Array, Array]:
        """Return J and J' at coordinates (T,)."""
        return inertia_and_slope(self.scene, self.chart.unit(u))

    def push(self, time_s: Array, u: Array, v: Array, wound: Wound = UNWOUND) -> Array:
        """Return Q at times [s], coordinates and their rates, (T,)."""
        push = self._push(time_s, v, self.chart.unit(u), wound)
        return np.asarray(np.broadcast_to(push, u.shape))

    def acceleration(self, time_s: Array, u: Array, v: Array, wound: Wound = UNWOUND) -> Array:
        """Return u'' at times [s], coordinates and their rates, (T,)."""
        unit = self.chart.unit(u)
        inertia, slope = inertia_and_slope(self.scene, unit)
        push = self._push(time_s, v, unit, wound)
        return np.asarray((push - 0.5 * slope * v**2) / inertia)

    def _push(self, time_s: Array, v: Array, unit: Chunk, wound: Wound) -> Real:
        push = self._weights_and_loads(self.scene, time_s, v, unit)
        return push + self._springs(unit, v, wound) + self._friction(unit, v)

    def kinetic(self, u: Array, v: Array) -> Array:
        """Return the kinetic energy [J]."""
        return np.asarray(0.5 * self.inertia(u)[0] * v**2)

    def potential(self, u: Array, wound: Wound = UNWOUND) -> Array:
        """Return the energy of weights (over the ground's origin) and springs [J]."""
        scene, unit = self.scene, self.chart.unit(u)
        total = np.zeros_like(u)
        g_x, g_y = scene.gravity_m_s2
        for name, mass, centre in _weights(scene):
            place = unit.bodies[name].point(centre).p
            total = total - mass * (g_x * place.x + g_y * place.y)
        for spring, q, _ in self._lengths(unit, wound):
            total = total + 0.5 * spring.rate * (q - spring.free) ** 2
        return np.asarray(total)

    def power(self, time_s: Array, u: Array, v: Array) -> Array:
        """Return the power of loads, dampers and friction [W], which is not stored as energy."""
        unit = self.chart.unit(u)
        push = self._weights_and_loads(self._weightless, time_s, v, unit)
        for spring, _, rate in spring_lengths(self.scene, unit):
            push = push - spring.damping * rate**2 * v
        return np.asarray((push + self._friction(unit, v)) * v)

    def lengths(self, u: Array, wound: Wound = UNWOUND) -> dict[str, Array]:
        """Return q of the springs in pins, whole turns counted [rad]."""
        found = self._lengths(self.chart.unit(u), wound)
        return {one.name: q for one, q, _ in found if isinstance(one, PinSpring)}

    def rubbing(self, unit: Chunk) -> Iterator[tuple[float, Array]]:
        """Yield the friction in each joint [N or N m], and its rate per unit of that of u."""
        for joint, law in self.scene.friction.items():
            assert isinstance(law, ConstantFriction)
            if joint in self.scene.sliders:
                rate = unit.sliders[joint].speed
            else:
                one, other = (unit.bodies[body] for body in self._pairs[joint])
                rate = other.omega - one.omega
            yield law.size, np.broadcast_to(np.asarray(rate, dtype=np.float64), unit.theta.shape)

    @cached_property
    def _pairs(self) -> Mapping[str, tuple[str, ...]]:
        """The two bodies of each pin that rubs. Raises CrankcheckError where they are more."""
        pins = analyse(self.scene).pins
        for joint in self.scene.friction:
            if joint not in self.scene.sliders and len(pins.get(joint, ())) != 2:
                raise CrankcheckError(
                    f"{self.scene.name}: friction.{joint}: {len(pins.get(joint, ()))} bodies meet "
                    "there, and two rub on one another"
                )
        return pins

    @cached_property
    def _weightless(self) -> Scene:
        return replace(self.scene, gravity_m_s2=(0.0, 0.0))

    @cached_property
    def _heeds_rates(self) -> bool:
        """True if any load depends on a speed."""
        loads = self.scene.loads.values()
        return any(load.over in ("speed", "omega") or load.stroke != "both" for load in loads)

    def _moving(self, unit: Chunk, v: Array) -> Chunk:
        """Return the mechanism with the rates that loads need; all others stay per unit."""
        if not self._heeds_rates:
            return unit
        bodies, sliders = dict(unit.bodies), dict(unit.sliders)
        for load in self.scene.loads.values():
            if load.over == "omega" and (body := unit.bodies.get(load.body)):
                bodies[load.body] = replace(body, omega=body.omega * v)
            if load.slider is not None and (sliding := unit.sliders.get(load.slider)):
                sliders[load.slider] = replace(sliding, speed=sliding.speed * v)
        return replace(unit, bodies=bodies, sliders=sliders)

    def _weights_and_loads(self, scene: Scene, time_s: Array, v: Array, unit: Chunk) -> Real:
        chunk = self._moving(unit, v)
        bodies = loaded_bodies(scene, chunk, time_s)
        return -torque_by_power(bodies, unit, chunk).value

    def _lengths(self, unit: Chunk, wound: Wound) -> Iterator[tuple[Spring, Array, Array]]:
        """Yield the rows of `spring_lengths`, with the whole turns of springs in pins."""
        for spring, q, rate in spring_lengths(self.scene, unit):
            turns = np.round((wound[spring.name] - q) / TAU) if spring.name in wound else 0.0
            yield spring, q + TAU * turns, rate

    def _springs(self, unit: Chunk, v: Array, wound: Wound) -> Real:
        push: Real = 0.0
        for spring, q, rate in self._lengths(unit, wound):
            push = push - (spring.rate * (q - spring.free) + spring.damping * rate * v) * rate
        return push

    def _friction(self, unit: Chunk, v: Array) -> Real:
        push: Real = 0.0
        for size, rate in self.rubbing(unit):
            push = push - size * np.abs(rate) * np.sign(v)
        return push


def _weights(scene: Scene) -> Iterator[tuple[str, float, tuple[float, float]]]:
    """Yield every body with a mass, its mass [kg] and its centre."""
    for name, link in scene.links.items():
        if link.mass_kg > 0.0:
            yield name, link.mass_kg, link.centre_m
    for slider in scene.sliders.values():
        if slider.link is None and slider.mass_kg > 0.0:
            yield block_name(slider), slider.mass_kg, (0.0, 0.0)
