"""A run that was let go, beside the motion that its masses and forces give."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, Protocol

import numpy as np

from models.array import Array
from models.motion import Motion
from reports.compare.beside import Beside
from reports.compare.completeness import incomplete
from reports.compare.tracks import Track
from sim.engine import Run

if TYPE_CHECKING:
    from analytic.free.free_motion import LimitPassage
    from analytic.multibody.bodies import EnergyBalance


class FreeReference(Protocol):
    """What is asked of the motion that a run is held to (`analytic.free.free_motion.FreeMotion`,
    which is one)."""

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
    """A run as far as the truth of it is known; ``whole_run`` goes on to its own end.

    Errors at the same time are over the sensitivity of the motion where they are judged: by so
    much as a small change of the start grows, the truth itself is uncertain to anybody who builds
    the mechanism.
    """

    compared_by: ClassVar[tuple[str, ...]] = (".free.free_errors",)
    whole_run: Run = field(kw_only=True)
    free: FreeReference = field(kw_only=True)

    @cached_property
    def at_crank(self) -> Motion:
        """The truth in the position that the run's own coordinate has at each instant."""
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
        """Why the run does not say in which position it is, "" where it does."""
        return (
            ""
            if np.all(np.isfinite(self.crank))
            else ("no geometry: the logged angle of the driver is not finite")
        )

    @property
    def tells_momentum(self) -> bool:
        """Whether places and velocities of all bodies are to be asked for."""
        return True

    def driver_at(self, time_s: Array, reference: Motion) -> Array:
        return reference.links[self.scene.driver.link].theta

    def judged(self, track: Track, time_s: Array) -> Track:
        """The error at the same time over the sensitivity; joints are closed at any time."""
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
        """How many samples are not judged, as the truth is not known well enough there."""
        logged = self.whole_run.motion
        return 0 if logged is None else logged.time_s.size - self.motion.time_s.size

    @property
    def pure_growth(self) -> float:
        """The largest sensitivity."""
        return float(np.max(self.growth))
