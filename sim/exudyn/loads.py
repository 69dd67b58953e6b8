"""The loads of a scene, as exudyn applies them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from models.characteristics import Constant, Staircase
from models.errors import EngineError, few
from models.joints import bodies, sliding_angle
from models.loads import Load
from models.motion import State
from models.scene import Point, Scene
from sim.engine import Drive
from sim.exudyn.applied import Applied, Size, massless_blocks
from sim.exudyn.jumps import StepMeans
from sim.exudyn.present import Present
from sim.load_magnitudes import ahead, known_ahead


def apply_loads(
    scene: Scene, state: State, drive: Drive, dt_s: float, applied: Applied, present: Present
) -> None:
    """Add all loads. Raises EngineError for one on a body that the scene has not."""
    massless = massless_blocks(scene)
    known = [*bodies(scene), *massless]
    for load in scene.loads.values():
        if load.body not in known:
            raise EngineError(
                f"loads.{load.name}: found body {load.body}; use one of {few(known, 12)}"
            )
        size = _size(scene, load, state.time_s, drive, dt_s, present)
        if load.point is None:
            applied.torque(load.body, size)
            continue
        marker = applied.on(load.body, load.point)
        in_body = load.frame == "body"
        if in_body and load.body in massless:
            slider = scene.sliders[massless[load.body]]
            turned = load.direction_rad + sliding_angle(slider) - slider.direction_rad
            applied.force(marker, _turning(size, present, slider.name, turned))
        else:
            applied.force(marker, _along(size, load.direction_rad), in_body=in_body)


def follows_rates(scene: Scene, drive: Drive) -> bool:
    """Whether a load is by a speed that is not known before the step."""
    return drive != "prescribed" and any(
        load.over in ("omega", "speed") for load in scene.loads.values()
    )


def _size(
    scene: Scene, load: Load, start_s: float, drive: Drive, dt_s: float, present: Present
) -> Size | float:
    """How large a load is: a number where it is always the same.

    Where it moves the mechanism, what jumps at a time is as its impulse wants it (`StepMeans`); of
    a crank that is moved all forces are those of the instant.
    """
    if isinstance(load.characteristic, Constant) and load.stroke == "both":
        return load.characteristic.value
    if known_ahead(load, drive):
        if isinstance(load.characteristic, Staircase) and drive != "prescribed":
            means = StepMeans(load.characteristic, start_s, dt_s)
            return lambda _, time_s: means.at(start_s + time_s)
        return _told(scene, load, start_s)

    def of_present(system: Any, time_s: float) -> float:
        theta, _ = present.angle(system, scene.driver.link)
        slid = {} if load.slider is None else {load.slider: present.slider(system, load.slider)}
        omega = 0.0 if load.over != "omega" else present.angle(system, load.body)[1]
        return load.size(start_s + time_s, theta, slid, omega)

    return of_present


def _told(scene: Scene, load: Load, start_s: float) -> Size:
    """The size over time, worked out once in a step."""
    last = math.nan, 0.0

    def at(_: Any, time_s: float) -> float:
        nonlocal last
        if last[0] != time_s:
            last = time_s, float(ahead(scene, load, np.array([start_s + time_s]))[0])
        return last[1]

    return at


def _along(size: Size | float, angle_rad: float) -> Any:
    """A force in a fixed direction."""
    c, s = math.cos(angle_rad), math.sin(angle_rad)
    if not callable(size):
        return size * c, size * s

    def vector(system: Any, time_s: float) -> Point:
        force = size(system, time_s)
        return force * c, force * s

    return vector


def _turning(size: Size | float, present: Present, slider: str, turned_rad: float) -> Any:
    """A force in a direction that turns with the line of a slider."""

    def vector(system: Any, time_s: float) -> Point:
        force = size(system, time_s) if callable(size) else size
        c, s = present.line(system, slider, turned_rad)
        return force * c, force * s

    return vector
