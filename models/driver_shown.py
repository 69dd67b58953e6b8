"""The driven joint's coordinate as people are shown it: in words, and in degrees or metres."""

from __future__ import annotations

import math

import numpy as np

from models.array import Array
from models.driver_course import driver_course
from models.laws import Oscillating
from models.motion import Motion
from models.scene import Scene


def place_in_words(place: float, unit: str, degrees: str = ".6g") -> str:
    """A driver's coordinate [rad or m] as it is told, by its ``unit``; angles formatted so."""
    return f"{place:.6g} m" if unit == "m" else f"{math.degrees(place):{degrees}} deg"


def driver_unit(scene: Scene) -> str:
    """Of `driver_shown`: deg or m."""
    return "deg" if scene.driver.slider is None else "m"


def driver_axis(scene: Scene) -> str:
    """What stands along an axis of `driver_shown`."""
    what = "angle" if scene.driver.slider is None else "place"
    return f"{what} of {scene.driver.joint} [{driver_unit(scene)}]"


def driver_shown(scene: Scene, motion: Motion) -> Array:
    """The driver's coordinate over a motion [deg or m], (T,). KeyError as `driver_course`."""
    place = driver_course(scene, motion)[0]
    return place if scene.driver.slider is not None else np.asarray(np.degrees(place))


def driver_stands(scene: Scene, motion: Motion, index: int) -> str:
    """Where the driver is at a sample, as in "crank at 30 deg"."""
    value = float(driver_shown(scene, motion)[index])
    if scene.driver.slider is not None:
        return f"{scene.driver.joint} at {value:.3g} m"
    turns = not isinstance(scene.driver.law, Oscillating)
    return f"{scene.driver.joint} at {value % 360.0 if turns else value:.0f} deg"
