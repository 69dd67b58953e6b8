"""A bead beside its swing."""

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from models.array import Array
from models.motion import Motion, State
from reports.compare.compare import Beside, Truth
from sim.engine import Run
from tests.worlds.bead.swing import Swing, moved, swing_of


@dataclass(frozen=True)
class BeadTruth(Truth):
    """The swing of a scene."""

    @cached_property
    def swing(self) -> Swing:
        return swing_of(self.scene)

    @cached_property
    def start(self) -> State:
        return self.at(np.zeros(1)).state()

    def _solved(self, time_s: Array) -> Motion:
        return moved(self.scene, self.swing, time_s)

    def beside(self, run: Run) -> Beside | None:
        motion = run.motion
        return BeadBeside(self, run, motion) if motion is not None and motion.time_s.size else None


@dataclass(frozen=True)
class BeadBeside(Beside):
    """A run of a bead beside the swing."""

    compared_by: ClassVar[tuple[str, ...]] = ("tests.worlds.bead.errors",)

    @cached_property
    def driver_rad(self) -> Array:
        return self.driver_at(self.motion.time_s, self.reference)

    def driver_at(self, time_s: Array, reference: Motion) -> Array:
        return reference.links[self.scene.driver.link].theta
