"""Motion of links, points and sliders from the coordinates of an assembly."""

import numpy as np
from numpy.typing import NDArray

from analytic.multibody.assembly import Assembly
from analytic.multibody.bodies import Configuration
from models.array import Array
from models.motion import ElasticMotion, LinkMotion, Motion, PointMotion, SliderMotion
from models.scene.joints import sliding_angle, sliding_body


def as_motion(assembly: Assembly, time_s: Array, now: Configuration, seconds: Array) -> Motion:
    """Return the motion at times [s] (T,), with accelerations q'' (T, n)."""
    flat = now.gradient.reshape(len(time_s), -1, assembly.size)
    gained = (flat @ seconds[:, :, None]).reshape(now.drift.shape) + now.drift
    scene = assembly.scene
    links = {
        name: LinkMotion(
            *(own[:, assembly.frames[name], 2] for own in (now.place, now.velocity, gained))
        )
        for name in scene.links
    }
    points = {
        point: PointMotion(
            now.place[:, marker, :2], now.velocity[:, marker, :2], gained[:, marker, :2]
        )
        for point, (_, marker) in assembly.carriers.items()
    }
    sliders = {name: _slider(assembly, name, now, gained) for name in scene.sliders}
    elastic = {
        name: ElasticMotion(
            body.deflections(now.q[:, own], np.array([0.5 * body.length_m]))[:, 0],
            body.extension(now.q[:, own]),
        )
        for name, (body, own) in assembly.elastic.items()
    }
    return Motion(time_s, links, points, sliders, elastic=elastic)


def _slider(assembly: Assembly, name: str, now: Configuration, gained: Array) -> SliderMotion:
    """Return the motion of a slider's tip along its line, as seen from the guide."""
    tip, guide = assembly.tips[name], assembly.guides[name]
    angle, omega, alpha = (own[:, guide, 2] for own in (now.place, now.velocity, gained))
    along = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    away, drift, push = (
        own[:, tip, :2] - own[:, guide, :2] for own in (now.place, now.velocity, gained)
    )
    far, aside = (along * away).sum(axis=1), (across * away).sum(axis=1)
    # along' = omega across, along'' = alpha across - omega^2 along.
    speed = (along * drift).sum(axis=1) + omega * aside
    acceleration = (
        (along * push).sum(axis=1)
        + 2.0 * omega * (across * drift).sum(axis=1)
        + alpha * aside
        - omega**2 * far
    )
    return SliderMotion(far, speed, acceleration)


ROUNDS = 8
"""Rounds of Newton's method, from the joint gaps that an engine leaves."""
FAR = 0.5
"""Largest step of it, in radians or longest links: a larger one has lost the run."""
CLOSED = 1e-10
"""Largest joint gap in the end, over the longest link."""
LOST = 1e-7
"""Singular value over the largest that counts as 0."""
TELLING = 1e-2
"""Share of an angle in the free motion from which on it determines a position."""
AT_ONCE = 2000


def logged_places(assembly: Assembly, logged: Motion, freedoms: int) -> Array:
    """Return coordinates (T, n) with closed joints, at the run's own values of as many coordinates
    as there are ``freedoms``; NaN where no such position is next to the log.

    The kept coordinates are those that determine the position best at each instant, angles of links
    where possible: a chain of pendulums keeps all angles, and all pins are placed again.
    """
    rough = _coordinates(assembly, logged)
    found = np.full_like(rough, np.nan)
    whole = np.flatnonzero(np.isfinite(rough).all(axis=1))
    for first in range(0, len(whole), AT_ONCE):
        index = whole[first : first + AT_ONCE]
        found[index] = _closed(assembly, rough[index], freedoms)
    return found


def _coordinates(assembly: Assembly, logged: Motion) -> Array:
    """Return the coordinates of the bodies by their logged angles and one logged point of each."""
    scene = assembly.scene
    q = np.full((logged.time_s.size, assembly.size), np.nan)
    for name, link in scene.links.items():
        theta, at = logged.links[name].theta, assembly.at[name]
        point = next((p for p in link.points if p in logged.points or p in scene.ground), None)
        if point is None:
            continue
        x, y = link.points[point]
        place = logged.points[point].position if point in logged.points else scene.ground[point]
        c, s = np.cos(theta), np.sin(theta)
        q[:, at : at + 2] = place - np.stack([c * x - s * y, s * x + c * y], axis=1)
        q[:, at + 2] = theta
    for slider in scene.sliders.values():
        if slider.link is None and slider.point in logged.points:
            at = assembly.at[sliding_body(slider)]
            guide = logged.links[slider.on].theta if slider.on in logged.links else 0.0
            q[:, at : at + 2] = logged.points[slider.point].position
            q[:, at + 2] = guide + sliding_angle(slider)
    return q


def _closed(assembly: Assembly, rough: Array, freedoms: int) -> Array:
    """Close the joints by Newton's method, with some coordinates kept."""
    units, q = assembly.units, rough.copy()
    kept = _kept(assembly, q, freedoms)
    hold = np.zeros((len(q), freedoms, assembly.size))
    np.put_along_axis(hold, kept[:, :, None], 1.0, axis=2)
    still, lost = np.zeros((len(q), freedoms)), np.zeros(len(q), dtype=bool)
    for _ in range(ROUNDS):
        now = assembly.at_rest(q)
        rows = np.concatenate([assembly.joints.jacobian(now) * units, hold], axis=1)
        left = np.concatenate([-assembly.joints.gaps(now), still], axis=1)
        step = (np.linalg.pinv(rows, rcond=LOST) @ left[:, :, None])[:, :, 0]
        size = np.abs(step).max(axis=1)
        lost |= ~(size < FAR)
        q = q + np.where(lost[:, None], 0.0, step * units)
        if np.all(lost | (size < 1e-15)):
            break
    gaps = np.abs(assembly.joints.gaps(assembly.at_rest(q))).max(axis=1, initial=0.0)
    lost |= gaps > CLOSED * max(1.0, assembly.scene.longest_m)
    return np.where(lost[:, None], np.nan, q)


def _kept(assembly: Assembly, q: Array, freedoms: int) -> NDArray[np.intp]:
    """Return the coordinates that determine each position best, (T, f): each moves most in the
    motion that the ones before leave free, angles of links first."""
    jacobian = assembly.joints.jacobian(assembly.at_rest(q)) * assembly.units
    _, _, directions = np.linalg.svd(jacobian)
    free = directions[:, assembly.size - freedoms :, :].copy()  # (T, f, n)
    turning = np.zeros(assembly.size, dtype=bool)
    turning[[assembly.at[name] + 2 for name in assembly.scene.links]] = True
    kept, sample = np.empty((len(q), freedoms), dtype=np.intp), np.arange(len(q))
    for k in range(freedoms):
        moved = np.linalg.norm(free, axis=1)
        angles = np.where(turning, moved, 0.0)
        by_angle = angles.max(axis=1) > TELLING
        kept[:, k] = np.where(by_angle, angles.argmax(axis=1), moved.argmax(axis=1))
        along = free[sample, :, kept[:, k]]
        along /= np.linalg.norm(along, axis=1, keepdims=True)
        free -= along[:, :, None] * np.einsum("tf,tfn->tn", along, free)[:, None]
    return kept
