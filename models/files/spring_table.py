"""Springs from the tables `[springs.NAME]` of a scene file; faults of springs and of friction.

Read from the raw tables, as `models.files.names` does.
"""

import math
from collections.abc import Iterator, Mapping
from typing import Any

from models.errors import cut, few
from models.files.schema import SceneTable, SpringTable
from models.scene import GROUND
from models.scene.loads import LineSpring, PinSpring, SlideSpring, Spring

LISTED = 12
"""Names that a message lists."""


def springs_of(table: SceneTable) -> dict[str, Spring]:
    """Make the springs of a scene without faults (`faults_of_springs`)."""
    return {name: _spring(name, spring, table) for name, spring in table.springs.items()}


def _spring(name: str, spring: SpringTable, table: SceneTable) -> Spring:
    if spring.pin is not None:
        bodies = spring.bodies or _at_pin(
            spring.pin,
            set(table.ground.points),
            {link: set(one.bar or ()) | set(one.points) for link, one in table.links.items()},
        )
        rate, damping = spring.rate_n_m_rad or 0.0, spring.damping_n_m_s or 0.0
        free = math.radians(spring.free_deg or 0.0)
        return PinSpring(name, rate, damping, free, spring.pin, (bodies[0], bodies[1]))
    rate, damping = spring.rate_n_m or 0.0, spring.damping_n_s_m or 0.0
    own = (name, rate, damping, spring.free_m or 0.0)
    if spring.points is not None:
        return LineSpring(*own, spring.points)
    assert spring.slider is not None
    return SlideSpring(*own, spring.slider)


def _at_pin(point: str, ground: set[str], points: Mapping[str, set[str]]) -> tuple[str, ...]:
    """List the bodies of a point, the ground first, then links in the order of the file."""
    links = [name for name, own in points.items() if point in own]
    return (*([GROUND] if point in ground else []), *links)


def faults_of_springs(
    springs: Mapping[str, Any],
    ground: set[str],
    points: Mapping[str, set[str]],
    sliders: Mapping[str, Any],
) -> Iterator[str]:
    """Yield one line per spring of the raw tables whose ends are missing or ambiguous."""
    everywhere = sorted(ground.union(*points.values(), _blocks(sliders)))
    for name, table in springs.items():
        if not isinstance(table, Mapping):
            continue
        key, ends = f"springs.{cut(name)}", table.get("points")
        both = [end for end in ends if isinstance(end, str)] if isinstance(ends, list) else []
        for point in both:
            if point not in everywhere:
                yield f"{key}.points: no body has a point {cut(point)}; use {few(everywhere, 12)}"
        for body, own in {GROUND: ground, **points}.items():
            if len(set(both)) == 2 and own.issuperset(both):
                yield (
                    f"{key}.points: {' and '.join(both)} are points of {cut(body)}, which lie as "
                    "far apart as ever; name points of two bodies"
                )
        slider = table.get("slider")
        if isinstance(slider, str) and slider not in sliders:
            have = f"use one of {few(map(cut, sliders), LISTED)}" if sliders else "there is none"
            yield f"{key}.slider: found {cut(slider)}; {have}"
        pin = table.get("pin")
        if isinstance(pin, str):
            yield from _of_pin(key, pin, table.get("bodies"), _at_pin(pin, ground, points))


def _blocks(sliders: Mapping[str, Any]) -> set[str]:
    """Return the points of slider blocks."""
    return {
        point
        for name, slider in sliders.items()
        if isinstance(slider, Mapping) and isinstance(point := slider.get("point", name), str)
    }


def _of_pin(key: str, pin: str, bodies: object, met: tuple[str, ...]) -> Iterator[str]:
    """Yield faults of a pin that is none, or leaves open the two bodies of the spring."""
    if len(met) < 2:
        yield f"{key}.pin: fewer than two links, or links and the ground, meet at {cut(pin)}"
    elif bodies is None and len(met) > 2:
        yield f"{key}.bodies: {few(met, LISTED)} meet at {cut(pin)}; name two of them"
    if isinstance(bodies, list) and len(bodies) == 2 and bodies[0] == bodies[1]:
        yield f"{key}.bodies: found {cut(str(bodies[0]))} twice; name two bodies"
    for body in bodies if isinstance(bodies, list) else []:
        if isinstance(body, str) and body not in met:
            yield f"{key}.bodies: {cut(body)} is not at {cut(pin)}; use two of {few(met, LISTED)}"


def faults_of_friction(
    friction: Mapping[str, Any],
    ground: set[str],
    points: Mapping[str, set[str]],
    sliders: Mapping[str, Any],
) -> Iterator[str]:
    """Yield one line per friction that has no joint, or a joint of another kind.

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
    for point in [*ends, *_points_of_blocks(sliders)]:
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
            yield from _of_rubbing_pin(key, table)
        else:
            have = [*sorted(pins), *(name for name in sliders if name not in pins)]
            known = few([cut(name) for name in have], LISTED)
            yield f"{key}: no joint of two bodies has that name; " + (
                f"use one of {known}" if have else "the scene has none"
            )


def _points_of_blocks(sliders: Mapping[str, Any]) -> Iterator[str]:
    """Yield the points of slider blocks, which are pinned there."""
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


def _of_rubbing_pin(key: str, table: Mapping[str, Any]) -> Iterator[str]:
    if "force_n" in table:
        yield f"{key}.force_n: belongs to a slider, and this is a pin; use torque_n_m"
    if "mu" in table and "radius_m" not in table:
        yield f"{key}.radius_m: missing; mu of a pin acts at its radius: add it"
