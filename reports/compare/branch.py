"""Whether a run stayed on its branch: the other assembly of a closed loop is closed as well."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from analytic.kinematics import solve
from models.errors import CrankcheckError
from models.motion import Motion
from reports.compare.beside import Beside
from reports.compare.errors import Departure

AWAY_RAD = 0.5
"""A link that is off by so much, in a loop that is closed, may stand in the other assembly."""
CLOSED = 0.05
"""A loop whose pins are open by less, over the longest link, is closed."""
HERE_RAD = 0.02
"""A link that is off by less is still on its branch."""
THERE_RAD = 0.1
"""A mechanism whose links are all off another assembly by less stands in that one."""
MOST_CHOICES = 6
"""Assemblies are looked at one by one up to so many choices: two to the power of it."""


def departure(beside: Beside) -> Departure | None:
    """Where the first link left the branch of the scene while its loop stayed closed.

    A link that is far off in a loop that is closed has left its branch if the mechanism stands in
    another assembly at that or a later sample; else it is off its place, and on its way.
    """
    driver_rad = beside.driver_rad
    closed = np.ones(driver_rad.shape, dtype=bool)
    for gap in beside.run.gaps.values():
        closed &= np.abs(gap) < CLOSED * beside.scene.longest_m
    left: list[tuple[int, str]] = []
    far = np.zeros_like(closed)
    for track in beside.places:
        if track.quantity != "angle":
            continue
        off = np.abs(track.error)
        away = np.flatnonzero(closed & (off > AWAY_RAD))
        far[away] = True
        if away.size:
            here = np.flatnonzero(off[: away[0]] < HERE_RAD)
            left.append((int(here[-1]) if here.size else 0, track.body))
    if not left or not _elsewhere(beside, far):
        return None
    index, link = min(left)
    return Departure(link, float(beside.motion.time_s[index]), float(driver_rad[index]))


def _elsewhere(beside: Beside, far: np.ndarray) -> bool:
    """Whether the mechanism stands in another assembly at one of the samples ``far``."""
    motion = beside.motion
    for other in _assemblies(beside):
        off = np.zeros(len(motion.time_s))
        for name, link in other.links.items():
            turn = motion.links[name].theta - link.theta if name in motion.links else np.nan
            off = np.maximum(off, np.abs(np.remainder(turn + np.pi, 2.0 * np.pi) - np.pi))
        if np.any(far & (off < THERE_RAD)):
            return True
    return False


def _assemblies(beside: Beside) -> Iterator[Motion]:
    """The motions of the other assemblies, as far as they can be had at all of the samples.

    One that cannot is passed over: a run that went over to it is off its place all the same.
    """
    scene = beside.scene
    keys = list(beside.reference.conditioning)[:MOST_CHOICES]
    for signs in itertools.product((1, -1), repeat=len(keys)):
        if -1 not in signs:
            continue
        branch = {k: s * scene.branch.get(k, 1) for k, s in zip(keys, signs, strict=True)}
        other = replace(scene, branch={**scene.branch, **branch})
        try:
            yield solve(other, beside.motion.time_s, points=(), sliders=(), bound=False)
        except CrankcheckError:
            continue
