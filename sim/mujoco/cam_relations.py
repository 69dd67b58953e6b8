"""Cams as relations while MuJoCo steps: the parabola of each, set for every evaluation.

An equality of joints is without the acceleration s'' omega^2 that the follower has at the relation
itself: MuJoCo's aref has no term for a changing Jacobian. The follower is set ahead by the distance
at which the constraint's spring gives that acceleration (MuJoCo, Computation: solver parameters)::

    aref = -b v - k r,    k = d / (dmax tc zeta)^2        ahead = s'' omega^2 / k
"""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import mujoco  # type: ignore[import-untyped]  # ships no stubs

from models.mjcf.higher_pairs import cam_relations
from models.mjcf.tree import Tree
from models.scene import Scene


class CamRelations:
    """The cams of a model, in steps of ``dt_s`` [s]."""

    def __init__(self, scene: Scene, tree: Tree, model: Any, dt_s: float) -> None:
        self._dt = dt_s
        self._cams = [
            (one, int(model.equality(one.name).id), int(model.joint(one.cam).qposadr[0]))
            for one in cam_relations(scene, tree)
        ]

    def set(self, model: Any, data: Any, later_s: float = 0.0) -> None:
        """Set the parabolas about the cams' angles, or those ``later_s`` from now."""
        for relation, row, joint in self._cams:
            omega = float(data.qvel[joint])
            at = float(data.qpos[joint]) + later_s * omega
            timeconst, damping = model.eq_solref[row]
            least, most = model.eq_solimp[row, :2]
            stiffness = least / (most * timeconst * damping) ** 2
            model.eq_data[row, :5] = relation.coefficients(at, omega**2 / stiffness)

    @contextmanager
    def following(self) -> Iterator[None]:
        """Let the parabolas follow the cams while MuJoCo works; its callback comes after those
        rows are read, so it sets them for the middle of the time until the next evaluation."""
        if not self._cams:
            yield
            return
        mujoco.set_mjcb_passive(lambda model, data: self.set(model, data, 0.5 * self._dt))
        try:
            yield
        finally:
            mujoco.set_mjcb_passive(None)
