"""A log of another assembly of the scene, from the beginning or from some instant on."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from analytic.kinematics import choices, chosen_groups
from analytic.structure.groups import Group, Triad
from analytic.structure.mobility import analyse
from models.errors import CrankcheckError
from reports.causes.account import CAUSE, CHOICE, NUMBER, Account
from reports.causes.inquiry import Inquiry
from reports.causes.world import World
from reports.output.numbers import listed

MOST_CHOICES = 6
"""Assemblies are looked at one by one up to so many choices: two to the power of it."""


def assembly(inquiry: Inquiry) -> Iterator[Account]:
    """Each other assembly that the log may be of."""
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
    """The accounts of an assembly: of the whole log, or of all that comes after an instant."""
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
    """The account of a log that goes over to an assembly on the way, from its best sample on."""
    try:
        others = inquiry.errors(world)
    except CrankcheckError:
        return
    gains = np.zeros(inquiry.rows)
    for column, excerpt in inquiry.excerpts.items():
        if excerpt.channel.kind.turns:
            others[column] = np.remainder(others[column] + math.pi, math.tau) - math.pi
        if column in inquiry.open:
            size = excerpt.size.rms
            gains += (excerpt.error / size) ** 2 - (others[column] / size) ** 2
    after = np.cumsum(gains[::-1])[::-1]  # what is gained where all from a sample on is of another
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
