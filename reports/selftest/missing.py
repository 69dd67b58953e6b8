"""Faults of a log that is silent about something."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from models.scene import Scene
from reports.selftest.fault import Fault, switched
from reports.selftest.logs import WHEN, last, moved, output, spoilt, with_link
from sim.engine import Run


def _end_missing(scene: Scene, done: Run) -> Run:
    return with_link(done, last(scene), theta=spoilt(output(scene, done).theta, -1, np.nan))


def _infinite(scene: Scene, done: Run) -> Run:
    return with_link(done, last(scene), omega=spoilt(output(scene, done).omega, WHEN, np.inf))


def _without_link(scene: Scene, done: Run) -> Run:
    motion = moved(done)
    links = {name: part for name, part in motion.links.items() if name != last(scene)}
    return replace(done, motion=replace(motion, links=links))


def _without_point(_: Scene, done: Run) -> Run:
    motion = moved(done)
    points = {name: part for name, part in motion.points.items() if name != "C"}
    return replace(done, motion=replace(motion, points=points))


def _silent(scene: Scene, done: Run) -> Run:
    """An engine that reports accelerations, of one link NaN throughout."""
    alpha = np.full_like(output(scene, done).alpha, np.nan)
    return replace(with_link(done, last(scene), alpha=alpha), reports_accelerations=True)


FAULTS = tuple(
    Fault("missing", name, what, "CC109", switched(change))
    for name, what, change in (
        ("nan-at-end", "the last angle is NaN", _end_missing),
        ("infinity", "one velocity is infinite", _infinite),
        ("link-absent", "a link is not in the log", _without_link),
        ("point-absent", "a point is not in the log", _without_point),
        ("gaps-absent", "no pin's gap is in the log", lambda _, done: replace(done, gaps={})),
        ("acceleration-nan", "accelerations of one link are NaN", _silent),
    )
)
