"""What MuJoCo says of the forces in the joints of a state, as a user of it reads them.

After `mj_forward`, `mj_rnePostConstraint` has the force that each body is given by its parent
(``cfrc_int``): inertia and gravity of all that hangs on it, less what the loops take over. That of
the crank is without the flywheel, which is no body. The forces at the pins that close the loops are
the multipliers of their connects, three rows each in the frame of the world, that of the first body
first.
"""

from __future__ import annotations

from typing import Any

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np

from models.array import Array
from models.mjcf.forces import SpringTendon
from models.tree import Limb
from sim.mujoco.wrench import Wrench


class JointForces:
    """Forces in the joints of the states that it is shown, one row a state."""

    def __init__(
        self,
        model: Any,
        limbs: tuple[Limb, ...],
        first_load: int,
        tendons: tuple[SpringTendon, ...] = (),
    ) -> None:
        self._bodies = np.array([model.body(limb.body).id for limb in limbs])
        self._roots = model.body_rootid[self._bodies]
        self._limbs = limbs
        self._wrenches: list[Array] = []
        self._centres: list[Array] = []
        self._loops: list[Array] = []
        self._friction: list[Array] = []
        self._first_load, self._sizes = first_load, list[Array]()
        self._senses = np.array([tendon.sense for tendon in tendons])
        self._pulls: list[Array] = []

    def look(self, model: Any, data: Any) -> None:
        """Take the forces of a state; `mj_forward` has seen it."""
        mujoco.mj_rnePostConstraint(model, data)
        self._wrenches.append(data.cfrc_int[self._bodies, 2:5])
        self._centres.append(data.subtree_com[self._roots, :2])
        loops = np.zeros((model.neq, 3))
        # Equalities come first among the rows of constraints; one that is off has none. Friction
        # follows them, a row for each joint that has some.
        loops[data.efc_id[: data.ne : 3]] = data.efc_force[: data.ne].reshape(-1, 3)
        self._loops.append(loops[:, :2])
        friction = np.zeros(model.nv)
        rubbing = slice(data.ne, data.ne + data.nf)
        friction[data.efc_id[rubbing]] = data.efc_force[rubbing]
        self._friction.append(friction)
        self._sizes.append(data.ctrl[self._first_load :].copy())
        longer = data.ten_length - model.tendon_lengthspring[:, 0]
        pulls = model.tendon_stiffness * longer + model.tendon_damping * data.ten_velocity
        self._pulls.append(self._senses * pulls)

    def from_parent(self, limb: Limb) -> Wrench:
        """What the parent exerts on a limb, about the place where MuJoCo has it: the centre of mass
        of the tree that the limb is part of."""
        k = self._limbs.index(limb)
        given = np.array([each[k] for each in self._wrenches])
        return Wrench(given[:, 1:], given[:, 0], np.array([each[k] for each in self._centres]))

    def of_load(self, load: int) -> Array:
        """The size of a load, (T,)."""
        return np.array([each[load] for each in self._sizes])

    def of_spring(self, spring: int) -> Array:
        """What a spring pulls its q back with, (T,)."""
        return np.array([each[spring] for each in self._pulls])

    def of_friction(self, joint: int) -> Array:
        """What friction does along a coordinate, (T,)."""
        return np.array([each[joint] for each in self._friction])

    def at_loop(self, equality: int) -> Array:
        """What a connect exerts on its first body, (T, 2)."""
        return np.array([each[equality] for each in self._loops])
