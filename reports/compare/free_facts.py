"""Facts of a free run beside its errors."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from models.array import Array
from models.motion import Motion
from models.scene import GROUND, Scene
from reports.compare.errors import Error, Errors, MotionFacts
from reports.compare.free_truth import FreeBeside
from reports.quantities import named
from reports.quantities.free_and_elastic import ENERGY, MOMENTUM
from reports.quantities.limits import FREE
from reports.quantities.quantity import Quantity, Tolerance

MOST_GROWTH = 1e3
"""Sensitivity of free motion from which on errors of phase cancel and add up at random, and show no
order."""
FREE_MOTION = (
    "Free motion: largest errors at the same time over the sensitivity, the growth of a small "
    "change of the start; geometry at the logged angle of the driver; L longest link, w "
    "driver's peak speed."
)
OVER_G = (
    "free motion: angles, places and rates are over G, the growth of a small change of the start"
)


@dataclass(frozen=True, kw_only=True, eq=False)
class FreeFacts(MotionFacts):
    """Judged length of a free run, and the divisor of its errors.

    ``sensitivity`` is the growth of a small change of the start until ``until_s``, the last judged
    instant; ``left_out`` samples after it are not judged, as the reference is too uncertain there.
    ``time_s``, ``raw`` and ``judged`` are the largest error of phase and position up to some
    instants, as pure numbers: unscaled, and over the sensitivity of its time.
    """

    limits: ClassVar[Mapping[str, Tolerance]] = FREE
    closing: ClassVar[Sequence[str]] = ("phase", "geometry", *named("place", "closure"))
    cancels: ClassVar[bool] = True
    solved: ClassVar[float] = 3e-4
    """Share that an engine's solver leaves at any step where joints are nearly dependent."""
    least_order: ClassVar[int] = 4
    """An engine's loops need not give way, and all of its errors may be those of its steps:
    MuJoCo's RK4."""
    step_option: ClassVar[str] = "--dt"
    over_g: ClassVar[Sequence[str]] = (OVER_G,)
    sensitivity: float
    until_s: float
    left_out: int
    time_s: Array
    raw: Array
    judged: Array
    passages: int = 0

    @staticmethod
    def of(errors: Errors | None) -> FreeFacts | None:
        """Return the facts of a free run, None for others."""
        facts = errors.of_motion if errors else None
        return facts if isinstance(facts, FreeFacts) else None

    @property
    def has_order(self) -> bool:
        return not self.sensitivity > MOST_GROWTH

    def rounding(self, explained: float, summed_rad: float, bound: float) -> float:
        """Return the unavoidable error: an integrated reference is off by more than rounding."""
        return max(explained, summed_rad, bound)

    def compared_with(self, moved: str) -> str:
        return FREE_MOTION

    # Two runs are never the same for their facts alone, whose course is of arrays.
    __eq__ = object.__eq__
    __hash__ = object.__hash__

    def horizon_s(self, raw: float) -> float:
        """Return the time to which the unscaled error stays within a number [s]."""
        return self._held(self.raw, raw)

    def judged_horizon_s(self, limit: float) -> float:
        """Return the time to which the error over the sensitivity stays within a number [s]."""
        return self._held(self.judged, limit)

    def _held(self, largest: Array, limit: float) -> float:
        broken = np.flatnonzero(~(largest <= limit))
        return float(self.time_s[max(broken[0] - 1, 0)] if broken.size else self.time_s[-1])


SHARE = 0.1
"""Least part of a run for a mean; half of the run is the most."""
WORKED = 1e-9
"""Least work, over the largest kinetic energy, that counts."""


def energy_rows(beside: FreeBeside) -> list[Error]:
    """Return the drift of the energy: the mean over the last window less that over the first.

    An engine's energy also varies with its motion, by an offset of second order that is no drift.
    The work of loads and dampers is subtracted, by the reference; it is known at the true position
    and not at the engine's, so that the drift is over the sensitivity there.
    """
    run = beside.run
    if run.energy is None or run.velocity_time_s is None or run.velocity_time_s.size < 2:
        return []
    time_s = run.velocity_time_s
    known = beside.free.energy(np.clip(time_s, 0.0, beside.free.until_s))
    largest = float(np.max(known.kinetic))
    worked = float(np.ptp(known.work)) > WORKED * largest
    divisor = beside.pure_growth if worked else 1.0
    return _drift_rows(beside, ENERGY, run.energy.total_j - known.work, time_s, largest, divisor)


