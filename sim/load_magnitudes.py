"""How large a scene's loads are where an engine applies them: known ahead, or of its own state."""

from __future__ import annotations

from collections.abc import Mapping

from models.array import Array
from models.loads import Load
from models.scene import Scene
from sim.engine import Drive


def known_ahead(load: Load, drive: Drive) -> bool:
    """Whether time alone says how large the load is: it follows no slider, and the crank's angle
    only where that is the law's."""
    return load.slider is None and (load.over == "time" or drive == "prescribed")


def ahead(scene: Scene, load: Load, time_s: Array) -> Array:
    """The magnitude (T,) of a load that is known ahead, in N or N m."""
    x = scene.driver.law.at(time_s)[0] if load.over == "angle" else time_s
    return load.magnitude(x)


def of_state(
    load: Load,
    time_s: float,
    driver_rad: float,
    sliders: Mapping[str, tuple[float, float]],
) -> float:
    """The magnitude of a load in a state: of the crank at an angle [rad], and of sliders at
    displacements [m] and speeds [m/s]."""
    return load.size(time_s, driver_rad, sliders)
