"""Dyads of every kind and role, laid out in the plane onto the bodies that are there already."""

from __future__ import annotations

import cmath
import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

from models.scene import GROUND, Point, Slider

Draw = Callable[[float, float], float]


@dataclass
class Layout:
    """A mechanism while it is laid out; places and directions in the plane."""

    number: Draw
    choose: Callable[[Sequence[str]], str]
    frames: dict[str, tuple[complex, float]] = field(default_factory=lambda: {GROUND: (0j, 0.0)})
    points: dict[str, dict[str, Point]] = field(default_factory=lambda: {GROUND: {}})
    sliders: dict[str, Slider] = field(default_factory=dict)
    blocks: dict[str, tuple[complex, float]] = field(default_factory=dict)
    reach: dict[str, float] = field(default_factory=dict)
    """How far from a body's frame its pins lie, over what is usual; 1 where it is silent."""
    barred: frozenset[str] = frozenset()
    """Bodies that no further dyad may hang on."""
    names: itertools.count[int] = field(default_factory=itertools.count)

    def arm(self, low: float, high: float) -> complex:
        return cmath.rect(self.number(low, high), self.number(-math.pi, math.pi))

    def near(self, body: str) -> complex:
        """A place for a pin on a body."""
        return self.frames[body][0] + self.arm(0.2, 0.8) * self.reach.get(body, 1.0)

    def lean(self, most: float) -> float:
        """An angle up to ``most`` to either side, or half a turn from there."""
        return self.number(-most, most) + math.pi * (self.number(0.0, 1.0) < 0.5)

    def local(self, body: str, place: complex) -> Point:
        origin, angle = self.frames[body]
        away = (place - origin) * cmath.rect(1.0, -angle)
        return away.real, away.imag

    def link(self, near: complex) -> str:
        """A new link, its frame anywhere near."""
        name = f"link{next(self.names)}"
        self.frames[name] = (near + self.arm(0.0, 1.0), self.number(-math.pi, math.pi))
        self.points[name] = {}
        return name

    def pin(self, place: complex, *bodies: str) -> str:
        """A new point at a place, on each of the bodies."""
        name = f"P{next(self.names)}"
        for body in bodies:
            self.points[body][name] = self.local(body, place)
        return name

    def slide(
        self, on: str, angle: float, place: complex, link: str | None, point: str | None = None
    ) -> None:
        """A slider at a place on a line of ``on`` in a direction of the plane.

        With ``link`` that link slides, by a point of its own at the place; else it is a block at
        ``point``.
        """
        name = f"S{next(self.names)}"
        through = place - self.number(-1.0, 1.0) * cmath.rect(1.0, angle)
        along = angle - self.frames[on][1]
        if link is None:
            assert point is not None
            slider = Slider(name, point, on, self.local(on, through), along)
            self.blocks[f"block {name}"] = (place, angle)
        else:
            point = point or self.pin(place, link)
            lean = self.frames[link][1] - angle
            slider = Slider(name, point, on, self.local(on, through), along, link, lean)
        self.sliders[name] = slider

    def merge(self, pin: str, other: str) -> None:
        """Two pins at one place become one."""
        for points in self.points.values():
            if other in points:
                points[pin] = points.pop(other)
        for name, slider in self.sliders.items():
            if slider.point == other:
                self.sliders[name] = replace(slider, point=pin)

    def known_pair(self) -> tuple[str, str]:
        """Two different bodies that are placed, one of them a link: a dyad may hang on them."""
        moving = self.choose(self.free(GROUND))
        return moving, self.choose(self.free(moving))

    def free(self, *but: str) -> list[str]:
        """The bodies that a dyad may hang on, without some."""
        return [b for b in self.frames if b not in self.barred and b not in but]


def _rrr(at: Layout) -> None:
    """Two links between pins of two bodies; C stands well off the line of the pins."""
    known1, known2 = at.known_pair()
    p1 = at.near(known1)
    span = at.arm(0.6, 1.5)
    c = p1 + span * complex(at.number(0.3, 0.7), at.number(0.4, 1.0) * _sign(at))
    first, second = at.link(p1), at.link(c)
    at.pin(p1, known1, first)
    at.pin(c, first, second)
    at.pin(p1 + span, second, known2)


def _sign(at: Layout) -> int:
    return 1 if at.number(0.0, 1.0) < 0.5 else -1


