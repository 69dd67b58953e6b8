"""Check that a run stayed on its branch: the other assembly of a closed loop is closed as well."""

import itertools
from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np

from analytic.kinematics import choices, chosen_groups, solve, solve_driven
from analytic.structure.mobility import analyse
from models.array import Array, Mask
from models.errors import CrankcheckError
from models.motion import LinkMotion, Motion
from reports.compare import compare, free_truth
from reports.compare.errors import Departure
from reports.quantities.free_and_elastic import GEOMETRY

AWAY_RAD = 0.5
"""Error from which on a link, in a closed loop, may be in the other assembly."""
CLOSED = 0.05
"""Opening of the pins below which a loop is closed, over the longest link."""
HERE_RAD = 0.02
"""Error below which a link is still on its branch."""
THERE_RAD = 0.1
"""Distance of all links from another assembly below which the mechanism is in it."""
MOST_CHOICES = 6
"""Largest number of choices of assembly: two to this power are tried one by one."""


def departure(beside: compare.Beside) -> Departure | None:
    """Return the place where the first link left the branch of the scene with its loop closed.

    A link that is far off in a closed loop has left its branch if the mechanism is in another
    assembly at that or a later sample; else it is off its place, and on its way.
    """
    tracks = beside.tracks(("angle",), beside.reference)
    far, left = _far_off(beside, ((track.body, track.error) for track in tracks))
    if left is None or not _elsewhere(beside, far):
        return None
    index, link = left
    time_s, driver = float(beside.motion.time_s[index]), float(beside.driver_rad[index])
    return Departure(link, time_s, driver, beside.scene.driver.unit)


def _far_off(
    beside: compare.Beside, errors: Iterable[tuple[str, Array]]
) -> tuple[Mask, tuple[int, str] | None]:
    """Return the samples at which links are far off while the loop is closed, by the ``errors`` of
    their angles; and the sample and link where this began first."""
    closed = np.ones(beside.motion.time_s.shape, dtype=bool)
    for gap in beside.run.gaps.values():
        closed &= np.abs(gap) < CLOSED * beside.scene.longest_m
    left: list[tuple[int, str]] = []
    far = np.zeros_like(closed)
    for link, error in errors:
        off = np.abs(error)
        away = np.flatnonzero(closed & (off > AWAY_RAD))
        far[away] = True
        if away.size:
            here = np.flatnonzero(off[: away[0]] < HERE_RAD)
            left.append((int(here[-1]) if here.size else 0, link))
    return far, min(left, default=None)


def _elsewhere(beside: compare.Beside, far: Mask) -> bool:
    """True if the mechanism is in another assembly at one of the samples ``far``.

    Assemblies are the choices of their groups, in solving order: two of a dyad, up to six of a
    triad, as at the start. An assembly that does not exist at all samples is skipped: a run that
    changed to it is off its place anyway. So is one that shares its first choices with an assembly
    already excluded by the links of these alone.
    """
    scene, times = beside.scene, beside.motion.time_s
    groups = chosen_groups(analyse(scene))[:MOST_CHOICES]
    keys = [group.branch_key for group in groups]
    _, *others = itertools.product(*(choices(scene, group) for group in groups))
    ruled_out: set[tuple[int, ...]] = set()
    for chosen in others:
        if any(chosen[:n] in ruled_out for n in range(1, len(chosen) + 1)):
            continue
        branch = dict(zip(keys, chosen, strict=True))
        other = replace(scene, branch={**scene.branch, **branch})
        try:
            motion = solve(other, times, points=(), sliders=(), bound=False)
        except CrankcheckError:
            continue
        there = far.copy()
        rest = dict(motion.links)
        for n, group in enumerate(groups, start=1):
            placed = {name: rest.pop(name) for name in group.bodies if name in rest}
            stay(there, beside.motion, placed)
            if not there.any():
                ruled_out.add(chosen[:n])
                break
        else:
            stay(there, beside.motion, rest)
            if there.any():
                return True
    return False


def stay(there: Mask, logged: Motion, links: Mapping[str, LinkMotion]) -> None:
    """Remove the samples at which one of the links, as far as they are logged, is elsewhere."""
    for name, link in links.items():
        if name not in logged.links or np.all(np.isnan(logged.links[name].theta)):
            continue
        there &= np.abs(_turned(logged.links[name].theta - link.theta)) < THERE_RAD


def _turned(angle: Array) -> Array:
    """Return angles [rad] less whole turns."""
    return np.asarray(np.remainder(angle + np.pi, 2.0 * np.pi) - np.pi)


def free_departure(beside: free_truth.FreeBeside) -> Departure | None:
    """Return the place where the first link left the reference's assembly at that time, with its
    loop closed.

    A change that the reference makes itself is no departure, nor is a phase that has run away: the
    links are compared with the position at the run's own coordinate. With several freedoms only the
    phase shows it.
    """
    truth = beside.free
    if not truth.by_dyads or beside.no_geometry:
        return None
    try:
        tracks = beside.tracks((GEOMETRY.name,), beside.at_crank)
    except CrankcheckError:
        return None
    links = (track for track in tracks if track.body_kind == "link")
    far, left = _far_off(beside, ((track.body, _turned(track.error)) for track in links))
    if left is None or not _free_elsewhere(beside, far):
        return None
    index, link = left
    return Departure(link, float(beside.motion.time_s[index]), float(beside.crank[index]))


def _free_elsewhere(beside: free_truth.FreeBeside, far: Mask) -> bool:
    """True if the run is in any assembly of its own driver angle at one of the samples ``far``."""
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