def _drift_rows(
    beside: FreeBeside,
    quantity: Quantity,
    series: Array,
    time_s: Array,
    largest: float,
    divisor: float = 1.0,
) -> list[Error]:
    """Return the drift of a quantity of a whole mechanism, over its largest value; none for 0."""
    if not largest > 0.0:
        return []
    over_s = window_s(beside.scene, float(time_s[-1] - time_s[0]))
    size = abs(drift(series, time_s, over_s)) / divisor
    row = Error(
        quantity=quantity.name,
        body_kind="mechanism",
        body=beside.scene.name,
        source="reported",
        kind="total",
        unit=quantity.of("mechanism").unit,
        scale=largest,
        maximum=size,
        rms=size,
        final=size,
        time_of_maximum_s=float(beside.motion.time_s[-1]),
        driver_at_maximum_rad=float(beside.driver_rad[-1]),
        bound=0.0,
        samples=int(beside.motion.time_s.size),
    )
    return [row]


def window_s(scene: Scene, lasts_s: float) -> float:
    """Return the duration of a mean [s]: a period of a pendulum of the longest link, or a tenth of
    the run where that is longer; half of the run at most."""
    weight = math.hypot(*scene.gravity_m_s2)
    swing = math.tau * math.sqrt(scene.longest_m / weight) if weight else 0.0
    return min(max(SHARE * lasts_s, swing), 0.5 * lasts_s)


def drift(series: Array, time_s: Array, over_s: float) -> float:
    """Return the mean of a series over its last window less that over its first."""
    first = series[time_s <= time_s[0] + over_s]
    last = series[time_s >= time_s[-1] - over_s]
    return float(np.mean(last) - np.mean(first))


def window_means(scene: Scene, time_s: Array, series: Array) -> Array:
    """Return the mean of a series over the window around each instant, (T,); NaN if incomplete."""
    over_s = window_s(scene, float(time_s[-1] - time_s[0]))
    sums = np.concatenate([[0.0], np.cumsum(series)])
    first = np.searchsorted(time_s, time_s - 0.5 * over_s)
    after = np.searchsorted(time_s, time_s + 0.5 * over_s, side="right")
    means = (sums[after] - sums[first]) / (after - first)
    whole = (time_s - 0.5 * over_s >= time_s[0]) & (time_s + 0.5 * over_s <= time_s[-1])
    return np.where(whole, means, np.nan)


def momentum_rows(beside: FreeBeside) -> list[Error]:
    """Return the drift of the angular momentum about the only pin of a mechanism to the ground, by
    means over windows as for the energy; none where other forces act from outside."""
    run, scene = beside.run, beside.scene
    pivot = kept_about(scene) if beside.tells_momentum else None
    if pivot is None or run.velocity_time_s is None or run.velocity_time_s.size < 2:
        return []
    time_s = run.velocity_time_s
    spin = momentum(scene, beside.motion, time_s, pivot)
    return _drift_rows(beside, MOMENTUM, spin, time_s, float(np.max(np.abs(spin))))


def kept_about(scene: Scene) -> str | None:
    """Return the point about which a scene conserves its angular momentum; None where none."""
    pinned = [point for point, bodies in scene.pins.items() if GROUND in bodies and bodies[1:]]
    acts = any(scene.gravity_m_s2) or scene.loads or scene.friction or scene.springs
    return None if acts or scene.sliders or len(pinned) != 1 else pinned[0]


def momentum(scene: Scene, motion: Motion, time_s: Array, pivot: str) -> Array:
    """Return the angular momentum of the links about a point of the ground [kg m^2/s], (T,), at the
    instants ``time_s`` of their velocities."""
    total = np.zeros_like(time_s)
    later = time_s - motion.time_s
    place = complex(*scene.ground[pivot])
    for name, link in scene.links.items():
        point, own = next(iter(link.points.items()))
        moved, turned = motion.points[point], motion.links[name]
        theta = turned.theta + later * turned.omega
        arm = np.exp(1j * theta) * complex(link.centre_m[0] - own[0], link.centre_m[1] - own[1])
        velocity = moved.velocity @ np.array([1.0, 1j])
        centre = moved.position @ np.array([1.0, 1j]) + later * velocity + arm - place
        speed = velocity + 1j * turned.omega * arm
        total += link.mass_kg * (centre.conj() * speed).imag + link.inertia_kg_m2 * turned.omega
    return total
