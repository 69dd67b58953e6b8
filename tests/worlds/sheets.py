"""Logs of a scene as a user may have them, healthy or with one fault planted in them; and healthy
ones of some channels of the lecture's four-bar, at even times.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.random import Generator

from analytic.kinematics import solve
from models.array import Array
from models.files.reading import load_scene
from models.motion import Motion
from models.scene import Scene
from reports.causes.cause import Cause, LogCase
from reports.causes.find import causes
from reports.compare.compare import Truth
from reports.logs.channel import Channel, OwnLog, Reading
from reports.logs.kinds import KINDS

TURNING = {0: ("rad", "deg"), 1: ("rad/s", "deg/s", "rpm"), 2: ("rad/s^2", "deg/s^2")}
MOVING = {0: ("m", "mm", "in"), 1: ("m/s", "mm/s", "in/s"), 2: ("m/s^2", "mm/s^2")}


@dataclass(frozen=True)
class Sheet:
    """A log in the making: the instants (T,) that its stamps say, and readings in SI by column, as
    they should be; ``limits`` by column [SI]."""

    scene: Scene
    time_s: Array
    channels: Mapping[str, Channel]
    values: Mapping[str, Array]
    limits: Mapping[str, float]
    signals: Mapping[str, Array] = field(default_factory=dict)
    stamp: tuple[str, str] = ("t", "s")

    @property
    def case(self) -> LogCase:
        readings = tuple(
            Reading(channel, self.values[column], self.time_s)
            for column, channel in self.channels.items()
        )
        log = OwnLog("planted", self.scene, self.time_s, readings, self.stamp)
        return LogCase(log, Truth(self.scene, bound=False), self.limits)

    def put(self, values: Mapping[str, Array]) -> Sheet:
        return replace(self, values={**self.values, **values})

    def of(self, motion: Motion, columns: Sequence[str] | None = None) -> Sheet:
        """The sheet with the readings that a motion gives, in some columns or all."""
        return self.put(
            {
                column: wrapped(self.channels[column], self.channels[column].expected(motion))
                for column in (self.channels if columns is None else columns)
            }
        )

    def columns(self, accepts: Callable[[Channel], bool] = lambda channel: True) -> list[str]:
        return [column for column, channel in self.channels.items() if accepts(channel)]

    def moving(self, accepts: Callable[[Channel], bool] = lambda channel: True) -> list[str]:
        """Those of them that do not stay the same number."""
        return [c for c in self.columns(accepts) if np.ptp(self.signals[c]) > 1e-6]

    def telling(self) -> list[str]:
        """Those that are not 0 throughout."""
        return [c for c in self.columns() if np.max(np.abs(self.signals[c])) > 1e-6]

    def bending(self, accepts: Callable[[Channel], bool] = lambda channel: True) -> list[str]:
        """Those that do not go on evenly, so that a delay can be told from another zero."""
        found = []
        for column in self.moving(accepts):
            line = np.polyval(np.polyfit(self.time_s, self.signals[column], 1), self.time_s)
            if np.max(np.abs(line - self.signals[column])) > 1e-6:
                found.append(column)
        return found

    def uneven(self) -> list[str]:
        """Those that are no angles in one turn, and no pure sine, of which means are as a gain."""
        crank = self.scene.links[self.scene.driver.link]
        own = {*crank.points, crank.name}
        return self.bending(lambda channel: not channel.wrapped and channel.of not in own)

    @property
    def step_s(self) -> float:
        return float(np.median(np.diff(self.time_s)))


def wrapped(channel: Channel, values: Array) -> Array:
    if not channel.wrapped:
        return values
    return np.remainder(values + math.pi, math.tau) - math.pi


def times(scene: Scene, rng: Generator, rows: int, turns: float, *, even: bool) -> Array:
    """Instants [s] over so many turns, even ones or such that no two intervals are alike."""
    step = turns * scene.driver.law.period_s / rows
    place = np.arange(rows, dtype=float)
    if not even:
        place[1:] += rng.uniform(-0.3, 0.3, rows - 1)
    return place * step


def sheet(
    scene: Scene,
    rng: Generator,
    *,
    rows: int = 600,
    turns: float = 2.5,
    even: bool = True,
    most: int = 8,
    limit: float = 1e-3,
    noise: float = 0.05,
) -> Sheet:
    """A healthy log of some channels, among them two angles at least and their rates, in units at
    random, noisy by a part of the limits."""
    time_s = times(scene, rng, rows, turns, even=even)
    channels = _channels(scene, rng, most)
    motion = solve(scene, time_s, bound=False)
    signals = {column: channel.expected(motion) for column, channel in channels.items()}
    limits = {column: limit * _scale(scene, channel) for column, channel in channels.items()}
    healthy = Sheet(scene, time_s, channels, {}, limits, signals).of(motion)
    disturbed = {
        column: values + noise * limits[column] * rng.uniform(-1.0, 1.0, rows)
        for column, values in healthy.values.items()
    }
    return healthy.put(disturbed)


def _channels(scene: Scene, rng: Generator, most: int) -> dict[str, Channel]:
    """Channels at random: an angle and its rate of two links, and others besides."""
    links = list(rng.permutation(list(scene.links)))
    moving = [p for p in scene.pins if p not in scene.ground]
    choice: list[tuple[str, str, str]] = []
    for link in links[:2]:
        choice += [("link", "angle", link), ("link", "angular velocity", link)]
    choice = choice[: max(1, most)]
    others = [("link", "angle", link) for link in links[2:]]
    others += [("link", "angular acceleration", link) for link in links]
    others += [("point", kind, p) for p in moving for kind in ("x", "y", "vx", "vy", "ax")]
    others += [("slider", k, s) for s in scene.sliders for k in ("displacement", "speed")]
    for place in rng.permutation(len(others))[: max(0, most - len(choice))]:
        choice.append(others[place])
    found = {}
    for number, (body, name, of) in enumerate(choice):
        kind = KINDS[body, name]  # type: ignore[index]
        units = (TURNING if body == "link" else MOVING)[kind.order]
        column = f"c{number}_{of}"
        found[column] = Channel(
            column,
            kind,
            str(of),
            str(rng.choice(units)),
            sign=int(rng.choice([1, 1, 1, -1])),
            wrapped=bool(kind.turns and rng.random() < 0.4),
        )
    return found


def _scale(scene: Scene, channel: Channel) -> float:
    speed = scene.driver.law.peak_speed_rad_s
    length = 1.0 if channel.kind.body_kind == "link" else scene.longest_m
    return float(length * speed**channel.kind.order)


SCENE = load_scene("fourbar-lecture-1")
OMEGA, ANGLE = KINDS["link", "angular velocity"], KINDS["link", "angle"]


def of(*channels: Channel, rows: int = 241, turns: float = 2.0) -> Sheet:
    """A healthy sheet of some channels of the four-bar, with limits of 1e-3 times its speed."""
    time_s = np.linspace(0.0, turns * SCENE.driver.law.period_s, rows)
    motion = solve(SCENE, time_s, bound=False)
    limits = {each.column: 1e-3 * 10.0**each.kind.order for each in channels}
    by_column = {each.column: each for each in channels}
    signals = {each.column: each.expected(motion) for each in channels}
    return Sheet(SCENE, time_s, by_column, {}, limits, signals).of(motion)


def angle(link: str, unit: str = "rad", **options: object) -> Channel:
    return Channel(f"{link}_a", ANGLE, link, unit, **options)


def omega(link: str, unit: str = "rad/s", **options: object) -> Channel:
    return Channel(f"{link}_w", OMEGA, link, unit, **options)


def at(sheet: Sheet, time_s: Array, *columns: str) -> Sheet:
    """The sheet with the readings of other instants, in some columns or all."""
    return sheet.of(solve(SCENE, time_s, bound=False), columns or None)


def later(sheet: Sheet, samples: float, *columns: str) -> Sheet:
    return at(sheet, sheet.time_s + samples * sheet.step_s, *columns)


def only(planted: Sheet) -> Cause:
    (cause,) = causes(planted.case)
    return cause
