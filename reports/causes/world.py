"""The scene, drive and frame that a hypothesis assumes for a log."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from analytic.kinematics import solve, solve_driven
from models.array import Array
from models.motion import LinkMotion, Motion, PointMotion, SliderMotion
from models.scene import Scene
from reports.compare.compare import Truth
from reports.logs.channel import Channel
from reports.logs.log_beside import AtCrank

Stamps = Callable[[Array], Array]
Orders = tuple[Array, Array, Array]
"""A position and its two rates."""
Drive = Callable[[Array], Orders]


@dataclass(frozen=True)
class LogFrame:
    """Frame of a log: all lengths times ``size``; seen from behind where ``mirrored`` (the y-axis
    reversed), then rotated by ``turn_rad``, then moved by ``shift_m``."""

    mirrored: bool = False
    turn_rad: float = 0.0
    shift_m: tuple[float, float] = (0.0, 0.0)
    size: float = 1.0

    def seen(self, motion: Motion) -> Motion:
        """Return a motion as seen in this frame."""
        sign, size = (-1.0 if self.mirrored else 1.0), self.size
        cos, sin = math.cos(self.turn_rad), math.sin(self.turn_rad)
        turned = size * np.array([[cos, sin], [-sign * sin, sign * cos]])
        shift = np.array(self.shift_m)
        return _changed(
            motion,
            lambda m: (sign * m.theta + self.turn_rad, sign * m.omega, sign * m.alpha),
            lambda m: (m.position @ turned + shift, m.velocity @ turned, m.acceleration @ turned),
            lambda m: (size * m.displacement, size * m.speed, size * m.acceleration),
        )


@dataclass(frozen=True)
class World:
    """A scene, the instants behind the ``stamps`` of the log, and the frame of view; rates are
    ``pace`` times the scene's. ``drive`` gives the driver's angle, rate and acceleration at
    instants, where it does not follow the scene's law."""

    scene: Scene
    drive: Drive | None = None
    stamps: tuple[Stamps, ...] = ()
    pace: float = 1.0
    frames: tuple[LogFrame, ...] = ()

    @staticmethod
    def of(truth: Truth) -> World:
        """Return the world of a reference, as it is driven."""
        return World(truth.scene, truth.driven_at if isinstance(truth, AtCrank) else None)

    def at(self, stamped: Array, channels: Iterable[Channel]) -> Motion:
        """Return the motion (T,) of measured bodies at stamps [s]. Raises CrankcheckError."""
        instants = stamped
        for change in reversed(self.stamps):
            instants = change(instants)
        names: dict[str, list[str]] = {"link": [], "point": [], "slider": []}
        for channel in channels:
            names[channel.kind.body_kind].append(channel.of)
            names["link"] += filter(None, [channel.relative_to])
        links, points, sliders = (tuple(dict.fromkeys(each)) for each in names.values())
        solved = partial(solve, self.scene, instants)
        if self.drive is not None:
            solved = partial(solve_driven, self.scene, *self.drive(instants), instants)
        motion = solved(links=links, points=points, sliders=sliders, bound=False)
        if self.pace != 1.0:
            motion = _paced(motion, self.pace)
        for frame in self.frames:
            motion = frame.seen(motion)
        return motion

    def stamped(self, change: Stamps) -> World:
        """Return the world with other instants behind the stamps of the log."""
        return replace(self, stamps=(*self.stamps, change))

    def later(self, by_s: float) -> World:
        """Return the world in which all that is logged belongs so much later."""
        return self.stamped(lambda stamps: stamps + by_s)

    def framed(self, frame: LogFrame) -> World:
        """Return the world with a further frame of the log."""
        return replace(self, frames=(*self.frames, frame))


def _paced(motion: Motion, pace: float) -> Motion:
    """Return a motion with rates taken over a time of another pace."""
    return _changed(
        motion,
        lambda m: (m.theta, pace * m.omega, pace**2 * m.alpha),
        lambda m: (m.position, pace * m.velocity, pace**2 * m.acceleration),
        lambda m: (m.displacement, pace * m.speed, pace**2 * m.acceleration),
    )


def _changed(
    motion: Motion,
    link: Callable[[LinkMotion], Orders],
    point: Callable[[PointMotion], Orders],
    slider: Callable[[SliderMotion], Orders],
) -> Motion:
    """Return a motion with changed positions and rates of its bodies."""
    return replace(
        motion,
        links={name: LinkMotion(*link(own)) for name, own in motion.links.items()},
        points={name: PointMotion(*point(own)) for name, own in motion.points.items()},
        sliders={name: SliderMotion(*slider(own)) for name, own in motion.sliders.items()},
    )
