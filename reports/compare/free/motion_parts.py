"""Two stretches of a motion as one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from models.motion import BodyMotion, Bound, Motion


def one_after_another(first: Motion, then: Motion) -> Motion:
    """The samples of both, without forces; what either lacks of the other is left out."""
    return replace(
        then,
        time_s=np.concatenate([first.time_s, then.time_s]),
        links=_joined(first.links, then.links),
        points=_joined(first.points, then.points),
        sliders=_joined(first.sliders, then.sliders),
        conditioning={
            key: np.concatenate([first.conditioning[key], sine])
            for key, sine in then.conditioning.items()
            if key in first.conditioning
        },
        bound=_bounds(first.bound, then.bound) if first.bound and then.bound else None,
        forces=None,
    )


def _bounds(first: Bound, then: Bound) -> Bound:
    return Bound(
        _joined(first.links, then.links),
        _joined(first.points, then.points),
        _joined(first.sliders, then.sliders),
    )


def _joined(
    first: Mapping[str, BodyMotion], then: Mapping[str, BodyMotion]
) -> dict[str, BodyMotion]:
    return {
        name: type(body)(
            **{
                key: np.concatenate([vars(first[name])[key], each])
                for key, each in vars(body).items()
            }
        )
        for name, body in then.items()
        if name in first
    }
