"""Random mechanisms, designed in an assembled position so that every one of them closes.

Bodies, pins and lines are laid out at the first instant; lengths, lines and angles in the bodies'
own frames follow from that layout, and so does the branch: the one assembly that is the layout.
Every dyad is laid out with a conditioning of at least 0.5, and the driver swings as far as
all of them keep `MARGIN`.
"""

from __future__ import annotations

import cmath
import itertools
import math
import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from hypothesis import settings
from hypothesis import strategies as st

from analytic.kinematics import nearness, solve
from analytic.structure.mobility import analyse
from models.errors import ReachError
from models.motion import Motion
from models.scene import GROUND, Driver, Link, Point, Scene, Slider
from models.scene.joints import frames
from models.scene.laws import ConstantSpeed, Law, Oscillating

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
        return self.frames[body][0] + self.arm(0.2, 0.8) * self.reach.get(body, 1.0)

    def lean(self) -> float:
        """An angle up to 0.9 to either side, or half a turn from there."""
        return self.number(-0.9, 0.9) + math.pi * (self.number(0.0, 1.0) < 0.5)

    def local(self, body: str, place: complex) -> Point:
        origin, angle = self.frames[body]
        away = (place - origin) * cmath.rect(1.0, -angle)
        return away.real, away.imag

    def link(self, near: complex) -> str:
        name = f"link{next(self.names)}"
        self.frames[name] = (near + self.arm(0.0, 1.0), self.number(-math.pi, math.pi))
        self.points[name] = {}
        return name

    def crank(self, *, comes_round: bool = False) -> str:
        """A new link on the ground with a pin, its frame at its pivot where it is to come round."""
        pivot = self.arm(0.0, 1.0)
        name = self.link(pivot)
        if comes_round:
            self.frames[name] = (pivot, self.frames[name][1])
            self.reach[name] = self.number(0.2, 1.0)
        self.pin(pivot, GROUND, name)
        self.pin(pivot + self.arm(0.1 if comes_round else 0.3, 0.8), name)
        return name

    def pin(self, place: complex, *bodies: str) -> str:
        name = f"P{next(self.names)}"
        for body in bodies:
            self.points[body][name] = self.local(body, place)
        return name

    def slide(
        self, on: str, angle: float, place: complex, link: str | None, point: str | None = None
    ) -> None:
        """A slider at a place on a line of ``on`` in a direction of the plane: a ``link`` by a
        point of its own at the place, or a block at ``point``."""
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
    """The new pin at ``place`` of an end of a dyad that slides against a known body: a ``block`` on
    it, a ``link`` that slides on it, or a ``guide``, on whose own line the known one slides."""
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
        inner = _slide_end(at, form, line, cmath.phase(rod) + at.lean(), p1 + rod)
        at.points[link][inner] = at.local(link, p1 + rod)

    return lay_out


def _either(at: Layout, a: str, b: str) -> tuple[str, str]:
    return (a, b) if at.number(0.0, 1.0) < 0.5 else (b, a)


def _rpr(form: str) -> Callable[[Layout], None]:
    def lay_out(at: Layout) -> None:
        known1, known2 = _either(at, *at.known_pair())
        p1 = at.near(known1)
        span = at.arm(0.6, 1.5)
        angle = cmath.phase(-span) + at.lean()
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
        pin2 = _slide_end(at, form2, known2, angle + math.pi / 2 + at.lean(), place)
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
        across, where = angle + math.pi / 2 + at.lean(), p1 + at.arm(0.0, 0.8)
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
MARGIN = 0.25
SWINGS = [0.6 * 0.5**k for k in range(8)]
"""Amplitudes of the driver [rad] that are tried, the largest first."""

FORMS = tuple(LAYOUTS)
"""Kind of the dyad and how it slides: a block; a link that slides; a link that is the guide of what
slides (for PRP the two ends, for RPP the inner pair and the outer one)."""
KINDS = ("RRR", "RRP", "RPR", "PRP", "RPP")
OF_EACH_KIND = list({form[:3]: form for form in FORMS}.values())
"""The last form of each kind."""


def some_forms(kind: str, chance: random.Random) -> list[str]:
    forms = [chance.choice([form for form in FORMS if form.startswith(kind)])]
    return [*forms, chance.choice(FORMS)] if chance.random() < 0.4 else forms


@dataclass(frozen=True)
class Designed:
    """A random mechanism, with the frames (x, y [m], theta) of its bodies at time 0; blocks named
    as in `tests.second_opinions.newton`."""

    scene: Scene
    frames: Mapping[str, tuple[float, float, float]]
    forms: tuple[str, ...]


def examples(count: int) -> settings:
    """So many examples, the same ones every time."""
    return settings(max_examples=count, deadline=None, derandomize=True, database=None)


