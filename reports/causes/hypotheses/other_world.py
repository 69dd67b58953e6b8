"""A log of another assembly, or of a driver that turns or starts in another way."""

import itertools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import fields, replace

import numpy as np

from analytic.kinematics import choices, chosen_groups
from analytic.structure.groups import Group, Triad
from analytic.structure.mobility import analyse
from models.array import Array
from models.errors import CrankcheckError
from models.scene.laws import ConstantSpeed, Law
from reports.causes.account import CAUSE, CHOICE, NUMBER, Account, fitted
from reports.causes.cause import within_half_a_turn
from reports.causes.inquiry import Inquiry
from reports.causes.world import World
from reports.output.numbers import listed

MOST_CHOICES = 6
"""Largest number of choices of assembly: two to this power are tried one by one."""


def assembly(inquiry: Inquiry) -> Iterator[Account]:
    """Yield accounts of each other assembly."""
    scene = inquiry.world.scene
    groups = chosen_groups(analyse(scene))[:MOST_CHOICES]
    for count in range(1, len(groups) + 1):
        for chosen in itertools.combinations(groups, count):
            for numbers in itertools.product(*(choices(scene, group)[1:] for group in chosen)):
                keys = (group.branch_key for group in chosen)
                branch = dict(zip(keys, numbers, strict=True))
                other = replace(scene, branch={**scene.branch, **branch})
                yield from _told(inquiry, replace(inquiry.world, scene=other), chosen, branch)


def _told(
    inquiry: Inquiry, world: World, groups: Sequence[Group | Triad], branch: Mapping[str, int]
) -> Iterator[Account]:
    """Yield the accounts of an assembly, for the whole log or from an instant on."""
    links = inquiry.world.scene.links
    names = listed([name for group in groups for name in group.bodies if name in links])
    which = "another" if any(isinstance(group, Triad) for group in groups) else "the other"
    entries = listed([f"{key} = {sign:+d}" for key, sign in branch.items()])
    phrase = (
        f"the log is of {which} assembly at {listed(list(branch))} ({names}): "
        f"{entries.replace('+', '')} under [branch] of the scene"
    )
    cost = CAUSE + CHOICE * (len(groups) - 1)
    told = inquiry.account_of_world("branch", cost, world, phrase)
    if told is not None:
        yield told
    else:
        yield from _later(inquiry, world, cost + NUMBER, phrase)


def _later(inquiry: Inquiry, world: World, cost: float, phrase: str) -> Iterator[Account]:
    """Yield the account of a log that changes to an assembly midway, from its best sample on."""
    try:
        others = inquiry.errors(world)
    except CrankcheckError:
        return
    gains = np.zeros(inquiry.rows)
    for column, excerpt in inquiry.excerpts.items():
        if excerpt.channel.kind.turns:
            others[column] = within_half_a_turn(others[column])
        if column in inquiry.open:
            size = excerpt.size.rms
            gains += (excerpt.error / size) ** 2 - (others[column] / size) ** 2
    after = np.cumsum(gains[::-1])[::-1]  # gain with the other world from a sample on
    first = int(np.argmax(after))
    if first == 0 or after[first] <= 0.0:
        return
    place = np.arange(inquiry.rows)
    errors = {
        column: np.where(place < first, excerpt.error, others[column])
        for column, excerpt in inquiry.excerpts.items()
    }
    instant = next(iter(inquiry.excerpts.values())).instants[first]
    told = inquiry.account("branch", cost, errors, f"from t = {instant:.4g} s on {phrase}")
    if told is not None and not inquiry.spoilt(errors):
        yield told


SIGNED = {"speed_rad_s", "acceleration_rad_s2", "amplitude_rad", "before_rad_s", "after_rad_s"}
"""Numbers of a law that change sign where the driver turns the other way."""
STARTS = (0.0, 0.5 * math.pi, math.pi, -0.5 * math.pi)
"""Angles of the driver, and rotations of the plane, from which a fit starts."""


def fitted_from_starts(residual: Callable[[Array], Array], delta: Sequence[float]) -> Array | None:
    """Return the angle, and further numbers that start at 0, with the least residual, if any."""
    zeros = [0.0] * (len(delta) - 1)
    tried = (fitted(residual, [start, *zeros], delta) for start in STARTS)
    found = [each for each in tried if each is not None]
    return min(found, key=lambda each: float(np.sum(residual(each) ** 2)), default=None)


def backwards(inquiry: Inquiry) -> Iterator[Account | None]:
    """Yield accounts of the driver turning the other way from the same start, with rates that show
    it or, as from a sensor of the speed alone, do not."""
    if inquiry.world.drive is not None:
        return
    law = inquiry.world.scene.driver.law
    names = SIGNED & {each.name for each in fields(law)}  # type: ignore[arg-type]
    signs = {name: -getattr(law, name) for name in names}
    world = _with_law(inquiry.world, replace(law, **signs))  # type: ignore[type-var]
    yield inquiry.account_of_world("reversed", CAUSE, world, "the driver turns the other way")
    elsewhere = inquiry.world.stamped(lambda stamps: -stamps)
    phrase = "the driver turns the other way, and the rates have the signs that they have forwards"
    yield inquiry.account_of_world("reversed", CAUSE + CHOICE, elsewhere, phrase)


def start_angle(inquiry: Inquiry) -> Iterator[Account | None]:
    """Yield the account of another start of the driver; at constant speed the clock covers it."""
    law = inquiry.world.scene.driver.law
    another = isinstance(law, ConstantSpeed) or inquiry.world.drive is not None
    if another or not inquiry.unexplained:
        return
    thin, columns = inquiry.thin, inquiry.unclaimed

    def residual(angle: Array) -> Array:
        return thin.misfit(_with_law(thin.world, law.turned(float(angle[0]))), columns)

    found = fitted_from_starts(residual, [1e-6])
    if found is None:
        return
    angle = float(found[0])
    phrase = f"the driver starts {math.degrees(angle):+.4g} deg from where it starts in the scene"
    world = _with_law(inquiry.world, law.turned(angle))
    yield inquiry.account_of_world("start", CAUSE + NUMBER, world, phrase)


def _with_law(world: World, law: Law) -> World:
    scene = world.scene
    return replace(world, scene=replace(scene, driver=replace(scene.driver, law=law)))
