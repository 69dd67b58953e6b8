"""Coordinates of an assembly as the motion of its links, points and sliders."""

from __future__ import annotations

import numpy as np

from analytic.multibody.assembly import Assembly
from analytic.multibody.configuration import Configuration
from models.array import Array
from models.motion import ElasticMotion, LinkMotion, Motion, PointMotion, SliderMotion


def as_motion(assembly: Assembly, time_s: Array, now: Configuration, seconds: Array) -> Motion:
    """The motion at times [s] (T,), with accelerations q'' (T, n)."""
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
    return Motion(time_s, links, points, sliders, elastic=_shapes(assembly, now.q))


def _shapes(assembly: Assembly, q: Array) -> dict[str, ElasticMotion]:
    """How elastic links are bent and stretched at coordinates (T, n)."""
    return {
        name: ElasticMotion(
            body.deflections(q[:, own], np.array([0.5 * body.length_m]))[:, 0],
            body.extension(q[:, own]),
        )
        for name, (body, own) in assembly.elastic.items()
    }


def _slider(assembly: Assembly, name: str, now: Configuration, gained: Array) -> SliderMotion:
    """The tip of a slider along its line, as seen from the guide."""
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
