"""The loads of a scene on its free bodies."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from analytic.dyads.chunk import Chunk
from analytic.dyads.driven import driver_scale
from analytic.dyads.rounding import rounding_of_angles
from analytic.forces.bounded import Bounded
from analytic.forces.free_body import FreeBody
from models.array import Array
from models.errors import CrankcheckError, few
from models.joints import local_point
from models.loads import Load
from models.scene import GROUND, Scene


def apply_loads(scene: Scene, chunk: Chunk, time_s: Array, free: Mapping[str, FreeBody]) -> None:
    """Put all loads of a scene on its bodies.

    Raises CrankcheckError for a load on, at or over what the scene has not, and as
    `Load.magnitude`.
    """
    for load in scene.loads.values():
        _check_there(scene, load, free)
        body, magnitude = free[load.body], _magnitude(load, chunk, time_s)
        if load.point is None:
            body.moment = body.moment + magnitude
            continue
        frame = body if load.frame == "body" else free[GROUND]
        along = frame.unit(load.direction_rad, rounding_of_angles(load.direction_rad))
        place = local_point(scene, load.body, load.point)
        body.push(body.vector(body.centre, place), along * magnitude)


def _check_there(scene: Scene, load: Load, free: Mapping[str, FreeBody]) -> None:
    """Files are checked when they are read; a scene may be made otherwise."""
    bodies = [name for name in free if name != GROUND]
    if load.body not in bodies:
        what, found, have = "body", load.body, bodies
    elif load.slider is not None and load.slider not in scene.sliders:
        what, found, have = "slider", load.slider, list(scene.sliders)
    elif load.slider is None and (load.over in ("displacement", "speed") or load.stroke != "both"):
        what, found, have = "slider", "none", list(scene.sliders)
    elif load.point is not None and load.body in scene.links:
        what, found, have = "point", load.point, list(scene.links[load.body].points)
    else:
        return
    if found not in have:
        names = few(have, 12) or "nothing: the scene has none"
        raise CrankcheckError(
            f"{scene.name}: loads.{load.name}.{what}: found {found}; use one of {names}"
        )


def _magnitude(load: Load, chunk: Chunk, time_s: Array) -> Bounded:
    """The force or torque at every sample of a chunk."""
    x, by, speed, speed_by = time_s, 0.0, None, 0.0
    sliding = None if load.slider is None else chunk.sliders[load.slider]
    error = chunk.driver.error
    if load.over == "angle":
        scale = driver_scale(chunk.scene)
        x, by = chunk.theta * scale, 0.0 if error is None else error.theta * scale
    if load.over == "omega":
        body = chunk.bodies[load.body]
        x, by = _as_samples(body.omega, time_s), 0.0 if body.error is None else body.error.omega
    if sliding is not None:
        speed = _as_samples(sliding.speed, time_s)
        if load.over == "displacement":
            x = _as_samples(sliding.s, time_s)
        if sliding.error is not None:
            speed_by = sliding.error.speed
            by = sliding.error.displacement if load.over == "displacement" else by
        if load.over == "speed":
            x, by = speed, speed_by
    value = load.magnitude(x, speed)
    if error is None:
        return Bounded(value, None)
    return Bounded(value, load.uncertain(x, by, speed, speed_by))


def _as_samples(values: Array | float, like: Array) -> Array:
    return np.broadcast_to(np.asarray(values, dtype=np.float64), like.shape)
