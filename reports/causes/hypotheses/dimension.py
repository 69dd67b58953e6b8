"""A length, pivot or line of the scene that differs from the logged mechanism's."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from models.array import Array
from models.errors import CrankcheckError, ReachError
from models.scene import GROUND, Link, Scene, Slider
from reports.causes.account import CAUSE, CHOICE, NUMBER, Account, change, fitted, number
from reports.causes.inquiry import Inquiry
from reports.causes.world import World

MOST = 60
"""Number of dimensions that are examined."""
MOST_FITTED = 4
"""Number of dimensions that are fitted: the most likely by a straight line."""
LEAST_GAIN = 0.25
"""Part of the squares of the errors that a straight line has to remove."""
SENSITIVE = 1e-12
"""Sum of squares of the reference's change with a dimension, below which it counts as 0."""
ROUNDS = 6
BEST = 2e-3
"""Remaining part of the error of a single channel too well explained to look for a dimension."""
SLIGHT = 1e-6
"""Change by which slopes are taken, over the longest link or in radians."""
FARTHEST = 1.0
"""Largest change of a dimension, over the longest link or in radians."""


@dataclass(frozen=True)
class DimensionFault:
    """One number of a scene, in ``unit`` m or rad: its name, its value, and the scene with another
    value. ``point`` is common to the two coordinates of one point."""

    name: str
    value: float
    change: Callable[[Scene, float], Scene]
    unit: str = "m"
    point: str = ""

    def other(self, by: float, scene: Scene) -> float:
        """Return the value changed by a part of the longest link of a scene, or an angle [rad]."""
        return self.value + by * (scene.longest_m if self.unit == "m" else 1.0)


def dimension(inquiry: Inquiry) -> Iterator[Account | None]:
    """Yield accounts of the dimensions that explain most, alone or both of a point."""
    columns = list(inquiry.unclaimed)
    rests = [account.rests.get(columns[0], 1.0) for account in inquiry.accounts if columns]
    if not columns or (len(columns) == 1 and min(rests, default=1.0) < BEST):
        return
    scene = inquiry.world.scene
    likely = _likely(inquiry, columns, dimensions(scene)[:MOST])
    singles = [(one,) for one in likely[:MOST_FITTED]]
    points = {one.point: () for one in likely[: 2 * MOST_FITTED] if one.point}
    both = [tuple(one for one in likely if one.point == point) for point in points]
    pairs = [each for each in both if len(each) == 2][:2]
    yield from (_told(inquiry, columns, chosen) for chosen in (*singles, *pairs))


def dimensions(scene: Scene) -> list[DimensionFault]:
    """Return all numbers that determine the geometry of a scene."""
    found: list[DimensionFault] = []
    for point, place in scene.ground.items():
        for axis in (0, 1):
            name, where = f"{'xy'[axis]} of the ground pivot {point}", f"ground {point}"
            found.append(
                DimensionFault(name, place[axis], partial(_pivot, point, axis), point=where)
            )
    for link in scene.links.values():
        found += _of_link(link)
    for slider in scene.sliders.values():
        found += _of_slider(slider)
    return found


def _pivot(point: str, axis: int, scene: Scene, value: float) -> Scene:
    place = _with_axis(scene.ground[point], axis, value)
    return replace(scene, ground={**scene.ground, point: place})


def _of_link(link: Link) -> Iterator[DimensionFault]:
    """Yield the distance of the first two points of a link, and the coordinates of the others."""
    names = list(link.points)
    if len(names) > 1:
        (x0, y0), (x1, y1) = (link.points[name] for name in names[:2])
        length = math.hypot(x1 - x0, y1 - y0)
        words = f"length {names[0]}{names[1]} of {link.name}"
        if length > 0.0:
            yield DimensionFault(words, length, partial(_length, link.name, names[0], names[1]))
    for point in names[2:]:
        for axis in (0, 1):
            words = f"{'xy'[axis]} of {point} in the frame of {link.name}"
            changed = partial(_coordinate, link.name, point, axis)
            where = f"{link.name} {point}"
            yield DimensionFault(words, link.points[point][axis], changed, point=where)


def _length(name: str, first: str, second: str, scene: Scene, value: float) -> Scene:
    (x0, y0), (x1, y1) = (scene.links[name].points[point] for point in (first, second))
    if value <= 0.0:
        raise ReachError(f"{name} of a length of {value:.4g} m")
    ratio = value / math.hypot(x1 - x0, y1 - y0)
    return _with_point(scene, name, second, (x0 + ratio * (x1 - x0), y0 + ratio * (y1 - y0)))


def _coordinate(name: str, point: str, axis: int, scene: Scene, value: float) -> Scene:
    return _with_point(scene, name, point, _with_axis(scene.links[name].points[point], axis, value))


