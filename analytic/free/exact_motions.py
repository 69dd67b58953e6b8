"""Hard free motions in closed form: a chain of windows, and a four-bar thrown at its toggle."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from analytic.free.chart import Chart, LimitedScene
from analytic.free.free_motion import LimitPassage
from analytic.free.machine import Machine
from analytic.kinematics import solve_driven
from models.array import Array, samples
from models.errors import CrankcheckError
from models.motion import LinkMotion, Motion, PointMotion, State
from models.scene import Scene
from models.scene.driver import Released
from models.scene.hard import UPRIGHT, WindowChain


@dataclass(frozen=True)
class Amplitude:
    """Jacobi's amplitude am(u | m) for a complementary parameter ``rest`` = 1 - m in (0, 1].

    Good to a few roundings of u; near rest = 0 as well, as ``rest`` itself is given.
    """

    rest: float

    def _means(self) -> tuple[list[float], list[float]]:
        """Return the arithmetic means a and the half differences c of the sequence."""
        a, b = [1.0], math.sqrt(self.rest)
        c = [math.sqrt(max(1.0 - self.rest, 0.0))]
        while c[-1] > 1e-8 * a[-1]:  # the next one would be of the order of its square
            c.append((a[-1] - b) / 2.0)
            b, mean = math.sqrt(a[-1] * b), (a[-1] + b) / 2.0
            a.append(mean)
        return a, c

    @property
    def quarter(self) -> float:
        """K, the complete integral: am(K) is a right angle."""
        return math.pi / (2.0 * self._means()[0][-1])

    def at(self, u: Array) -> Array:
        """Return am(u), shape of u."""
        a, c = self._means()
        halves = np.round(u / (2.0 * self.quarter))
        angle = 2.0 ** (len(a) - 1) * a[-1] * (u - 2.0 * self.quarter * halves)
        for mean, half in zip(a[:0:-1], c[:0:-1], strict=True):
            angle = (angle + np.arcsin(half / mean * np.sin(angle))) / 2.0
        found: Array = angle + math.pi * halves
        return found


@dataclass(frozen=True)
class ChainMotion:
    """Rotation of all rockers of a chain that is released at time 0."""

    chain: WindowChain

    @property
    def inertia(self) -> float:
        """M: inertia of the rods against turning, in rods that move with B0."""
        return (self.chain.count + 1) / 3 + self.chain.count

    @property
    def weight(self) -> float:
        """P: weight of the rods, in rods that are lifted with B0."""
        return (self.chain.count + 1) / 2 + self.chain.count

    @property
    def stiffness(self) -> float:
        """kappa = g P / (l M) [1/s^2]."""
        return self.chain.gravity_m_s2 * self.weight / (self.chain.length_m * self.inertia)

    @property
    def fastest_rad_s(self) -> float:
        """Largest angular velocity, hanging down, without its sign."""
        return math.sqrt(self.chain.start_rad_s**2 + 4.0 * self.stiffness)

    @property
    def period_s(self) -> float:
        """Time of one turn."""
        return 4.0 * self._amplitude.quarter / self.fastest_rad_s

    @property
    def _amplitude(self) -> Amplitude:
        return Amplitude((self.chain.start_rad_s / self.fastest_rad_s) ** 2)

    def at(self, time_s: Array) -> tuple[Array, Array, Array]:
        """Return theta [rad], omega [rad/s], alpha [rad/s^2] of the rockers, shape of time.

        Good to a few roundings of the angle turned; the upright position is passed again after each
        `period_s`.
        """
        amplitude, sign = self._amplitude, math.copysign(1.0, self.chain.start_rad_s)
        half = amplitude.at(0.5 * self.fastest_rad_s * time_s - amplitude.quarter)
        lean = np.sin(half + math.pi / 2)
        omega = np.sqrt(self.chain.start_rad_s**2 + 4.0 * self.stiffness * lean**2)
        phi = math.pi + 2.0 * half
        return UPRIGHT + sign * phi, sign * omega, sign * self.stiffness * np.sin(phi)

    def energy(self, theta: Array, omega: Array) -> Array:
        """Return kinetic plus potential energy of all rods [J]; heights from the ground line."""
        chain = self.chain
        moving = 0.5 * chain.mass_kg * chain.length_m**2 * self.inertia * omega**2
        return moving + 0.5 * self.exchanged_j * np.sin(theta)

    @property
    def exchanged_j(self) -> float:
        """Energy exchanged between height and motion, 2 m g l P [J]."""
        chain = self.chain
        return 2.0 * chain.mass_kg * chain.gravity_m_s2 * chain.length_m * self.weight

    def motion(self, time_s: Array) -> Motion:
        """Return the motion of all rods and pins at times [s], (T,). Raises CrankcheckError for
        times that are no numbers."""
        time_s = samples(time_s, "time_s")
        theta, omega, alpha = self.at(time_s)
        rest = np.zeros_like(theta)
        turning, shifting = LinkMotion(theta, omega, alpha), LinkMotion(rest, rest, rest)
        arm = self.chain.length_m * np.stack([np.cos(theta), np.sin(theta)], axis=-1)
        across = np.stack([-arm[:, 1], arm[:, 0]], axis=-1)
        w, g = omega[:, None], alpha[:, None]
        still, points = np.zeros_like(arm), {}
        for i in range(self.chain.count + 1):
            foot = np.array([i * self.chain.length_m, 0.0])
            points[f"A{i}"] = PointMotion(still + foot, still, still)
            points[f"B{i}"] = PointMotion(foot + arm, w * across, g * across - w**2 * arm)
        rods = dict.fromkeys(self.chain.rockers(), turning)
        return Motion(time_s, rods | dict.fromkeys(self.chain.couplers(), shifting), points, {})


GRAVITY_M_S2 = 9.81
REACH = 0.25
"""Distance of the start from the limit, over the driver's range."""
BEYOND = 0.8
"""Distance beyond the toggle over which V has to fall, over that of the start before it."""
LOOKS = 101


