"""What the loads of a scene do to each body by itself: forces, and moments about its centre."""

from __future__ import annotations

import numpy as np

from analytic.forces.applied_loads import apply_loads
from analytic.forces.free_body import FreeBody
from analytic.forces.given_motion import chunks_of
from models.array import Array
from models.motion import Motion
from models.scene import Scene

Push = tuple[Array, Array]
"""A force [N], (T, 2), and a moment about the centre of mass [N m], (T,)."""


def load_pushes(scene: Scene, motion: Motion) -> dict[str, Push]:
    """The loads on each body that has any, without its weight and inertia.

    Raises CrankcheckError for a motion that is not whole, and as `Load.magnitude`.
    """
    loaded = {load.body for load in scene.loads.values()}
    size = len(motion.time_s)
    pushes = {name: (np.zeros((size, 2)), np.zeros(size)) for name in loaded}
    for span, chunk in chunks_of(scene, motion, bound=False):
        free = {
            name: FreeBody(body, scene.links[name].centre_m if name in scene.links else (0.0, 0.0))
            for name, body in chunk.bodies.items()
        }
        apply_loads(scene, chunk, motion.time_s[span], free)
        for name, (force, moment) in pushes.items():
            body = free[name]
            force[span, 0], force[span, 1] = body.force.v.x, body.force.v.y
            moment[span] = body.moment.value
    return pushes
