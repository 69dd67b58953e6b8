"""A compiled model with the planar linkage that was read off it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from models.array import Array
from sim.mujoco.own_model.limbs import Limbs
from sim.mujoco.own_model.linkage import Linkage
from sim.mujoco.own_model.matter import Matter
from sim.mujoco.own_model.scene import SceneRead


@dataclass(frozen=True, eq=False)
class PlanarModel:
    """``keyframe`` is the one to start from, None for the pose as drawn."""

    model: Any
    linkage: Linkage
    read: SceneRead
    limbs: Limbs
    keyframe: int | None

    @property
    def driven(self) -> int:
        """The joint that is driven."""
        return self.linkage.component.driven

    @property
    def loops(self) -> list[int]:
        """The equalities that close loops, or are part of a link."""
        return [each.index for each in self.linkage.component.closures]

    @property
    def qpos(self) -> Array:
        """The joint coordinates of its own pose, all of the model."""
        model = self.model
        return np.array(model.qpos0 if self.keyframe is None else model.key_qpos[self.keyframe])

    def matter(self, body: str) -> Matter:
        """Mass and inertia of a body of the scene, as its bodies in the model add up to."""
        link = next(link for link, name in self.read.names.items() if name == body and link)
        return self.read.parts.matter[link]
