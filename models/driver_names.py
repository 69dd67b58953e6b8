"""What a driver table names that is not there, or that nothing can drive."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from models.errors import cut, few
from models.scene import GROUND

LISTED = 12


def faults_of_driver(
    driver: Mapping[str, Any],
    points: Mapping[str, set[str]],
    sliders: Mapping[str, Any],
    ground: set[str],
) -> Iterator[str]:
    """One line per fault of the raw table; what has the wrong shape is a fault of the schema."""
    link, pin, slider = driver.get("link"), driver.get("pin"), driver.get("slider")
    if isinstance(link, str):
        if link not in points:
            yield f"driver.link: found {cut(link)}; use one of {few(map(cut, points), LISTED)}"
        elif not points[link] & ground:
            yield (
                f"driver.link: {cut(link)} has no ground pin to turn about; give it a ground "
                "point, or drive the pin of two links: pin = ..., links = [..., ...]"
            )
    if isinstance(slider, str) and slider not in sliders:
        have = f"use one of {few(map(cut, sliders), LISTED)}" if sliders else "the scene has none"
        yield f"driver.slider: found {cut(slider)}; {have}"
    if isinstance(pin, str):
        yield from _of_pin(pin, driver.get("links"), points, _blocks(sliders), ground)


def _blocks(sliders: Mapping[str, Any]) -> dict[str, str]:
    """The points of blocks, and the sliders whose they are, as far as the raw tables tell."""
    return {
        str(table.get("point", name)): name
        for name, table in sliders.items()
        if isinstance(table, Mapping) and "link" not in table
    }


def _of_pin(
    pin: str,
    named: object,
    points: Mapping[str, set[str]],
    blocks: Mapping[str, str],
    ground: set[str],
) -> Iterator[str]:
    """A pin that is none, or does not join the links that are named."""
    joined = [GROUND] * (pin in ground) + [name for name, own in points.items() if pin in own]
    if len(joined) == 1 and pin in blocks:
        yield (
            f"driver.pin: found {cut(pin)}, by which {joined[0]} turns against the block of slider "
            f"{cut(blocks[pin])}; drive that slider, slider = {cut(blocks[pin])!r}, or a pin of "
            "two links"
        )
        return
    if len(joined) < 2:
        what = f"it is a point of {joined[0]} alone" if joined else "no body has such a point"
        yield f"driver.pin: found {cut(pin)}, and {what}; name a point that two bodies share"
        return
    both = few(map(cut, joined), LISTED)
    if named is None:
        if len(joined) > 2:
            yield f"driver.links: missing, and pin {cut(pin)} joins {both}; name two of them"
        return
    if not (isinstance(named, list) and all(isinstance(name, str) for name in named)):
        return
    for name in named:
        if name not in joined:
            yield f"driver.links: pin {cut(pin)} joins {both}, not {cut(name)}; name two of them"
    if len(named) == 2 and named[0] == named[1]:
        yield f"driver.links: found {cut(named[0])} twice; pin {cut(pin)} joins {both}"
