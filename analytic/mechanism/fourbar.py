r"""The four-bar in closed form: Grashof class, limits, transmission angle.

Lengths by their place in the loop, as in the figure; the driver turns about A, the rocker about D::

            C
      b   /  \  c           a driver AB, b coupler BC, c rocker CD, d ground AD
        B     \
     a /       \
      A ------- D
           d

Source: R. L. Norton, Design of Machinery, chapters 2 (Grashof) and 4 (limits).

A pin of a loop turns fully if the two links beside it can stand in line both ways. Of a four-bar a
link turns fully against the others if s + l <= p + q; of a slider-crank (a crank r, a rod l, the
line e beside the crank's pin) if the shorter of r and l, and e, are no longer together than the
longer one; so it is for the inversion, a guide that turns about D, with the crank a and ground d::

      slider-crank                     inverted slider-crank

            B                               B =====  guide, e beside D
        r  /  \  l                       a  /
          A     [C]  line, e beside A      A ------- D
                                               d

Source: R. L. Norton, Design of Machinery, sections 2.13 to 2.15 (Grashof, and with a slider); the
names of special four-bars are those of that book.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from analytic.structure.groups import Group
from analytic.structure.mobility import analyse
from models.errors import StructureError
from models.scene import GROUND, Point, Scene, Slider

GrashofClass = Literal[
    "crank-rocker", "double-crank", "double-rocker", "triple-rocker", "change point"
]
SAME = 1e-12
"""Relative difference of sums of lengths, below which they are equal: a change point."""


@dataclass(frozen=True)
class FourBar:
    """The four lengths [m]: driver a, coupler b, rocker c, ground d."""

    driver: float
    coupler: float
    rocker: float
    ground: float

    def __post_init__(self) -> None:
        lengths = sorted((self.driver, self.coupler, self.rocker, self.ground))
        if lengths[0] <= 0.0 or not math.isfinite(lengths[3]):
            raise ValueError(f"lengths {lengths}: four finite lengths above 0 make a four-bar")
        short = lengths[3] - sum(lengths[:3])
        if short > 0.0:
            raise ValueError(
                f"lengths {lengths}: the longest exceeds the sum of the others by {short:.4g} m, "
                "so the loop cannot close"
            )

    @staticmethod
    def of(scene: Scene) -> FourBar:
        """Return the four-bar of a scene. Raises StructureError if it is another mechanism."""
        groups = analyse(scene).groups
        if len(groups) != 1 or groups[0].kind != "RRR":
            kinds = ", ".join(group.kind for group in groups)
            raise StructureError(f"{scene.name}: not a four-bar; its groups are {kinds}")
        group = groups[0]
        links = {name: link.points for name, link in scene.links.items()}
        first, second = group.first, group.second
        crank_pin, rocker_pivot = group.outer1, group.outer2
        if crank_pin in scene.ground:
            first, second, crank_pin, rocker_pivot = second, first, rocker_pivot, crank_pin
        pivot = scene.driver_pivot
        driver = links[scene.driver.link]
        if crank_pin not in driver or rocker_pivot not in scene.ground:
            raise StructureError(
                f"{scene.name}: not a four-bar; {group.first} and {group.second} lie between "
                "pins of one body"
            )
        lengths = (
            math.dist(driver[pivot], driver[crank_pin]),
            math.dist(links[first][crank_pin], links[first][group.inner]),
            math.dist(links[second][rocker_pivot], links[second][group.inner]),
            math.dist(scene.ground[pivot], scene.ground[rocker_pivot]),
        )
        try:
            return FourBar(*lengths)
        except ValueError as error:
            raise StructureError(f"{scene.name}: not a four-bar; {error}") from None

    @property
    def excess_m(self) -> float:
        """s + l - p - q [m]: negative for Grashof chains, 0 at a change point."""
        s, p, q, longest = sorted((self.driver, self.coupler, self.rocker, self.ground))
        return (s - p) + (longest - q)

    @property
    def grashof_class(self) -> GrashofClass:
        """Class by the links that turn fully against the ground."""
        lengths = (self.driver, self.coupler, self.rocker, self.ground)
        if abs(self.excess_m) <= SAME * sum(lengths):
            return "change point"
        if self.excess_m > 0.0:
            return "triple-rocker"
        shortest = min(lengths)
        if shortest == self.ground:
            return "double-crank"
        return "double-rocker" if shortest == self.coupler else "crank-rocker"

    @property
    def driver_turns_fully(self) -> bool:
        a, b, c, d = self.driver, self.coupler, self.rocker, self.ground
        tolerance = SAME * (a + b + c + d)
        return a + d <= b + c + tolerance and abs(a - d) >= abs(b - c) - tolerance

    @property
    def driver_range_rad(self) -> tuple[float, float]:
        """Driver's angles against AD on one side of it (from, to), within 0 to pi [rad].

        The other side mirrors it. (0, pi) where the driver turns fully.
        """
        a, b, c, d = self.driver, self.coupler, self.rocker, self.ground
        near = _angle(a, d, max(abs(b - c), abs(a - d)))
        far = _angle(a, d, min(b + c, a + d))
        return near, far

    @property
    def transmission_rad(self) -> tuple[float, float]:
        """Smallest and largest angle between coupler and rocker over the driver's range [rad]."""
        a, b, c, d = self.driver, self.coupler, self.rocker, self.ground
        near, far = max(abs(b - c), abs(a - d)), min(b + c, a + d)
        return _angle(b, c, near), _angle(b, c, far)


