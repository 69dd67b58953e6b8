"""A driven mechanism with elastic links by coordinates that are independent of each other.

The driver's angle is prescribed, and the coefficients of the elastic links, z, are free; every
other coordinate follows from the joints, so that there are no multipliers::

    q = q(t, z)      q' = B z' + b phi'      q'' = B z'' + b phi'' + c

    B^T M B z'' = B^T (Q - M (b phi'' + c))

which is the principle of virtual power over all motions that the joints allow. It is independent of
the multibody form with multipliers but for the equations of the joints themselves. Source:
R. von Schwerin, MultiBody System SIMulation, chapter 2 (coordinate partitioning).
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from analytic.kinematics import solve
from analytic.multibody.assembly import Assembly
from analytic.multibody.bodies import Configuration, FlexibleBody
from analytic.multibody.generalised_forces import GeneralisedForces
from models.array import Array
from models.errors import CrankcheckError
from models.motion import Motion
from models.scene import GROUND
from models.scene.driver import Controlled
from models.scene.joints import block_name, sliding_angle
from models.scene.laws import Law

MOST_STEPS = 20
CLOSED = 1e-9
"""Step of Newton's method, over the longest link or in radians, after which none is taken: its
square is below rounding."""
STILL = 1e-13
"""The same for an equilibrium, over the largest deflection: the derivatives are differences."""
EARLY = 1e-3
"""Time between the deflections that the initial rates are taken from, over a turn."""
SMALL = 1e-6
"""Change of a deflection for derivatives, over the longest link."""


@dataclass(frozen=True)
class Instant:
    """Equations of motion at T samples: ``mass`` (T, m, m) and ``force`` (T, m), with which
    mass z'' = force; ``now`` is the configuration, ``by`` B (T, n, m), ``gained`` b phi'' + c."""

    now: Configuration
    by: Array
    gained: Array
    mass: Array
    force: Array

    @property
    def seconds(self) -> Array:
        """z'' (T, m)."""
        return np.asarray(np.linalg.solve(self.mass, self.force[:, :, None])[:, :, 0])

    def all_seconds(self, seconds: Array) -> Array:
        """Return q'' (T, n) with z'' (T, m)."""
        return np.asarray((self.by @ seconds[:, :, None])[:, :, 0] + self.gained)


class ReducedForm:
    """Equations of an assembly whose driver follows a law. Angles among the coefficients of its
    elastic links count as lengths, times the longest link."""

    def __init__(self, assembly: Assembly, forces: GeneralisedForces, law: Law) -> None:
        if isinstance(law, Controlled):
            raise CrankcheckError(
                f"{assembly.scene.name}: its driver is controlled, and gives way to elastic links; "
                'solve it by analytic.elastic.control, or take law = "constant"'
            )
        self.assembly, self.forces, self.law = assembly, forces, law
        self._driver = assembly.at[assembly.scene.driver.link] + 2
        rigid = {at + k for at in assembly.at.values() for k in range(3)}
        free = [i for i in range(assembly.size) if i not in rigid]
        self._free = np.array(free, dtype=int)
        self._rest = np.array(sorted(rigid - {self._driver}), dtype=int)
        # Size of an angle among the coefficients per metre: all count as lengths, so that a step of
        # 1e-4 longest links is as small for an angle as for a length, in mm and in km.
        self._sizes = assembly.units[self._free] / assembly.scene.longest_m
        if assembly.joints.count != len(self._rest):
            raise CrankcheckError(
                f"{assembly.scene.name}: {assembly.joints.count} equations of joints for "
                f"{len(self._rest)} coordinates: with a driven joint and elastic links the "
                "mobility has to be 1, and no joint redundant"
            )

    @property
    def size(self) -> int:
        """Number of coefficients, m."""
        return len(self._free)

    @property
    def period_s(self) -> float:
        """Period of a turn of the driver [s]."""
        return self.law.period_s

    def about_origin(self, z: Array) -> Array:
        """Return coordinates (T, n) with coefficients (T, m), and every frame at the origin."""
        q = np.zeros((len(z), self.assembly.size))
        q[:, self._free] = z * self._sizes
        return q

    def near(self, time_s: Array) -> Array:
        """Return the coordinates of the rigid mechanism at times [s], (T, n)."""
        assembly = self.assembly
        return coordinates(assembly, solve(assembly.scene, time_s, bound=False))

    def at(self, time_s: Array, z: Array, rates: Array, near: Array) -> Instant:
        """Return the equations at times (T,), for coefficients and their rates (T, m), from rough
        coordinates ``near`` (T, n). Raises CrankcheckError where the joints can not be closed."""
        phi, omega, alpha = self.law.at(time_s)
        q = self._closed(np.asarray(phi), z, near)
        rest = self.assembly.at_rest(q)
        jacobian = self.assembly.joints.jacobian(rest)
        told = np.concatenate([self._free, [self._driver]])
        count, n = q.shape
        by = np.zeros((count, n, len(told)))
        by[:, told, range(len(told))] = np.append(self._sizes, 1.0)
        by[:, self._rest] = -np.linalg.solve(
            jacobian[:, :, self._rest], jacobian[:, :, told] * np.append(self._sizes, 1.0)
        )
        q_rates = (by @ np.column_stack([rates, omega])[:, :, None])[:, :, 0]
        now = self.assembly.at_rates(q, q_rates)
        gained = by[:, :, -1] * np.asarray(alpha)[:, None]
        gamma = self.assembly.joints.gamma(now)[:, :, None]
        gained[:, self._rest] += np.linalg.solve(jacobian[:, :, self._rest], gamma)[:, :, 0]
        mass, right = self.assembly.weigh(now.q, now.rates)
        right += self.forces.on(time_s, now)
        right -= (mass @ gained[:, :, None])[:, :, 0]
        own = by[:, :, :-1]
        turned = np.swapaxes(own, 1, 2)
        return Instant(now, own, gained, turned @ mass @ own, (turned @ right[:, :, None])[:, :, 0])

    def _closed(self, phi: Array, z: Array, near: Array) -> Array:
        """Return the coordinates with given driver angles and coefficients, by Newton's method."""
        q = near.copy()
        q[:, self._driver], q[:, self._free] = phi, z * self._sizes
        units, size = self.assembly.units[self._rest], np.inf
        for _ in range(MOST_STEPS):
            now = self.assembly.at_rest(q)
            jacobian = self.assembly.joints.jacobian(now)[:, :, self._rest]
            gaps = self.assembly.joints.gaps(now)
            try:
                step = np.linalg.solve(jacobian, -gaps[:, :, None])[:, :, 0]
            except np.linalg.LinAlgError:
                break  # a dead point
            q[:, self._rest] += step
            last, size = size, float(np.abs(step / units).max())
            if size <= CLOSED or (size < 1e-8 and size >= 0.5 * last):
                return q
        raise CrankcheckError(
            f"{self.assembly.scene.name}: the joints can not be closed: the elastic links have "
            "bent or stretched too far"
        )

    def reactions(self, time_s: Array, now: Instant, seconds: Array) -> tuple[Array, Array]:
        """Return the multipliers (T, m) and the torque on the driver (T,) for given second
        derivatives of the coefficients."""
        q, rates = now.now.q, now.now.rates
        mass, right = self.assembly.weigh(q, rates)
        right += self.forces.on(time_s, now.now)
        right -= (mass @ now.all_seconds(seconds)[:, :, None])[:, :, 0]
        jacobian = self.assembly.joints.jacobian(now.now)
        across = np.swapaxes(jacobian[:, :, self._rest], 1, 2)
        multipliers = np.linalg.solve(across, right[:, self._rest, None])[:, :, 0]
        torque = (jacobian[:, :, self._driver] * multipliers).sum(axis=1) - right[:, self._driver]
        return np.asarray(multipliers), np.asarray(torque)

    @cached_property
    def stiffness(self) -> Array:
        """Stiffness matrix of the elastic links, (m, m)."""
        return self._of_links(lambda body: body.stiffness)

    @cached_property
    def damping(self) -> Array:
        """Damping matrix of the elastic links, (m, m)."""
        return self._of_links(lambda body: body.damping)

    def _of_links(self, matrix: Callable[[FlexibleBody], Array]) -> Array:
        whole = np.zeros((self.assembly.size, self.assembly.size))
        for body, own in self.assembly.elastic.values():
            at = slice(own.start + 3, own.stop)
            whole[at, at] = matrix(body)
        sizes = np.outer(self._sizes, self._sizes)
        return np.asarray(whole[np.ix_(self._free, self._free)] * sizes)


