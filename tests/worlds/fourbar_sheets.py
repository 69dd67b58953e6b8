"""Healthy sheets of some channels of the lecture's four-bar, at even times."""

from __future__ import annotations

import numpy as np

from analytic.kinematics import solve
from models.array import Array
from models.files import load_scene
from reports.causes import Cause, causes
from reports.logs.channel import Channel
from reports.logs.kinds import KINDS
from tests.worlds.sheets import Sheet

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
    """The sheet with the readings of so many samples later."""
    return at(sheet, sheet.time_s + samples * sheet.step_s, *columns)


def only(planted: Sheet) -> Cause:
    (cause,) = causes(planted.case)
    return cause
