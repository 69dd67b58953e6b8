"""References within a scene file to missing things.

Read from the raw tables, so that these faults are reported beside faults of number or type: values
of the wrong shape are left out here, and are faults of `models.files.schema`.
"""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from itertools import chain, islice
from typing import Any

from models.errors import cut, few
from models.files.elastic_table import faults_of_elastic, faults_of_start
from models.files.spring_table import faults_of_friction, faults_of_springs
from models.scene import GROUND

MOST_ASSEMBLIES = 6
"""Largest number of real assemblies of a group of four links."""
LISTED = 12
"""Names that a message lists."""


def faults_of_names(raw: Mapping[str, Any]) -> list[str]:
    """List one line per name that stands for nothing, or for two things."""
    ground = set(_table(_table(raw, "ground"), "points"))
    points = {name: _points(link) for name, link in _table(raw, "links").items()}
    sliders = _table(raw, "sliders")
    return [
        *_links(points, sliders),
        *_sliders(sliders, points, ground),
        *faults_of_driver(_table(raw, "driver"), points, sliders, ground),
        *_loads(_table(raw, "loads"), points, sliders),
        *faults_of_friction(_table(raw, "friction"), ground, points, sliders),
        *faults_of_springs(_table(raw, "springs"), ground, points, sliders),
        *faults_of_start(_table(raw, "start"), points, sliders),
        *faults_of_elastic(
            _table(raw, "elastic"), ground, points, sliders, _table(raw, "driver").get("link")
        ),
        *_branch(_table(raw, "branch"), ground.union(*points.values(), sliders), points),
    ]


def _list(names: Iterable[str]) -> str:
    """Return the first names, for a message."""
    shown = [cut(name) for name in islice(names, LISTED + 1)]
    return ", ".join(shown[:LISTED]) + (", ..." if len(shown) > LISTED else "")


def _table(raw: object, key: str) -> Mapping[str, Any]:
    """Return the table under a key, empty if missing."""
    found = raw.get(key) if isinstance(raw, Mapping) else None
    return found if isinstance(found, Mapping) else {}


def _points(link: object) -> set[str]:
    """Return the points that a link lists, by bar or by name."""
    bar = link.get("bar") if isinstance(link, Mapping) else None
    ends = bar if isinstance(bar, list) else []
    return {end for end in ends if isinstance(end, str)} | set(_table(link, "points"))


def _links(points: Mapping[str, set[str]], sliders: Mapping[str, Any]) -> Iterator[str]:
    for name in (GROUND, "world"):
        if name in points:
            yield f"links.{name}: that name stands for what does not move; name the link otherwise"
    for name in sliders:
        if name in points:
            yield f"sliders.{cut(name)}: a link has that name too; name the slider after its point"


def _sliders(
    sliders: Mapping[str, Any], points: Mapping[str, set[str]], ground: set[str]
) -> Iterator[str]:
    """Yield faults of sliders on, of, or at missing things."""
    everywhere = ground.union(*points.values())
    all_points = _list(sorted(everywhere))
    points_of = {name: _list(sorted(each)) for name, each in points.items()}
    blocks = Counter(
        str(slider.get("point", name))
        for name, slider in sliders.items()
        if isinstance(slider, Mapping) and "link" not in slider
    )
    for name, slider in sliders.items():
        if not isinstance(slider, Mapping):
            continue
        key, point = f"sliders.{cut(name)}", slider.get("point", name)
        if not isinstance(point, str):
            continue
        on, link = slider.get("on"), slider.get("link")
        if isinstance(on, str) and on != GROUND and on not in points:
            yield f"{key}.on: found {cut(on)}; use one of {_list(chain([GROUND], points))}"
        if isinstance(link, str) and link not in points:
            yield f"{key}.link: found {cut(link)}; use one of {_list(points)}"
        elif isinstance(link, str) and link == on:
            yield f"{key}.on: link {cut(link)} slides on itself; name another body"
        elif isinstance(link, str) and point not in points[link]:
            yield f"{key}.point: {cut(link)} has no point {cut(point)}; it has {points_of[link]}"
        elif link is None and point not in everywhere and blocks[point] < 2:
            yield f"{key}.point: no body has a point {cut(point)}; set point to one of {all_points}"


def _loads(
    loads: Mapping[str, Any], points: Mapping[str, set[str]], sliders: Mapping[str, Any]
) -> Iterator[str]:
    """Yield faults of loads on, at or over missing things."""
    blocks = [n for n, s in sliders.items() if isinstance(s, Mapping) and "link" not in s]
    for name, load in loads.items():
        if not isinstance(load, Mapping):
            continue
        key = f"loads.{cut(name)}"
        link, point = load.get("link"), load.get("point")
        for what, known in (("link", points), ("block", blocks), ("slider", sliders)):
            one = load.get(what)
            if isinstance(one, str) and one not in known:
                have = f"use one of {_list(known)}" if known else "the scene has none"
                yield f"{key}.{what}: found {cut(one)}; {have}"
        own = points.get(link) if isinstance(link, str) else None
        if own is not None and isinstance(point, str) and point not in own:
            has = _list(sorted(own))
            yield f"{key}.point: {cut(str(link))} has no point {cut(point)}; it has {has}"


def _branch(
    branch: Mapping[str, Any], choices: set[str], links: Mapping[str, Any]
) -> Iterator[str]:
    """Yield faults of branches: unknown names, sides and numbers."""
    for name, chosen in branch.items():
        if name not in choices and name not in links:
            yield f"branch.{cut(name)}: no pin, slider or link of that name"
        elif not isinstance(chosen, int):
            continue  # already a fault of the schema
        elif name in links and not 1 <= chosen <= MOST_ASSEMBLIES:
            yield (
                f"branch.{cut(name)}: found {cut(str(chosen))}; the assemblies of a group about a "
                f"link are numbered from 1 to at most {MOST_ASSEMBLIES}"
            )
        elif name not in links and chosen not in (-1, 1):
            yield f"branch.{cut(name)}: found {cut(str(chosen))}; use 1 or -1"


def faults_of_driver(
    driver: Mapping[str, Any],
    points: Mapping[str, set[str]],
    sliders: Mapping[str, Any],
    ground: set[str],
) -> Iterator[str]:
    """Yield one line per fault of the raw table; wrong shapes are faults of the schema."""
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
    """Return the points of blocks with their sliders, from the raw tables."""
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
    """Yield faults of a pin that is none, or does not join the named links."""
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
