"""The reference of a free mechanism: integrated once, and evaluated at sets of instants."""

from __future__ import annotations

import pickle
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, ClassVar, Protocol

import numpy as np

from models.array import Array
from models.motion import Motion, State
from models.scene import Driver, Scene, as_bytes, driver
from reports.compare.compare import Beside, Truth, first_samples, incomplete
from reports.compare.tracks import Track
from reports.quantities.free_and_elastic import PHASE
from sim.engine import Run

if TYPE_CHECKING:
    from analytic.free.free_motion import FreeMotion, LimitPassage
    from analytic.multibody.bodies import EnergyBalance


LEAST_KNOWN = 0.25
"""Largest uncertainty of the reference, over the limit of the phase, at judged samples."""


def free_truth(
    scene: Scene, steps: int, dt_s: float, tolerance: Mapping[str, float] | None = None
) -> FreeTruth:
    """Return the reference of a free scene for ``steps`` of ``dt_s`` [s], as `free_truth_until`."""
    return free_truth_until(scene, steps * dt_s, dt_s, tolerance)


def free_truth_until(
    scene: Scene, lasts_s: float, dt_s: float, tolerance: Mapping[str, float] | None = None
) -> FreeTruth:
    """Return the reference of a free scene for a duration [s]; ``dt_s`` is 0 if none is known, and
    the limit of the phase is then its cap, unless one is given. Raises CrankcheckError as
    `analytic.free.release`."""
    motion = kept_motion(scene, lasts_s)
    peak = motion.peak_speed_rad_s or 1.0 / motion.until_s
    start = motion.at(np.zeros(1), bound=False).links[scene.driver.link].theta
    law = driver.Released(float(start[0]), peak, motion.until_s)
    given = (tolerance or {}).get("phase", scene.tolerance.get("phase"))
    numbers = PHASE.criteria[0].tolerance
    budget = min(numbers.coefficient * (peak * dt_s) ** numbers.order, numbers.cap)
    budget = budget if dt_s else numbers.cap
    paced = replace(scene, driver=Driver(scene.driver.link, law))
    return FreeTruth(paced, free=motion, known_rad=LEAST_KNOWN * (given or budget))


@dataclass(frozen=True)
class FreeTruth(Truth):
    """The reference of a free scene; ``scene`` has the largest speed of its driver as the start's,
    as the scale of errors of rates. Samples count as long as the uncertainty of the reference, over
    the sensitivity, is at most ``known_rad``."""

    free: FreeMotion = field(kw_only=True)
    known_rad: float = field(kw_only=True)

    @cached_property
    def start(self) -> State:
        return released_state(self.free.scene)

    def _solved(self, time_s: Array) -> Motion:
        if time_s.size and time_s[0] < 0.0:
            early = self.free.outside(time_s[time_s < 0.0], bound=self.bound)
            begun = time_s[time_s >= 0.0]
            return Motion.joined([early, self.at(begun)]) if begun.size else early
        after = time_s > self.free.until_s
        if after.any():
            late = self.free.outside(time_s[after], bound=self.bound)
            return late if after.all() else Motion.joined([self.at(time_s[~after]), late])
        return self.free.at(time_s, bound=self.bound)

    def with_forces_at(self, time_s: Array) -> Motion:
        return self.free.with_forces(self.at(time_s), bound=self.bound)

    def known(self, time_s: Array) -> int:
        """Return the number of the first instants (T,) with a reference good enough to judge by;
        instants within a step before the start or after the end are as well known as these."""
        within = np.clip(time_s, 0.0, self.free.until_s)
        unsure = self.free.error_rad(within) / self.free.sensitivity(within)
        lost = np.flatnonzero(~(unsure <= self.known_rad))
        return int(lost[0]) if lost.size else time_s.size

    def _beside(self, run: Run, motion: Motion) -> Beside:
        """Return the run beside the reference as far as that is known."""
        known = first_samples(run, max(self.known(motion.time_s), 1))
        assert known.motion is not None
        return FreeBeside(self, known, known.motion, whole_run=run, free=self.free)


