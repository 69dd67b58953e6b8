"""A driver that turns the other way, or starts at another angle."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import fields, replace

import numpy as np

from models.array import Array
from models.laws import ConstantSpeed, Law
from reports.causes.account import CAUSE, CHOICE, NUMBER, Account
from reports.causes.fit import fitted
from reports.causes.inquiry import Inquiry
from reports.causes.world import World

SIGNED = (
    "speed_rad_s",
    "acceleration_rad_s2",
    "amplitude_rad",
    "before_rad_s",
    "after_rad_s",
)
"""What of a law changes its sign where the driver turns the other way."""
STARTS = (0.0, 0.5 * math.pi, math.pi, -0.5 * math.pi)


def backwards(inquiry: Inquiry) -> Iterator[Account]:
    """The driver turning the other way from the same start, and rates that show it or, as from a
    sensor of the speed alone, do not."""
    if inquiry.world.drive is not None:
        return
    law = inquiry.world.scene.driver.law
    names = {each.name for each in fields(law)}  # type: ignore[arg-type]
    signs = {name: -getattr(law, name) for name in SIGNED if name in names}
    world = _driven(inquiry.world, replace(law, **signs))  # type: ignore[type-var]
    told = inquiry.account_of_world("reversed", CAUSE, world, "the driver turns the other way")
    if told is not None:
        yield told
    elsewhere = inquiry.world.stamped(lambda stamps: -stamps)
    phrase = "the driver turns the other way, and the rates have the signs that they have forwards"
    told = inquiry.account_of_world("reversed", CAUSE + CHOICE, elsewhere, phrase)
    if told is not None:
        yield told


def start_angle(inquiry: Inquiry) -> Iterator[Account]:
    """The driver starting at another angle; at constant speed that is a clock that does."""
    law = inquiry.world.scene.driver.law
    another = isinstance(law, ConstantSpeed) or inquiry.world.drive is not None
    if another or not inquiry.unexplained:
        return
    thin, columns = inquiry.thin, inquiry.unclaimed

    def residual(angle: Array) -> Array:
        errors = thin.errors(_driven(thin.world, law.turned(float(angle[0]))), columns)
        return np.concatenate([errors[c] / thin.excerpts[c].size.rms for c in columns])

    tried = (fitted(residual, [start], [1e-6]) for start in STARTS)
    found = [each for each in tried if each is not None]
    if not found:
        return
    angle = float(min(found, key=lambda each: float(np.sum(residual(each) ** 2)))[0])
    phrase = f"the driver starts {math.degrees(angle):+.4g} deg from where it starts in the scene"
    world = _driven(inquiry.world, law.turned(angle))
    told = inquiry.account_of_world("start", CAUSE + NUMBER, world, phrase)
    if told is not None:
        yield told


def _driven(world: World, law: Law) -> World:
    """The world with another law of its driver."""
    scene = world.scene
    return replace(world, scene=replace(scene, driver=replace(scene.driver, law=law)))
