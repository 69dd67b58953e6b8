"""Free motion of a chain of windows, in closed form: the truth of `models.scene.hard`.

While all rockers turn together, theta being their angle and l, m length and mass of a rod, the
N + 1 rockers have the kinetic energy (N + 1) m l^2 theta'^2 / 6, and the N couplers, which only
shift, N m l^2 theta'^2 / 2; the heights are l sin(theta) / 2 and l sin(theta). With

    M = (N + 1) / 3 + N        P = (N + 1) / 2 + N

    E = m l^2 M theta'^2 / 2 + m g l P sin(theta)        l M theta'' = -g P cos(theta)

Started upright with speed, the chain turns over and over. With the angle phi turned since then and
kappa = g P / (l M), energy gives phi'^2 = w0^2 + 4 kappa sin(phi / 2)^2, the equation of Jacobi's
amplitude: phi = pi + 2 am(W t / 2 - K | m), W^2 = w0^2 + 4 kappa, m = 4 kappa / W^2. Source of the
amplitude by arithmetic-geometric means: Abramowitz and Stegun, 16.4 and 17.6.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from models.array import Array, samples
from models.motion import LinkMotion, Motion, PointMotion
from models.scene.hard import UPRIGHT, Chain


@dataclass(frozen=True)
class Amplitude:
    """Jacobi's amplitude am(u | m) for a complementary parameter ``rest`` = 1 - m in (0, 1].

    Good to a few roundings of u; near rest = 0 as well, as that is what is given.
    """

    rest: float

    def _means(self) -> tuple[list[float], list[float]]:
        """The arithmetic means a and the half differences c of the sequence."""
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
        """am(u), shape of u."""
        a, c = self._means()
        halves = np.round(u / (2.0 * self.quarter))
        angle = 2.0 ** (len(a) - 1) * a[-1] * (u - 2.0 * self.quarter * halves)
        for mean, half in zip(a[:0:-1], c[:0:-1], strict=True):
            angle = (angle + np.arcsin(half / mean * np.sin(angle))) / 2.0
        found: Array = angle + math.pi * halves
        return found


@dataclass(frozen=True)
class ChainMotion:
    """The turning of all rockers of a chain that is left free at time 0."""

    chain: Chain

    @property
    def inertia(self) -> float:
        """M: what the rods weigh against turning, in rods that move with B0."""
        return (self.chain.count + 1) / 3 + self.chain.count

    @property
    def weight(self) -> float:
        """P: what the rods weigh, in rods that are lifted with B0."""
        return (self.chain.count + 1) / 2 + self.chain.count

    @property
    def stiffness(self) -> float:
        """kappa = g P / (l M) [1/s^2]."""
        return self.chain.gravity_m_s2 * self.weight / (self.chain.length_m * self.inertia)

    @property
    def fastest_rad_s(self) -> float:
        """The angular velocity hanging down, without its sign."""
        return math.sqrt(self.chain.start_rad_s**2 + 4.0 * self.stiffness)

    @property
    def period_s(self) -> float:
        """The time of one turn."""
        return 4.0 * self._amplitude.quarter / self.fastest_rad_s

    @property
    def _amplitude(self) -> Amplitude:
        return Amplitude((self.chain.start_rad_s / self.fastest_rad_s) ** 2)

    def at(self, time_s: Array) -> tuple[Array, Array, Array]:
        """theta [rad], omega [rad/s], alpha [rad/s^2] of the rockers, shape of time.

        Good to a few roundings of the angle turned, at which the upright position is passed again
        after each `period_s`.
        """
        amplitude, sign = self._amplitude, math.copysign(1.0, self.chain.start_rad_s)
        half = amplitude.at(0.5 * self.fastest_rad_s * time_s - amplitude.quarter)
        lean = np.sin(half + math.pi / 2)
        omega = np.sqrt(self.chain.start_rad_s**2 + 4.0 * self.stiffness * lean**2)
        phi = math.pi + 2.0 * half
        return UPRIGHT + sign * phi, sign * omega, sign * self.stiffness * np.sin(phi)

    def energy(self, theta: Array, omega: Array) -> Array:
        """Kinetic and potential energy of all rods [J]; heights count from the ground line."""
        chain = self.chain
        moving = 0.5 * chain.mass_kg * chain.length_m**2 * self.inertia * omega**2
        return moving + 0.5 * self.exchanged_j * np.sin(theta)

    @property
    def exchanged_j(self) -> float:
        """The energy that goes back and forth between height and motion, 2 m g l P [J]."""
        chain = self.chain
        return 2.0 * chain.mass_kg * chain.gravity_m_s2 * chain.length_m * self.weight

    def motion(self, time_s: Array) -> Motion:
        """The motion of all rods and pins at times [s], (T,). Raises CrankcheckError for times that
        are no numbers."""
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
