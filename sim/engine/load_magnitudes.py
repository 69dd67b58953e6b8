"""Magnitudes of loads that are known before a step; for the others see `Load.size`."""

from models.array import Array
from models.scene import Scene, loads
from sim.engine import Drive


def known_ahead(load: loads.Load, drive: Drive) -> bool:
    """True if time alone determines the load: it follows no slider, no angular velocity, and the
    crank's angle only if the law prescribes it."""
    return load.slider is None and (
        load.over == "time" or (load.over == "angle" and drive == "prescribed")
    )


def ahead(scene: Scene, load: loads.Load, time_s: Array) -> Array:
    """Return the magnitude (T,) of a load that is known ahead, in N or N m."""
    x = scene.driver.law.at(time_s)[0] if load.over == "angle" else time_s
    return load.magnitude(x)
