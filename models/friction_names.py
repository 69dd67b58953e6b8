"""Friction of a scene file in joints that it does not have, or that do not rub as it says.

Read from the raw tables, as `models.names` does.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from models.errors import cut, few

LISTED = 12
"""Joints that a message lists."""


def faults_of_friction(
    friction: Mapping[str, Any],
    ground: set[str],
    points: Mapping[str, set[str]],
    sliders: Mapping[str, Any],
) -> Iterator[str]:
    """One line per friction that has no joint, or a joint of another kind.

    Parameters
    ----------
    friction, sliders : Mapping
        The raw tables.
    ground : set of str
        The points of the ground.
    points : Mapping
        The points of each link.
    """
    counts: dict[str, int] = dict.fromkeys(ground, 1)
    ends = [point for each in points.values() for point in each]
    for point in [*ends, *_blocks(sliders)]:
        counts[point] = counts.get(point, 0) + 1
    pins = [point for point, count in counts.items() if count == 2]
    for joint, table in friction.items():
        if not isinstance(table, Mapping):
            continue
        key = f"friction.{cut(joint)}"
        if joint in sliders:
            yield from _of_slider(key, joint, table)
        elif counts.get(joint, 0) > 2:
            yield (
                f"{key}: {counts[joint]} bodies meet at {cut(joint)}, and which of them rub on "
                "which is open; give each two of them a pin of their own"
            )
        elif joint in pins:
            yield from _of_pin(key, table)
        else:
            have = [*sorted(pins), *(name for name in sliders if name not in pins)]
            known = few([cut(name) for name in have], LISTED)
            yield f"{key}: no joint of two bodies has that name; " + (
                f"use one of {known}" if have else "the scene has none"
            )


def _blocks(sliders: Mapping[str, Any]) -> Iterator[str]:
    """The points of slider blocks, which are pinned there."""
    for name, slider in sliders.items():
        if isinstance(slider, Mapping) and "link" not in slider:
            yield str(slider.get("point", name))


def _of_slider(key: str, joint: str, table: Mapping[str, Any]) -> Iterator[str]:
    for what in ("radius_m", "torque_n_m"):
        if what in table:
            yield (
                f"{key}.{what}: belongs to a pin, and {cut(joint)} is a slider; leave it out, or, "
                "where the pin of its block is meant, give the slider a name other than its point's"
            )


def _of_pin(key: str, table: Mapping[str, Any]) -> Iterator[str]:
    if "force_n" in table:
        yield f"{key}.force_n: belongs to a slider, and this is a pin; use torque_n_m"
    if "mu" in table and "radius_m" not in table:
        yield f"{key}.radius_m: missing; mu of a pin acts at its radius: add it"