@dataclass(frozen=True, eq=False)
class ToggleBarrier:
    """Potential barrier of a four-bar about the limit of its driver.

    ``scene`` has gravity as above and stands at the start ``u``; ``barrier_j`` is the rise of V
    from there to the toggle [J], and ``growth_per_s`` the rate at which the motion leaves the top
    [1/s]. ``open_rad`` is the angle of the rocker against the coupler at the start, less that in
    the toggle; at -u it is as much to the other side.
    """

    scene: Scene
    machine: Machine
    u: float
    barrier_j: float
    growth_per_s: float
    open_rad: float

    @staticmethod
    def of(scene: Scene) -> ToggleBarrier:
        """Compute the barrier at the upper limit of a scene's driver, in the assembly of the scene.

        Raises CrankcheckError where the driver has no limit, or V does not rise all the way to the
        toggle and fall beyond it.
        """
        law = scene.driver.law
        start = float(law.at(np.zeros(1))[0][0])
        free = _started(scene, Released(start, 0.0, 1.0))
        arc = LimitedScene.of(free, start)
        if arc.limits is None:
            raise CrankcheckError(f"{scene.name}: its driver turns fully, and has no toggle")
        limit = arc.limits[1]
        u = math.sqrt(REACH * arc.length_rad)
        chart = Chart(arc, limit)
        weighed = replace(free, gravity_m_s2=_upwards(free, chart, u))
        machine = Machine(weighed, chart)
        way = np.linspace(u, -BEYOND * u, LOOKS)
        height = machine.potential(way)
        top = float(machine.potential(np.zeros(1))[0])
        rising = np.diff(np.where(way > 0.0, height, 2.0 * top - height))
        if not np.all(rising > 0.0):
            raise CrankcheckError(f"{scene.name}: its potential has no single top about its toggle")
        step = 1e-3 * u
        slope = machine.acceleration(np.zeros(2), np.array([step, -step]), np.zeros(2))
        rate = math.sqrt(float(slope[0] - slope[1]) / (2.0 * step))
        there = Released(limit.driver_rad - limit.side * u * u, 0.0, 1.0)
        rises = top - float(height[0])
        opens = _opening(weighed, chart, u)
        return ToggleBarrier(_started(weighed, there), machine, u, rises, rate, opens)

    @property
    def links(self) -> tuple[str, str]:
        """The two links that are in line in the toggle."""
        return _others(self.scene)

    def thrown(self, margin: float) -> Scene:
        """Return the scene that starts with ``1 + margin`` of the barrier as its kinetic energy; it
        gets over for a margin above 0. Raises CrankcheckError for 0 or at most -1."""
        if not margin > -1.0 or margin == 0.0:
            raise CrankcheckError(
                f"{self.scene.name}: margin {margin:g}: give one above -1, and not 0"
            )
        _, omega, _ = self._driver(margin)
        law = self.scene.driver.law
        assert isinstance(law, Released)
        return _started(
            self.scene, replace(law, speed_rad_s=omega, duration_s=self.lasts_s(margin))
        )

    def start(self, margin: float) -> State:
        """Return the state at time 0, with the accelerations that the weights give."""
        theta, omega, alpha = (np.array([one]) for one in self._driver(margin))
        return solve_driven(self.scene, theta, omega, alpha, np.zeros(1), bound=False).state()

    def lasts_s(self, margin: float) -> float:
        """Return twice the time to the decision [s]: up and down at the rate of the top."""
        return (2.0 * math.log(4.0 / abs(margin)) + 8.0) / self.growth_per_s

    def is_toggle(self, passage: LimitPassage) -> bool:
        """True if a passage of a motion goes through the toggle, not the other limit."""
        limit = self.machine.chart.limit
        assert limit is not None
        return math.isclose(passage.driver_rad, limit.driver_rad, abs_tol=1e-6)

    def _driver(self, margin: float) -> tuple[float, float, float]:
        """Return angle, rate and acceleration of the driver at the start."""
        u = np.array([self.u])
        inertia, _ = self.machine.inertia(u)
        v = -np.sqrt(2.0 * (1.0 + margin) * self.barrier_j / inertia)
        a = self.machine.acceleration(np.zeros(1), u, v)
        phi, slope, bend = self.machine.chart.driver(u)
        return float(phi[0]), float((slope * v)[0]), float((bend * v**2 + slope * a)[0])