def quasi_static(form: ReducedForm, time_s: float) -> Array:
    """Return the coefficients (m,) with which the elastic links are in equilibrium at an instant,
    as if their own vibration had no inertia.

    Raises
    ------
    CrankcheckError
        Links that give way: they are pushed harder than they bear.
    """
    m, unit = form.size, form.assembly.scene.longest_m
    times, tried = np.full(m + 1, time_s), SMALL * unit * np.eye(m + 1, m, -1)
    near, z, last = form.near(times), np.zeros(m), np.inf
    for _ in range(MOST_STEPS):
        force = form.at(times, z + tried, np.zeros_like(tried), near).force
        step = np.linalg.solve((force[0] - force[1:]).T / (SMALL * unit), force[0])
        z, size = z + step, float(np.abs(step).max())
        largest = float(np.abs(z).max()) or 1.0
        if size <= STILL * largest or (size < 1e-9 * largest and size >= 0.5 * last):
            return np.asarray(z)
        last = size
    raise CrankcheckError(
        f"{form.assembly.scene.name}: at {time_s:g} s its elastic links have no equilibrium under "
        "their loads; make them stiffer, or drive slower"
    )


def quasi_static_start(form: ReducedForm) -> tuple[Array, Array]:
    """Return the quasi-static coefficients at time 0 and their rates, (m,): by one-sided
    differences of order 4, as there may be no time before."""
    apart_s = EARLY * form.period_s
    still = [quasi_static(form, k * apart_s) for k in range(5)]
    weights = np.array([-25.0, 48.0, -36.0, 16.0, -3.0]) / (12.0 * apart_s)
    return still[0], np.asarray(weights @ np.array(still))


def coordinates(assembly: Assembly, motion: Motion) -> Array:
    """Return the coordinates (T, n) of an assembly at the links' positions in a motion; 0 for all
    coefficients."""
    scene = assembly.scene
    q = np.zeros((len(motion.time_s), assembly.size))
    for name, link in scene.links.items():
        at, theta = assembly.at[name], motion.links[name].theta
        point, (x, y) = next(iter(link.points.items()))
        place, c, s = motion.points[point].position, np.cos(theta), np.sin(theta)
        q[:, at] = place[:, 0] - c * x + s * y
        q[:, at + 1] = place[:, 1] - s * x - c * y
        q[:, at + 2] = theta
    for slider in scene.sliders.values():
        if slider.link is None:
            at = assembly.at[block_name(slider)]
            guide = 0.0 if slider.on == GROUND else motion.links[slider.on].theta
            q[:, at : at + 2] = motion.points[slider.point].position
            q[:, at + 2] = guide + sliding_angle(slider)
    return q
