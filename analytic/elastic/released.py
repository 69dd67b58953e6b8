"""Free motion of a mechanism with elastic links, with all their vibration.

It has as many coordinates as freedoms, integrated by collocation. The equations with a multiplier
for every joint and an explicit method (`analytic.multibody.release_multibody`) are another way to
the same motion.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from analytic.elastic import discretisation
from analytic.elastic.discretisation import Discretisation, ElasticDoubt, Modes, Segments
from analytic.elastic.free_windows import FreeWindow, by_collocation, check_smooth
from analytic.elastic.tangent_form import FreeInstant, TangentForm
from analytic.kinematics import solve
from analytic.multibody.as_motion import as_motion
from analytic.multibody.assembly import Assembly
from analytic.multibody.bodies import Configuration, EnergyBalance
from analytic.multibody.dynamics import Dynamics, joint_forces
from analytic.multibody.generalised_forces import GeneralisedForces
from analytic.multibody.release_multibody import Acting, ready
from models.array import Array, samples
from models.errors import StructureError
from models.motion import Motion, State
from models.scene import Scene
from models.scene.driver import check_duration, check_within

WindowInstants = tuple[Array, FreeWindow, FreeInstant, Array]
"""Times (T,), their window, the equations and the work until then."""
TOLERANCE = 1e-11
WITH_AXIAL = 1e-10
"""The tolerance where links stretch: they ring along themselves a thousand times faster than
across, by 1e-10 m or less, which may die out; 1e-11 would follow it, in ten times the time."""
ENOUGH, ROUGH = 1e-9, 1e-7
"""The tolerances of references for engines. A chain takes the first: in a second of the shipped
pulse it is within 5e-10 of the deflection and 1e-12 rad of the motion at 1e-11, in a third of its
time. A beam takes the second, as chains come no nearer than some 1e-4 of the deflection: its error
is 1e-6 of it, in a sixth of the time."""
COARSER = 100.0
"""Ratio of the tolerance of the compared, coarser motion to that of this one."""


@dataclass(frozen=True, eq=False)
class ReleasedElasticMotion:
    """Free motion of a scene with elastic links from its release at time 0 to ``until_s``."""

    scene: Scene
    until_s: float
    by: Discretisation
    stiffened: bool
    tolerance: float
    acting: Acting = GeneralisedForces

    @cached_property
    def _ready(self) -> tuple[Dynamics, Array, Array]:
        flexible = discretisation.flexible_links(self.scene, self.by, stiffened=self.stiffened)
        return ready(self.scene, assembled(self.scene), flexible, self.acting)

    @property
    def dynamics(self) -> Dynamics:
        """Equations of motion. Raises CrankcheckError as `release_elastic`."""
        return self._ready[0]

    @property
    def start(self) -> tuple[Array, Array]:
        """Coordinates and rates (n,) at time 0."""
        return self._ready[1], self._ready[2]

    @property
    def begun(self) -> tuple[Configuration, Array]:
        """The configuration at time 0, and the second derivatives of all coordinates (1, n)."""
        q, rates = self.start
        tangent = self.form.tangent(q)
        own = self.form.coordinates(tangent, rates)[None]
        first = self.form.at(np.zeros(1), tangent, np.zeros_like(own), own)
        return first.now, first.all_seconds

    @cached_property
    def form(self) -> TangentForm:
        """Equations in coordinates that are independent of each other."""
        return TangentForm(self.dynamics)

    @cached_property
    def windows(self) -> tuple[FreeWindow, ...]:
        """The motion, one window after the other."""
        return by_collocation(self.form, *self.start, self.until_s, self.tolerance)

    def at(self, time_s: Array) -> Motion:
        """Return the motion at times [s], (T,) in ascending order, with its reactions and shapes.
        Raises CrankcheckError for times beyond it."""
        return self._motion(self._instants(time_s))

    def outside(self, time_s: Array) -> Motion:
        """Return the motion that leads to the start, at times below 0 [s], (T,), or that goes on
        from the end, at times above ``until_s``: within a step of it, where some engines have the
        velocities of their first or last sample."""
        return self._motion([self._in_window(0 if time_s[-1] < 0.0 else -1, time_s)])

    def _motion(self, instants: Iterable[WindowInstants]) -> Motion:
        assembly, parts = self.assembly, []
        for some, window, instant, _ in instants:
            motion = as_motion(assembly, some, instant.now, instant.all_seconds)
            multipliers = self.form.multipliers(window.tangent, instant)
            driving = self.dynamics.forces.driving(some, instant.now)
            forces = joint_forces(assembly, some, -multipliers, driving)
            parts.append(replace(motion, forces=forces))
        return Motion.joined(parts)

    @property
    def assembly(self) -> Assembly:
        """Its bodies and joints."""
        return self.dynamics.assembly

    def coordinates_at(self, time_s: Array) -> Array:
        """Return the coordinates of the assembly at times [s], (T,) in ascending order, (T, n)."""
        return np.concatenate([instant.now.q for _, _, instant, _ in self._instants(time_s)])

    def energy(self, time_s: Array) -> EnergyBalance:
        """Return the energies at times [s], (T,) ascending: `EnergyBalance.balance` stays."""
        parts = [
            self.dynamics.energies(instant.now, work)
            for _, _, instant, work in self._instants(time_s)
        ]
        return EnergyBalance.joined(parts)

    @cached_property
    def finer(self) -> ReleasedElasticMotion:
        """The motion of the next finer description; `Segments` have none."""
        return self if isinstance(self.by, Segments) else replace(self, by=self.by.finer)

    @cached_property
    def coarser(self) -> ReleasedElasticMotion:
        """The motion integrated to a larger tolerance."""
        return replace(self, tolerance=COARSER * self.tolerance)

    def doubt(self, time_s: Array) -> ElasticDoubt:
        """Return the error estimate up to times [s], (T,) in ascending order: distance from the
        motion of the next finer shapes, and from one integrated to a larger tolerance."""
        own = self.at(time_s)
        return ElasticDoubt.between(own, self.finer.at(time_s), self.coarser.at(time_s)).so_far

    def _instants(self, time_s: Array) -> Iterator[WindowInstants]:
        instants = samples(time_s, "time_s")
        check_within(self.scene, instants, self.until_s)
        ends = np.array([window.end_s for window in self.windows[:-1]])
        number = np.searchsorted(ends, instants, side="right")
        for k in np.unique(number):
            yield self._in_window(int(k), instants[number == k])

    def _in_window(self, number: int, time_s: Array) -> WindowInstants:
        window = self.windows[number]
        y, rates, work = window.course(time_s)
        return time_s, window, self.form.at(time_s, window.tangent, y, rates), work


def release_elastic(
    scene: Scene,
    until_s: float,
    by: Discretisation | None = None,
    *,
    stiffened: bool = True,
    tolerance: float | None = None,
    acting: Acting = GeneralisedForces,
) -> ReleasedElasticMotion:
    """Prepare the free motion of a scene with elastic links from its start.

    Parameters
    ----------
    scene : Scene
        A mechanism of any mobility. A driver that follows a law is released at time 0 of it.
        ``start.shape`` is the shape of its elastic links, quasi-static by default.
    until_s : float
        Duration [s].
    by : Discretisation or None
        Description of its elastic links; None for `Modes`.
    stiffened : bool
        Keep the shortening of bent links; the thesis leaves it out.
    tolerance : float or None
        Tolerance of a window, over the longest link or in radians; None for 1e-11, or 1e-10 with
        links that stretch.
    acting : Acting
        Maker of the forces on an assembly at its start (n,).

    Raises
    ------
    CrankcheckError
        As `release_multibody`; loads with kinks over the state, which collocation does not take.
    """
    check_duration(scene.name, until_s)
    if tolerance is None:
        axial = any(link.stretches for link in scene.elastic.values())
        tolerance = WITH_AXIAL if axial else TOLERANCE
    by = by or Modes()
    motion = ReleasedElasticMotion(scene, float(until_s), by, stiffened, tolerance, acting)
    check_smooth(motion.form)
    return motion


def assembled(scene: Scene) -> State | None:
    """Return the start of the rigid mechanism of a scene, if it has a closed form."""
    try:
        return solve(scene, np.zeros(1), bound=False).state()
    except StructureError:
        return None
