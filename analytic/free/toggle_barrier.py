"""A four-bar whose toggle lies on top of a hill of its potential energy, and that is thrown at it.

::

    V |        _              u > 0: the assembly that it starts in; u = 0: coupler and rocker in
      |      /   \\            line; u < 0: the other assembly. Gravity points to where the
      |    /       \\          weights neither rise nor fall in u = 0, and are highest there.
      +--|-----|-----|-- -u
        start  toggle

One freedom and no loss: it gets over if it starts with more than the difference of V, and falls
back if with less, whatever else it does on the way.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from analytic.free.chart import Arc, Chart
from analytic.free.free_motion import LimitPassage
from analytic.free.machine import Machine
from analytic.kinematics import solve_driven
from models.array import Array
from models.errors import CrankcheckError
from models.motion import State
from models.scene import Scene
from models.scene.driver import Released

GRAVITY_M_S2 = 9.81
REACH = 0.25
"""The share of the driver's range that it starts before its limit."""
BEYOND = 0.8
"""How far beyond the toggle V has to fall, over how far before it the start is."""
LOOKS = 101


@dataclass(frozen=True, eq=False)
class ToggleBarrier:
    """The hill of a four-bar about the limit of its driver.

    ``scene`` has gravity as above and stands at the start ``u``; ``barrier_j`` is by how much V
    rises from there to the toggle [J], and ``growth_per_s`` the rate at which the motion leaves the
    top [1/s]. ``open_rad`` is the angle of the rocker against the coupler at the start, less that
    in the toggle; at -u it is as much to the other side.
    """

    scene: Scene
    machine: Machine
    u: float
    barrier_j: float
    growth_per_s: float
    open_rad: float

    @staticmethod
    def of(scene: Scene) -> ToggleBarrier:
        """The hill at the upper limit of a scene's driver, in the assembly of the scene.

        Raises CrankcheckError where the driver has no limit, or V does not rise all the way to the
        toggle and fall beyond it.
        """
        law = scene.driver.law
        start = float(law.at(np.zeros(1))[0][0])
        free = _started(scene, Released(start, 0.0, 1.0))
        arc = Arc.of(free, start)
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
        """The two that are in line in the toggle."""
        return _others(self.scene)

    def thrown(self, margin: float) -> Scene:
        """The scene that starts with ``1 + margin`` of the barrier as its kinetic energy; it gets
        over where the margin is above 0. Raises CrankcheckError for a margin of 0 or at most -1."""
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
        """The state at time 0, with the accelerations that the weights give."""
        theta, omega, alpha = (np.array([one]) for one in self._driver(margin))
        return solve_driven(self.scene, theta, omega, alpha, np.zeros(1), bound=False).state()

    def lasts_s(self, margin: float) -> float:
        """By when it has been decided, twice over [s]: up and down at the rate of the top."""
        return (2.0 * math.log(4.0 / abs(margin)) + 8.0) / self.growth_per_s

    def is_toggle(self, passage: LimitPassage) -> bool:
        """Whether a passage of a motion is one through the toggle, and not the other limit."""
        limit = self.machine.chart.limit
        assert limit is not None
        return math.isclose(passage.driver_rad, limit.driver_rad, abs_tol=1e-6)

    def _driver(self, margin: float) -> tuple[float, float, float]:
        """Angle, rate and acceleration of the driver at the start."""
        u = np.array([self.u])
        inertia, _ = self.machine.inertia(u)
        v = -np.sqrt(2.0 * (1.0 + margin) * self.barrier_j / inertia)
        a = self.machine.acceleration(np.zeros(1), u, v)
        phi, slope, bend = self.machine.chart.driver(u)
        return float(phi[0]), float((slope * v)[0]), float((bend * v**2 + slope * a)[0])


def _started(scene: Scene, law: Released) -> Scene:
    return replace(scene, driver=replace(scene.driver, law=law))


def _others(scene: Scene) -> tuple[str, str]:
    """The links of a four-bar that are not its driver."""
    one, other = (name for name in scene.links if name != scene.driver.link)
    return one, other


def _opening(scene: Scene, chart: Chart, u: float) -> float:
    """By how much the second free link turns against the first from the toggle to u [rad].

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
    """The gravity [m/s^2] in which the toggle is higher than its neighbours and level."""
    rate, below = [], []
    for unit in ((1.0, 0.0), (0.0, 1.0)):
        machine = Machine(replace(scene, gravity_m_s2=unit), chart)
        zero: Array = np.zeros(1)
        rate.append(float(machine.push(zero, zero, zero)[0]))
        heights = machine.potential(np.array([0.0, u]))
        below.append(float(heights[0] - heights[1]))
    # Across the way that the common centre of mass has in the toggle, it does no work there.
    across = np.array([-rate[1], rate[0]]) / math.hypot(*rate)
    g = GRAVITY_M_S2 * math.copysign(1.0, float(across @ np.array(below))) * across
    return float(g[0]), float(g[1])