def _slide_end(at: Layout, form: str, known: str, angle: float, place: complex) -> str:
    """One end of a dyad that slides against a known body, at a new pin at ``place``.

    ``block``: a block on the known body; ``link``: a link that slides on it; ``guide``: a link on
    whose own line the known one slides. Returns the name of the pin.
    """
    if form == "block":
        pin = f"P{next(at.names)}"
        at.slide(known, angle, place, None, pin)
        return pin
    link = at.link(place)
    pin = at.pin(place, link)
    where = place + at.arm(0.0, 0.5)
    if form == "link":
        own = pin if at.number(0.0, 1.0) < 0.3 else None
        at.slide(known, angle, place if own else where, link, own)
    else:
        at.slide(link, angle, where, known)
    return pin


def _rrp(form: str) -> Callable[[Layout], None]:
    def lay_out(at: Layout) -> None:
        moving, other = at.known_pair()
        pinned, line = (other, moving) if form == "guide" else _either(at, moving, other)
        p1 = at.near(pinned)
        rod = at.arm(0.5, 1.5)
        link = at.link(p1)
        at.pin(p1, pinned, link)
        inner = _slide_end(at, form, line, cmath.phase(rod) + at.lean(0.9), p1 + rod)
        at.points[link][inner] = at.local(link, p1 + rod)

    return lay_out


def _either(at: Layout, a: str, b: str) -> tuple[str, str]:
    return (a, b) if at.number(0.0, 1.0) < 0.5 else (b, a)


def _rpr(form: str) -> Callable[[Layout], None]:
    def lay_out(at: Layout) -> None:
        known1, known2 = _either(at, *at.known_pair())
        p1 = at.near(known1)
        span = at.arm(0.6, 1.5)
        angle = cmath.phase(-span) + at.lean(0.9)
        if form == "block":
            guide = at.link(p1)
            at.pin(p1 + span, known2, guide)
            at.slide(guide, angle, p1, None, at.pin(p1, known1))
            return
        slider, guide = _in_order(at.link(p1), at.link(p1), swap=form == "guide first")
        at.pin(p1, known1, slider)
        at.pin(p1 + span, known2, guide)
        at.slide(guide, angle, p1 + at.arm(0.0, 0.5), slider)

    return lay_out


def _in_order(a: str, b: str, *, swap: bool) -> tuple[str, str]:
    return (b, a) if swap else (a, b)


def _prp(form1: str, form2: str) -> Callable[[Layout], None]:
    def lay_out(at: Layout) -> None:
        known1, known2 = at.known_pair()
        if form1 == form2 == "guide":  # both known bodies slide: neither can be the ground
            known1 = at.free(GROUND)[0]
            known2 = at.choose(at.free(GROUND, known1))
        elif form2 == "guide":
            known1, known2 = known2, known1
        place = at.frames[known1][0] + at.arm(0.3, 1.0)
        angle = at.number(-math.pi, math.pi)
        pin1 = _slide_end(at, form1, known1, angle, place)
        pin2 = _slide_end(at, form2, known2, angle + math.pi / 2 + at.lean(0.9), place)
        at.merge(pin1, pin2)

    return lay_out


def _rpp(inner: str, outer: str) -> Callable[[Layout], None]:
    def lay_out(at: Layout) -> None:
        moving, other = at.known_pair()
        pinned, known = (other, moving) if outer == "guide" else _either(at, moving, other)
        p1 = at.near(pinned)
        middle = at.link(p1)
        at.pin(p1 + at.arm(0.2, 0.6), middle)
        angle = at.number(-math.pi, math.pi)
        across, where = angle + math.pi / 2 + at.lean(0.9), p1 + at.arm(0.0, 0.8)
        if inner == "block":
            at.slide(middle, across, p1, None, at.pin(p1, pinned))
        else:
            link = at.link(p1)
            at.pin(p1, pinned, link)
            slides, guides = _in_order(link, middle, swap=inner == "guide")
            at.slide(guides, across, p1 + at.arm(0.0, 0.5), slides)
        slides, guides = _in_order(middle, known, swap=outer == "guide")
        at.slide(guides, angle, where, slides)

    return lay_out


LAYOUTS: dict[str, Callable[[Layout], None]] = {
    "RRR": _rrr,
    **{f"RRP {form}": _rrp(form) for form in ("block", "link", "guide")},
    **{f"RPR {form}": _rpr(form) for form in ("block", "link", "guide first")},
    **{
        f"PRP {a}, {b}": _prp(a, b)
        for a, b in itertools.combinations_with_replacement(("block", "link", "guide"), 2)
    },
    **{
        f"RPP {inner} on {outer}": _rpp(inner, outer)
        for inner in ("block", "link", "guide")
        for outer in ("link", "guide")
    },
}
