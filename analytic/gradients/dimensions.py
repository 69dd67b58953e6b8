r"""Dimensions of a scene: its lengths and angles by name, and what of the scene each one shifts.

::

            E                   coupler       the length BC: C moves along the line
           / \                  coupler.E.x   coordinates of E in the frame of the link
          B---C                 crank         the length AB of a link with two points
         /     \                ground        the length AD
        A       D

    C.offset, C.direction       line of slider C: across itself; about its ``through_m``
    C.angle                     angle of a sliding link against its line
    driver.angle, driver.place  coordinate of the driver, at all times
    CAM.base                    radius of the base circle

A point moves in the frame of its link, and all else of the link stays: its other points, the lines
on it, its centre of mass, mass and inertia. The first point never moves, and the second along its
line only: the rest would turn the frame, or shift the whole. The follower of a cam keeps its law:
the profile follows from the dimensions.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from models.errors import CrankcheckError, suggestion
from models.scene import GROUND, Point, Scene

Key = tuple[str, ...]
"""Kind and names of what shifts: ("point", BODY, POINT), ("through" or "direction" or "lean",
SLIDER), ("base", CAM), ("driver",)."""


@dataclass(frozen=True)
class Dimension:
    """Length or angle of a scene: its value, ``unit`` m or rad, and the shift by each unit of it of
    points and lines in the frames of their bodies, or of other numbers."""

    name: str
    words: str
    unit: str
    value: float
    shifts: Mapping[Key, complex]


def dimensions(scene: Scene) -> dict[str, Dimension]:
    """Return the dimensions of a scene by name."""
    found = [each for body, points in scene.points_of.items() for each in _of_body(body, points)]
    for name, slider in scene.sliders.items():
        line = cmath.exp(1j * slider.direction_rad)
        origin = next(iter(scene.points_of.get(slider.on, {}).values()), (0.0, 0.0))
        away = (complex(*slider.through_m) - complex(*origin)) * line.conjugate()
        rows = [("offset", "m", away.imag, "through", 1j * line)]
        rows += [("direction", "rad", slider.direction_rad, "direction", 1.0)]
        rows += [("angle", "rad", slider.angle_rad, "lean", 1.0)] * (slider.link is not None)
        for what, unit, value, kind, shift in rows:
            words = f"{what} of slider {name}"
            found.append(Dimension(f"{name}.{what}", words, unit, value, {(kind, name): shift}))
    for name, pair in scene.cams.items():
        words, base = f"base radius of cam {name}", pair.profile.base_m
        found.append(Dimension(f"{name}.base", words, "m", base, {("base", name): 1.0}))
    unit, start = scene.driver.unit, float(scene.driver.law.at(np.zeros(1))[0][0])
    what = f"driver.{'angle' if unit == 'rad' else 'place'}"
    found.append(Dimension(what, f"{scene.driver.joint} at 0 s", unit, start, {("driver",): 1.0}))
    return {each.name: each for each in found}


def _of_body(body: str, points: Mapping[str, Point]) -> Iterator[Dimension]:
    places = {name: complex(*place) for name, place in points.items()}
    if not places:
        return
    first, origin = next(iter(places.items()))
    second = next((name for name, place in places.items() if place != origin), first)
    for name, place in places.items():
        if name == second != first:
            length, line = abs(place - origin), (place - origin) / abs(place - origin)
            shift: Mapping[Key, complex] = {("point", body, name): line}
            yield Dimension(body, f"{body}, {first} to {name}", "m", length, shift)
        elif name != first:
            for axis, unit, value in (("x", 1.0, place.real), ("y", 1j, place.imag)):
                shift = {("point", body, name): unit}
                yield Dimension(
                    f"{body}.{name}.{axis}", f"{axis} of {name} on {body}", "m", value, shift
                )


def dimension(scene: Scene, name: str) -> Dimension:
    """Return one dimension. Raises CrankcheckError for an unknown name."""
    known = dimensions(scene)
    if name not in known:
        more = suggestion(name, known, "its dimensions are")
        raise CrankcheckError(f"{scene.name}: no dimension {name}; {more}")
    return known[name]


def with_dimensions(scene: Scene, values: Mapping[str, float]) -> Scene:
    """Return the scene with dimensions of its links and lines at other values.

    Raises CrankcheckError for an unknown name, a length that is not above 0, a dimension of the
    driver, and for cams, whose profiles depend on the dimensions.
    """
    if scene.cams:
        raise CrankcheckError(
            f"{scene.name}: its cams are cut for its dimensions; write another scene file instead"
        )
    points = {body: dict(each) for body, each in scene.points_of.items()}
    sliders: dict[str, Any] = dict(scene.sliders)
    for name, value in values.items():
        one = dimension(scene, name)
        if not math.isfinite(value) or (name in points and value <= 0.0):
            raise CrankcheckError(f"{scene.name}: {name}: found {value:g}; give a length above 0")
        for (kind, *names), shift in one.shifts.items():
            by = (value - one.value) * shift
            if kind == "driver":
                raise CrankcheckError(f"{scene.name}: {name} belongs to its law, not to its links")
            if kind == "point":
                body, point = names
                x, y = points[body][point]
                points[body][point] = (x + by.real, y + by.imag)
                continue
            slider = sliders[names[0]]
            x, y = slider.through_m
            change = {
                "through": {"through_m": (x + by.real, y + by.imag)},
                "direction": {"direction_rad": slider.direction_rad + by.real},
                "lean": {"angle_rad": slider.angle_rad + by.real},
            }[kind]
            sliders[names[0]] = replace(slider, **change)
    links = {n: replace(link, points=points[n]) for n, link in scene.links.items()}
    return replace(scene, ground=points[GROUND], links=links, sliders=sliders)