def _angle(p: float, q: float, opposite: float) -> float:
    """Return the angle between sides p and q of a triangle with the given opposite side [rad].

    By half-angle sines: no cancellation where the triangle is nearly flat.
    """
    above = (opposite - (p - q)) * (opposite + (p - q))
    below = ((p + q) - opposite) * ((p + q) + opposite)
    return 2.0 * math.atan2(math.sqrt(max(above, 0.0)), math.sqrt(max(below, 0.0)))


@dataclass(frozen=True)
class GrashofType:
    """Name of a chain and its Grashof margin ``margin_m`` [m]: negative for a non-Grashof chain, 0
    within rounding at a change point. ``driver_turns`` and ``follower_turns`` are True if these
    turn fully against the ground (a block never does)."""

    name: str
    margin_m: float
    driver_turns: bool
    follower_turns: bool


def four_bar_type(bar: FourBar) -> GrashofType:
    """Return the type of a four-bar by its driver, the first of its four lengths."""
    a, b, c, d = lengths = (bar.driver, bar.coupler, bar.rocker, bar.ground)
    excess, small = bar.excess_m, SAME * sum(lengths)
    turns, back = bar.driver_turns_fully, FourBar(c, b, a, d).driver_turns_fully
    if abs(excess) <= small:
        return GrashofType(f"change point, {_special(a, b, c, d, small)}", 0.0, turns, back)
    if excess > 0.0:
        longest = ("driver", "coupler", "rocker", "ground")[lengths.index(max(lengths))]
        name = f"non-Grashof triple-rocker (longest: {longest})"
        return GrashofType(name, -excess, turns, back)
    name = {
        a: "Grashof crank-rocker",
        b: "Grashof double-rocker",
        c: "Grashof rocker-crank",
        d: "Grashof double-crank (drag link)",
    }[min(lengths)]
    return GrashofType(name, -excess, turns, back)


def _special(a: float, b: float, c: float, d: float, small: float) -> str:
    """Return the name of a four-bar in which all links come to lie in line."""

    def same(one: float, other: float) -> bool:
        return abs(one - other) <= small

    if same(a, b) and same(b, c) and same(c, d):
        return "rhombus"
    if same(a, c) and same(b, d):
        return "parallelogram or antiparallelogram"
    if (same(a, b) and same(c, d)) or (same(a, d) and same(b, c)):
        return "kite (deltoid)"
    kinds = {a: "crank-rocker", b: "double-rocker", c: "rocker-crank", d: "double-crank"}
    return f"between {kinds[min(a, b, c, d)]} and triple-rocker"


