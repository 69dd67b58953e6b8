"""The truth of a mechanism that was let go: integrated once, and asked for at sets of instants."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from models.array import Array
from models.driver import Released
from models.motion import Motion, State
from models.scene import Driver, Scene
from reports.compare.beside import Beside, Truth
from reports.compare.free.free_beside import FreeBeside
from reports.compare.free.kept_motion import kept_motion, released_state
from reports.compare.free.some_samples import first_samples
from reports.quantities.free import PHASE
from sim.engine import Run

if TYPE_CHECKING:
    from analytic.free.free_motion import FreeMotion

LEAST_KNOWN = 0.25
"""What the truth may be off by, of the limit of the phase: samples beyond are not judged."""


def free_truth(
    scene: Scene, steps: int, dt_s: float, tolerance: Mapping[str, float] | None = None
) -> FreeTruth:
    """The truth of a scene that is let go, for so many steps of ``dt_s``. Raises CrankcheckError as
    `analytic.free.release`."""
    return free_truth_until(scene, steps * dt_s, dt_s, tolerance)


def free_truth_until(
    scene: Scene, lasts_s: float, dt_s: float, tolerance: Mapping[str, float] | None = None
) -> FreeTruth:
    """As `free_truth`, for so long [s]; ``dt_s`` is 0 where no step is known, and the limit of the
    phase is then the widest that there is, unless one is given."""
    motion = kept_motion(scene, lasts_s)
    peak = motion.peak_speed_rad_s or 1.0 / motion.until_s
    law = Released(
        float(motion.at(np.zeros(1)).links[scene.driver.link].theta[0]), peak, motion.until_s
    )
    given = (tolerance or {}).get("phase", scene.tolerance.get("phase"))
    numbers = PHASE.criteria[0].tolerance
    budget = min(numbers.coefficient * (peak * dt_s) ** numbers.order, numbers.cap)
    budget = budget if dt_s else numbers.cap
    paced = replace(scene, driver=Driver(scene.driver.link, law))
    return FreeTruth(paced, free=motion, known_rad=LEAST_KNOWN * (given or budget))


@dataclass(frozen=True)
class FreeTruth(Truth):
    """The reference of a scene that is let go; ``scene`` has the largest speed of its driver as
    that of its start, which errors of rates are over. Samples count as long as what the truth may
    be off by, over the sensitivity, is at most ``known_rad``."""

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
        """How many of the first instants (T,) the truth is known well enough at to judge by it;
        those within a step before the start or after the end are as well known as these."""
        within = np.clip(time_s, 0.0, self.free.until_s)
        unsure = self.free.error_rad(within) / self.free.sensitivity(within)
        lost = np.flatnonzero(~(unsure <= self.known_rad))
        return int(lost[0]) if lost.size else time_s.size

    def beside(self, run: Run) -> Beside | None:
        """The run as far as the truth is known, beside it; None where it logged nothing."""
        motion = run.motion
        if motion is None or not motion.time_s.size:
            return None
        known = first_samples(run, max(self.known(motion.time_s), 1))
        assert known.motion is not None
        return FreeBeside(self, known, known.motion, whole_run=run, free=self.free)