def _with_point(scene: Scene, name: str, point: str, place: tuple[float, float]) -> Scene:
    link = scene.links[name]
    link = replace(link, points={**link.points, point: place})
    return replace(scene, links={**scene.links, name: link})


def _of_slider(slider: Slider) -> Iterator[DimensionFault]:
    """Yield the offset of the line to its left from its place in the scene, and its directions."""
    line = f"the line of slider {slider.name}"
    sine, cosine = math.sin(slider.direction_rad), math.cos(slider.direction_rad)
    x, y = slider.through_m

    def other(name: str, scene: Scene, value: Any) -> Scene:
        changed = replace(slider, **{name: value})
        return replace(scene, sliders={**scene.sliders, slider.name: changed})

    def beside(scene: Scene, value: float) -> Scene:
        return other("through_m", scene, (x - value * sine, y + value * cosine))

    where = "" if slider.on == GROUND else f" on {slider.on}"
    yield DimensionFault(f"distance of {line}{where} to its left", 0.0, beside)
    for name, words in (
        ("direction_rad", f"direction of {line}{where}"),
        *([("angle_rad", f"angle of {slider.link} to {line}")] if slider.link is not None else []),
    ):
        yield DimensionFault(words, getattr(slider, name), partial(other, name), "rad")


def _with_axis(place: tuple[float, float], axis: int, value: float) -> tuple[float, float]:
    return (value, place[1]) if axis == 0 else (place[0], value)


def _residual(
    inquiry: Inquiry, columns: Sequence[str], chosen: Sequence[DimensionFault]
) -> Callable[[Array], Array]:
    """Return the residual function of columns, each over its size, for changes of dimensions; it
    raises CrankcheckError where there is no such mechanism."""
    return lambda changes: inquiry.misfit(_with_dimensions(inquiry, chosen, changes), columns)


def _with_dimensions(inquiry: Inquiry, chosen: Sequence[DimensionFault], changes: Array) -> World:
    scene = inquiry.world.scene
    for one, by in zip(chosen, changes, strict=True):
        scene = one.change(scene, one.other(float(by), inquiry.world.scene))
    return replace(inquiry.world, scene=scene)


def _likely(
    inquiry: Inquiry, columns: Sequence[str], every: Sequence[DimensionFault]
) -> list[DimensionFault]:
    """Return the dimensions that affect the reference, by the residual of a straight line."""
    thin, found = inquiry.thin, []
    errors = np.concatenate([thin.excerpts[c].error / thin.excerpts[c].size.rms for c in columns])
    for number_of, one in enumerate(every):
        try:
            slope = (_residual(thin, columns, (one,))(np.array([SLIGHT])) - errors) / SLIGHT
        except CrankcheckError:
            continue
        size = float(slope @ slope)
        along = float(slope @ errors)
        gained = along * along / size if size > SENSITIVE else 0.0
        if gained > LEAST_GAIN * float(errors @ errors):
            found.append((-gained, number_of))
    return [every[number_of] for _, number_of in sorted(found)]


def _told(
    inquiry: Inquiry, columns: Sequence[str], chosen: Sequence[DimensionFault]
) -> Account | None:
    """Return the account of other values of dimensions; fitted again without the channels that it
    does not explain, which may have another fault."""
    start = [0.0] * len(chosen)
    for _ in range(2):
        delta = [SLIGHT] * len(chosen)
        found = fitted(_residual(inquiry.thin, columns, chosen), start, delta, ROUNDS)
        if found is None or np.any(np.abs(found) > FARTHEST):
            return None
        told = _account(inquiry, chosen, found)
        explained = [] if told is None else [c for c in columns if c in told.rests]
        if not explained or len(explained) == len(columns):
            return told
        columns, start = explained, list(found)
    return told


def _account(inquiry: Inquiry, chosen: Sequence[DimensionFault], found: Array) -> Account | None:
    words = []
    for one, by in zip(chosen, found, strict=True):
        value = one.other(float(by), inquiry.world.scene)
        shown = [value, one.value] if one.unit == "m" else [*map(math.degrees, (value, one.value))]
        unit = "m" if one.unit == "m" else "deg"
        share = f" ({change(*shown)})" if one.value and one.unit == "m" else ""
        words.append(
            f"{one.name} is {number(shown[0], 5)} {unit} in the log, {number(shown[1], 5)} {unit} "
            f"in the scene{share}"
        )
    cost = CAUSE + CHOICE + NUMBER * len(chosen)
    world = _with_dimensions(inquiry, chosen, found)
    told = inquiry.account_of_world("length", cost, world, " and ".join(words))
    return told if told and inquiry.no_chance(told) else None
