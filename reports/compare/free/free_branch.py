"""Whether a free run is in an assembly that the truth is not in at that time."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np

from analytic.kinematics import solve_driven
from analytic.structure.mobility import analyse
from models.array import Mask
from models.errors import CrankcheckError
from reports.compare.branch import AWAY_RAD, CLOSED, HERE_RAD, MOST_CHOICES, stay
from reports.compare.errors import Departure
from reports.compare.free.free_beside import FreeBeside
from reports.quantities.free import GEOMETRY


def free_departure(beside: FreeBeside) -> Departure | None:
    """Where the first link left the assembly that the truth has at that time, while its loop stayed
    closed.

    What the truth goes through itself is no departure, and a phase that has run away is none: the
    links are held to the position that the run's own coordinate has. With several freedoms the
    phase alone tells.
    """
    if not beside.free.by_dyads or beside.no_geometry:
        return None
    closed = np.ones(beside.motion.time_s.shape, dtype=bool)
    for gap in beside.run.gaps.values():
        closed &= np.abs(gap) < CLOSED * beside.scene.longest_m
    left: list[tuple[int, str]] = []
    far = np.zeros_like(closed)
    try:
        tracks = beside.tracks((GEOMETRY.name,), beside.at_crank)
    except CrankcheckError:
        return None
    for track in tracks:
        if track.body_kind != "link":
            continue
        turned = np.remainder(track.error + np.pi, 2.0 * np.pi) - np.pi
        away = np.flatnonzero(closed & (np.abs(turned) > AWAY_RAD))
        far[away] = True
        if away.size:
            here = np.flatnonzero(np.abs(turned[: away[0]]) < HERE_RAD)
            left.append((int(here[-1]) if here.size else 0, track.body))
    if not left or not _elsewhere(beside, far):
        return None
    index, link = min(left)
    return Departure(link, float(beside.motion.time_s[index]), float(beside.crank[index]))


def _elsewhere(beside: FreeBeside, far: Mask) -> bool:
    """Whether the run stands in one of the assemblies of the scene at one of the samples ``far``,
    at its own driver angle."""
    scene = beside.scene
    keys = [group.branch_key for group in analyse(scene).groups if group.assemblies == 2]
    index = np.flatnonzero(far)[:: max(int(np.sum(far)) // 200, 1)]
    theta, still = beside.crank[index], np.zeros(index.size)
    logged = beside.motion.each_series(lambda series: series[index])
    for signs in itertools.product((1, -1), repeat=len(keys[:MOST_CHOICES])):
        branch = dict(zip(keys, signs, strict=False))
        other = replace(scene, branch={**scene.branch, **branch})
        there = np.ones(index.size, dtype=bool)
        try:
            motion = solve_driven(other, theta, still, still, points=(), sliders=(), bound=False)
        except CrankcheckError:
            continue
        stay(there, logged, motion.links)
        if there.any():
            return True
    return False