class FreeReference(Protocol):
    """Interface of the motion that is the reference of a run
    (`analytic.free.free_motion.FreeMotion`, which implements it)."""

    @property
    def until_s(self) -> float: ...

    @property
    def passages(self) -> Sequence[LimitPassage]: ...

    @property
    def by_dyads(self) -> bool: ...

    @property
    def driver_tells(self) -> bool: ...

    def beside(self, logged: Motion) -> Motion: ...

    def energy(self, time_s: Array) -> EnergyBalance: ...

    def sensitivity(self, time_s: Array) -> Array: ...


@dataclass(frozen=True)
class FreeBeside(Beside):
    """A run as far as its reference is known; ``whole_run`` goes on to its own end.

    Judged errors at the same time are over the sensitivity of the motion: as a small change of the
    start grows by so much, the reference itself is as uncertain to anybody who builds the
    mechanism.
    """

    compared_by: ClassVar[tuple[str, ...]] = (".free_errors",)
    whole_run: Run = field(kw_only=True)
    free: FreeReference = field(kw_only=True)

    @cached_property
    def at_crank(self) -> Motion:
        """The reference at the position of the run's own coordinate at each instant."""
        return self.free.beside(self.motion)

    @cached_property
    def driver_rad(self) -> Array:
        return self.driver_at(self.motion.time_s, self.reference)

    @cached_property
    def growth(self) -> Array:
        """The sensitivity at the logged instants, (T,)."""
        return self.free.sensitivity(self.motion.time_s)

    @property
    def driver_speed(self) -> Array:
        """The true angular velocity of the driver at the logged instants [rad/s], (T,)."""
        return self.reference.links[self.scene.driver.link].omega

    @property
    def no_geometry(self) -> str:
        """Reason why the position of the run is undefined, "" where it is defined."""
        lost = not np.all(np.isfinite(self.crank))
        return "no geometry: the logged angle of the driver is not finite" if lost else ""

    @property
    def tells_momentum(self) -> bool:
        """True if positions and velocities of all bodies are required."""
        return True

    def driver_at(self, time_s: Array, reference: Motion) -> Array:
        return reference.links[self.scene.driver.link].theta

    def judged(self, track: Track, time_s: Array) -> Track:
        """Return the error at the same time over the sensitivity; gaps of joints unchanged."""
        if track.quantity == "gap":
            return track
        growth = self.free.sensitivity(time_s)
        over = growth[:, None] if track.error.ndim == 2 else growth
        return replace(track, error=track.error / over, bound=track.bound / growth)

    @property
    def missing(self) -> tuple[str, ...]:
        return super().missing if self.run.energy else (*super().missing, "energy")

    @property
    def incomplete(self) -> str:
        return incomplete(self.whole_run)

    @property
    def left_out(self) -> int:
        """Number of samples not judged, as the reference is too uncertain there."""
        logged = self.whole_run.motion
        return 0 if logged is None else logged.time_s.size - self.motion.time_s.size

    @property
    def pure_growth(self) -> float:
        """The largest sensitivity."""
        return float(np.max(self.growth))


BEYOND = 1.01
"""Integrated duration over the requested one, where loads over time allow it: some velocities
belong to half a step after a run."""
LOOK = 1e-3
"""The part of the scene's own duration that is integrated for its start."""


def kept_motion(scene: Scene, lasts_s: float) -> FreeMotion:
    """Return the motion of a free scene for at least so long [s]. Raises CrankcheckError."""
    return _released(as_bytes(scene), long_enough_s(scene, lasts_s))


def released_state(scene: Scene) -> State:
    """Return the start of a free scene: the same to the last bit for any duration, with the
    accelerations by its masses and forces. Raises CrankcheckError as `analytic.free.release`."""
    return kept_motion(scene, LOOK * scene.driver.law.period_s).at(np.zeros(1), bound=False).state()


def long_enough_s(scene: Scene, lasts_s: float) -> float:
    """Return the end of integration [s] for comparison with a run of this duration."""
    until_s = BEYOND * lasts_s
    ends = [
        load.characteristic.nearest(until_s) for load in scene.loads.values() if load.over == "time"
    ]
    # Without its rounding it is one for all steps of a sweep.
    return max(lasts_s, min(float(f"{until_s:.9g}"), driver.LONGEST_S, *ends))


@lru_cache(maxsize=4)
def _released(pickled: bytes, until_s: float) -> FreeMotion:
    """Return the motion of a scene, which may come from another process: kept by its content."""
    from analytic.free.release import release  # slow to import, and for free motion alone

    return release(pickle.loads(pickled), until_s)
