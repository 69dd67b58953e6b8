"""How long the springs of a scene are in the motion of an engine's bodies."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from models.array import Array
from models.joints import line_ends, whole_turns
from models.loads import LineSpring, PinSpring
from models.scene import Scene
from sim.engine import Poses
from sim.measure import PointPath, body_paths, motion


def spring_lengths(scene: Scene, poses: Poses) -> Mapping[str, Array]:
    """The q (T,) [m or rad] of each spring at the positions of the poses; see `models.loads`.

    The first sample is taken as the start, from which whole turns in pins are counted.
    """
    paths, lengths = body_paths(poses), dict[str, Array]()
    for name, spring in scene.springs.items():
        if isinstance(spring, LineSpring):
            a, b = (PointPath(paths[body], at).position for body, at in line_ends(scene, spring))
            lengths[name] = np.hypot(*(b - a).T)
        elif isinstance(spring, PinSpring):
            first, second = (paths[body].pose.theta for body in spring.bodies)
            opened = second - first
            lengths[name] = opened + whole_turns(spring, float(opened[0]))
        else:
            seen = motion(scene, replace(poses, lag_s=0.0)).sliders[spring.slider]
            lengths[name] = seen.displacement
    return lengths
