"""The tracks of a user's log beside the truth: of what it holds, and of no more."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from analytic.kinematics import solve_driven
from models.array import Array
from models.motion import Motion
from reports.compare.beside import Beside, Truth
from reports.compare.tracks import Track, tracks
from reports.quantities import named

EVEN = 1e-6
"""Steps that differ by less of themselves, as printed times do, are the same."""
MANY = 200_000
"""Samples beyond which memory counts: tracks are not kept, and the errors at the logged angle of
the driver left out, as a second truth of that size takes as much as all else."""


@dataclass(frozen=True)
class AtCrank(Truth):
    """The truth at the logged angles of the driver, where the log has them: its places. Rates are
    those of the scene's law, which says how hard the scene is."""

    time_s: Array | None = None
    crank_rad: Array | None = None

    def at(self, time_s: Array) -> Motion:
        """The reference at the instants of the rows, those of no other are known."""
        assert self.time_s is not None
        assert self.crank_rad is not None
        instants = time_s.tobytes()
        if instants not in self._motions:
            crank = self.crank_rad
            if not np.array_equal(time_s, self.time_s):
                crank = np.interp(time_s, self.time_s, crank)
            _, omega, alpha = self.scene.driver.law.at(time_s)
            self._motions[instants] = solve_driven(
                self.scene,
                crank,
                omega,
                alpha,
                time_s,
                links=self.links,
                points=self.points,
                bound=self.bound,
            )
        return self._motions[instants]


@dataclass(frozen=True)
class LogBeside(Beside):
    """A log beside the truth: tracks of what it holds, and of no more.

    ``step_s`` is the step that was told of it, 0 for none: without one there is no start, and
    nothing is differenced. Where the truth is that `AtCrank`, there is ``geometry_alone``.
    """

    step_s: float = 0.0
    geometry_alone: bool = False

    @cached_property
    def whole(self) -> Motion:
        if self.truth.links is None:
            return self.reference
        every = -(-self.motion.time_s.size // MANY)
        whole = replace(self.truth, links=None, points=None, bound=False, _motions={})
        return whole.at(self.motion.time_s[::every])

    @property
    def of_engine(self) -> bool:
        return False

    @property
    def settling(self) -> int:
        return super().settling if self.step_s else 0

    @property
    def is_even(self) -> bool:
        steps = np.diff(self.motion.time_s)
        even = np.ptp(steps) <= EVEN * np.max(steps)
        return bool(self.step_s) and bool(even)

    @property
    def has_crank(self) -> bool:
        few = self.motion.time_s.size <= MANY
        return few and not self.geometry_alone and bool(np.all(np.isfinite(self.crank)))

    @property
    def missing(self) -> tuple[str, ...]:
        return ()

    @property
    def incomplete(self) -> str:
        return ""

    def tracks(self, quantities: Sequence[str], reference: Motion) -> tuple[Track, ...]:
        judged = [name for name in quantities if not self.geometry_alone or _of_places(name)]
        if self.motion.time_s.size > MANY:
            every = tuple(tracks(self.scene, self.run, reference, judged))
        else:
            every = super().tracks(judged, reference)
        return tuple(track for track in every if not np.all(np.isnan(track.error)))


def _of_places(quantity: str) -> bool:
    """Whether the geometry alone says it."""
    return quantity in named("place", "closure")