@st.composite
def mechanisms(draw: st.DrawFn, forms: Sequence[str] | None = None) -> Designed:
    """A crank with the dyads of the given forms in that order (None: one or two of any form)."""
    if forms is None:
        forms = draw(st.lists(st.sampled_from(FORMS), min_size=1, max_size=2))

    def number(low: float, high: float) -> float:
        return draw(st.floats(low, high))

    at = Layout(number, lambda names: draw(st.sampled_from(names)))
    crank = at.crank()
    law = Oscillating(at.frames[crank][1], SWINGS[0], number(0.5, 20.0))
    return _with_margin(with_dyads(at, forms, crank, law))


def with_dyads(at: Layout, forms: Sequence[str], crank: str, law: Law) -> Designed:
    """The dyads of the given forms hung on a crank and on each other, on the branch laid out."""
    laid_out = []
    turning = frozenset([crank]) if isinstance(law, ConstantSpeed) else frozenset()
    for form in forms:
        at.barred = turning if form.startswith("PRP") else frozenset()
        if form == "PRP guide, guide" and len(at.free(GROUND)) < 2:
            LAYOUTS["RRR"](at)  # both of its guides ride on moving links
            laid_out.append("RRR")
        LAYOUTS[form](at)
        laid_out.append(form)
    links = {
        name: Link(name, points, 1.0, (0.0, 0.0), 1.0)
        for name, points in at.points.items()
        if name != GROUND
    }
    scene = Scene(
        "random",
        "tests/worlds/strategies.py",
        at.points[GROUND],
        links,
        at.sliders,
        Driver(crank, law),
    )
    frames = {b: (p.real, p.imag, a) for b, (p, a) in {**at.frames, **at.blocks}.items()}
    del frames[GROUND]
    return _on_its_branch(Designed(scene, frames, tuple(laid_out)))


def _on_its_branch(designed: Designed) -> Designed:
    """With the one choice of assemblies whose position is the layout."""
    keys = [g.branch_key for g in analyse(designed.scene).groups if g.assemblies == 2]
    choices = [
        dict(zip(keys, s, strict=True)) for s in itertools.product((1, -1), repeat=len(keys))
    ]
    scenes = [replace(designed.scene, branch=choice) for choice in choices]
    fitting = [scene for scene in scenes if _is_layout(scene, designed.frames)]
    assert len(fitting) == 1, f"{len(fitting)} of {len(scenes)} assemblies are the layout"
    return replace(designed, scene=fitting[0])


def _is_layout(scene: Scene, laid_out: Mapping[str, tuple[float, float, float]]) -> bool:
    try:
        found = frames(scene, solve(scene, np.zeros(1), bound=False).state())
    except ReachError:
        return False
    places = ((found[name], laid_out[name]) for name in scene.links)
    return all(
        math.dist(frame.origin, (x, y)) < 1e-9
        and abs(math.remainder(frame.theta - angle, math.tau)) < 1e-9
        for frame, (x, y, angle) in places
    )


def _with_margin(designed: Designed, margin: float = MARGIN) -> Designed:
    """With the largest swing of the driver that keeps every dyad off its singular positions."""
    scene = designed.scene
    law = scene.driver.law
    assert isinstance(law, Oscillating)
    for swing in SWINGS:
        tried = replace(scene, driver=replace(scene.driver, law=replace(law, amplitude_rad=swing)))
        if _worst(tried) >= margin:
            return replace(designed, scene=tried)
    raise AssertionError("laid out too near to a singular position")


def swinging(designed: Designed, frequency_rad_s: float, margin: float = MARGIN) -> Designed:
    """The same mechanism under a driver that swings as far as the margin lets it."""
    driver = designed.scene.driver
    theta = designed.frames[driver.link][2]
    law = Oscillating(theta, SWINGS[0], frequency_rad_s)
    scene = replace(designed.scene, driver=replace(driver, law=law))
    return _with_margin(replace(designed, scene=scene), margin)


def _worst(scene: Scene) -> float:
    """The nearest singular position over a swing; 0 where it does not close."""
    try:
        motion: Motion = solve(scene, swing_times(scene, 65), bound=False)
    except ReachError:
        return 0.0
    return min(float(sine.min()) for sine in nearness(scene, motion).values())


def least_sine(scene: Scene, looks: int) -> float:
    """The worst conditioning over a period; 0 where it does not close."""
    time_s = swing_times(scene, looks)
    try:
        motion = solve(scene, time_s, links=(), points=(), sliders=(), bound=False)
    except ReachError:
        return 0.0
    return min(float(sine.min()) for sine in motion.conditioning.values())


def swing_times(scene: Scene, count: int) -> np.ndarray:
    return np.linspace(0.0, scene.driver.law.period_s, count)