def slider_crank_type(crank: float, rod: float, offset: float) -> GrashofType:
    """Return the type of a slider-crank driven at its crank: lengths and offset [m].

    Raises
    ------
    ValueError
        Lengths that are not above 0, or with which the loop can not close.
    """
    offset = abs(offset)
    if not (crank > 0.0 and rod > 0.0 and crank + rod >= offset):
        raise ValueError(
            f"crank {crank:g} m, rod {rod:g} m, offset {offset:g} m: lengths above 0 that reach "
            "the line together make a slider-crank"
        )
    margin, small = abs(rod - crank) - offset, SAME * (crank + rod + offset)
    place = "central" if offset <= small else "offset"
    if abs(rod - crank) <= small and offset <= small:
        return GrashofType("change point, isosceles central slider-crank", 0.0, True, True)
    if abs(margin) <= small:
        return GrashofType(f"change point, {place} slider-crank", 0.0, crank < rod, crank > rod)
    if margin < 0.0:
        return GrashofType(f"non-Grashof {place} slider-crank", margin, False, False)
    shortest = "crank" if crank < rod else "rod"
    name = f"Grashof {place} slider-crank ({shortest} turns fully)"
    return GrashofType(name, margin, crank < rod, crank > rod)


def inverted_slider_crank_type(crank: float, ground: float, offset: float) -> GrashofType:
    """Return the type of an inverted slider-crank, its guide ``offset`` [m] beside the guide's pin.

    The block pinned to the crank reaches the guide where it is no nearer to the guide's pin than
    the offset. The guide turns fully (Whitworth) where the crank goes round its pin, else it swings
    (slotted lever).

    Raises
    ------
    ValueError
        Lengths that are not above 0, or with which the loop can not close.
    """
    offset = abs(offset)
    if not (crank > 0.0 and ground > 0.0 and crank + ground >= offset):
        raise ValueError(
            f"crank {crank:g} m, ground {ground:g} m, offset {offset:g} m: lengths above 0 that "
            "reach the guide together make an inverted slider-crank"
        )
    margin, small = abs(ground - crank) - offset, SAME * (crank + ground + offset)
    if abs(margin) <= small:
        return GrashofType("change point, inverted slider-crank", 0.0, True, crank >= ground)
    if margin < 0.0:
        name = "non-Grashof inverted slider-crank (crank and guide swing)"
        return GrashofType(name, margin, False, False)
    if crank < ground:
        return GrashofType("Grashof crank and swinging guide (slotted lever)", margin, True, False)
    return GrashofType("Grashof crank and turning guide (Whitworth)", margin, True, True)


def grashof_of(scene: Scene) -> GrashofType | None:
    """Return the type of a scene; None for another chain. Raises StructureError."""
    structure = analyse(scene)
    if len(structure.order) != 1 or len(structure.groups) != 1 or not scene.driver.is_crank:
        return None
    group = structure.groups[0]
    try:
        if group.kind == "RRR":
            return four_bar_type(FourBar.of(scene))
        if group.kind == "RRP":
            return _slider_crank(scene, group, scene.sliders[group.outer2])
        if group.kind == "RPR":
            return _inverted(scene, group, scene.sliders[group.inner])
    except (ValueError, StructureError):
        return None  # one body holds both ends, or it closes nowhere
    return None


def _slider_crank(scene: Scene, group: Group, slider: Slider) -> GrashofType | None:
    """Return the type of a crank, a rod and a block on the ground."""
    crank, rod = scene.links[scene.driver.link].points, scene.links[group.first].points
    if slider.link is not None or slider.on != GROUND or group.outer1 not in crank:
        return None
    pivot = scene.driver_pivot
    offset = _beside(scene.ground[pivot], slider)
    crank_m = math.dist(crank[pivot], crank[group.outer1])
    return slider_crank_type(crank_m, math.dist(rod[group.outer1], rod[group.inner]), offset)


def _inverted(scene: Scene, group: Group, slider: Slider) -> GrashofType | None:
    """Return the type of a crank, a block pinned to it, and a guide pinned to the ground."""
    crank, pivot = scene.links[scene.driver.link].points, scene.driver_pivot
    pins = (group.outer1, group.outer2)
    held = next((pin for pin in pins if pin in scene.ground), None)
    if slider.link is not None or slider.on not in scene.links or held is None:
        return None
    guide = scene.links[slider.on].points
    if held not in guide or slider.point not in crank:
        return None
    crank_m = math.dist(crank[pivot], crank[slider.point])
    ground_m = math.dist(scene.ground[pivot], scene.ground[held])
    return inverted_slider_crank_type(crank_m, ground_m, _beside(guide[held], slider))


def _beside(point: Point, slider: Slider) -> float:
    """Return the distance of a point of the slider's guide from its line [m]."""
    x, y = point[0] - slider.through_m[0], point[1] - slider.through_m[1]
    return abs(y * math.cos(slider.direction_rad) - x * math.sin(slider.direction_rad))