def _started(scene: Scene, law: Released) -> Scene:
    return replace(scene, driver=replace(scene.driver, law=law))


def _others(scene: Scene) -> tuple[str, str]:
    one, other = (name for name in scene.links if name != scene.driver.link)
    return one, other


def _opening(scene: Scene, chart: Chart, u: float) -> float:
    """Return the rotation of the second free link against the first from the toggle to u [rad].

    Raises CrankcheckError where it turns to and fro.
    """
    one, other = _others(scene)
    way = np.linspace(0.0, u, LOOKS)
    bodies = chart.unit(way).bodies
    rate = np.asarray(bodies[other].omega - bodies[one].omega)  # per unit of u
    if not (np.all(rate > 0.0) or np.all(rate < 0.0)):
        raise CrankcheckError(f"{scene.name}: {one} and {other} do not close steadily on the way")
    return float(np.trapezoid(rate, way))


def _upwards(scene: Scene, chart: Chart, u: float) -> tuple[float, float]:
    """Return the gravity [m/s^2] in which the toggle is higher than its neighbours and level."""
    rate, below = [], []
    for unit in ((1.0, 0.0), (0.0, 1.0)):
        machine = Machine(replace(scene, gravity_m_s2=unit), chart)
        zero: Array = np.zeros(1)
        rate.append(float(machine.push(zero, zero, zero)[0]))
        heights = machine.potential(np.array([0.0, u]))
        below.append(float(heights[0] - heights[1]))
    # Across the common centre's velocity in the toggle, gravity does no work there.
    across = np.array([-rate[1], rate[0]]) / math.hypot(*rate)
    g = GRAVITY_M_S2 * math.copysign(1.0, float(across @ np.array(below))) * across
    return float(g[0]), float(g[1])
