"""Gradients by differences of a whole mechanism in eighty digits, one dimension changed."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from mpmath import mp, mpf

from models.motion import Motion
from models.scene import GROUND, Scene
from tests.analytic.chain import Chain, Solved, coordinates, held_points
from tests.analytic.change_points.jets import Jet, Number

SMALL = mpf(10) ** -19
"""Step of a difference: its error is the square of it, and that of a solution over it."""
STEPS = SMALL, -SMALL


def changed(scene: Scene, name: str, by: Number) -> Scene:
    """The scene with one of its dimensions, by name, changed in fifty digits."""
    what, *more = name.split(".")
    if more and what in scene.sliders and more[0] in ("offset", "direction", "angle"):
        slider: Any = scene.sliders[what]
        c, s = mp.cos_sin(mpf(slider.direction_rad))
        x, y = slider.through_m
        new = {
            "offset": {"through_m": (x - by * s, y + by * c)},
            "direction": {"direction_rad": slider.direction_rad + by},
            "angle": {"angle_rad": slider.angle_rad + by},
        }[more[0]]
        return replace(scene, sliders={**scene.sliders, what: replace(slider, **new)})
    points: dict[str, Any] = dict(scene.points_of[what])
    (x0, y0), others = next(iter(points.values())), list(points)[1:]
    point = more[0] if more else next(p for p in others if points[p] != (x0, y0))
    x, y = (mpf(c) for c in points[point])
    if more:
        step = (by, 0) if more[1] == "x" else (0, by)
    else:
        length = mp.hypot(x - x0, y - y0)
        step = (by * (x - x0) / length, by * (y - y0) / length)
    points[point] = (x + step[0], y + step[1])
    if what == GROUND:
        return replace(scene, ground=points)
    link = replace(scene.links[what], points=points)
    return replace(scene, links={**scene.links, what: link})


class ChangedChain(Chain):
    """The constraints of a scene with one dimension changed."""

    def __init__(self, scene: Scene, name: str, by: Number) -> None:
        super().__init__(scene)
        self.ahead = by if name.startswith("driver.") else mpf(0)
        if not self.ahead:
            self.scene = changed(scene, name, by)
            self.held = held_points(self.scene)

    def _driven(self, frames: Mapping[str, Any], drive: Jet) -> Jet:
        return super()._driven(frames, drive + self.ahead)


def differences(scene: Scene, motion: Motion, index: int, name: str) -> Solved:
    """The derivatives of everything that moves by a dimension, at a sample of its motion."""
    start, time_s = coordinates(scene, motion, index), float(motion.time_s[index])
    with mp.workdps(80):  # next to singular positions fifty do not settle
        return _differences(*(ChangedChain(scene, name, by).solve(time_s, start) for by in STEPS))


def _differences(ahead: Solved, back: Solved) -> Solved:

    def slope(one: Any, other: Any) -> Any:
        return (
            (one - other) * (1 / (2 * SMALL))
            if isinstance(one, Jet)
            else type(one)(slope(one.x, other.x), slope(one.y, other.y))
        )

    return Solved(
        *(
            {
                key: slope(each, getattr(back, kind)[key])
                for key, each in getattr(ahead, kind).items()
            }
            for kind in ("links", "points", "sliders")
        )
    )
