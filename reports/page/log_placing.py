r"""Place the bodies of a log that holds some places and angles.

A point stands where it was logged. A link lies between its points where two are known, else at its
logged angle about a known point. A four-bar with three logged angles::

        B ------- C     C'      crank     about A, to B
       /           \   /        coupler   about B, to C
      A             \ /         rocker    about D, to an end C' of its own
    -----          --D--

Readings that contradict each other come apart in the picture, as they do in the log. A link between
logged points is drawn at its logged angle as well if that is out of tolerance.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from models.array import Array
from models.motion import Motion
from models.scene import GROUND, Link, Scene
from reports.logs.channel import Reading
from reports.output.numbers import listed

Off = dict[str, Array]
"""Displacements (T, 2) [m] by point."""


@dataclass(frozen=True)
class LogPlacement:
    """Links, blocks (by their points) and lone points that are drawn with the same places: points
    are ``off`` the reference by (T, 2) [m]. ``apart`` is a link with ends of its own."""

    name: str
    links: tuple[str, ...]
    blocks: tuple[str, ...]
    marks: tuple[str, ...]
    apart: bool
    off: Mapping[str, Array]


@dataclass
class Placing:
    """Bodies placed one after the other: ``off`` of points, links ``joined`` there, and ``ends`` of
    links that have ends of their own. Angles ``out`` of tolerance are shown."""

    scene: Scene
    truth: Motion
    turned: Mapping[str, Array]
    out: frozenset[str]
    off: Off = field(default_factory=dict)
    ends: dict[str, Off] = field(default_factory=dict)
    joined: list[str] = field(default_factory=list)
    marks: list[str] = field(default_factory=list)
    origins: dict[str, str] = field(default_factory=dict)

    @cached_property
    def guided(self) -> frozenset[str]:
        """Links that slide on the ground, and do not turn."""
        sliders = self.scene.sliders.values()
        return frozenset(s.link for s in sliders if s.link is not None and s.on == GROUND)

    def take_points(self, errors: Sequence[tuple[Reading, Array]]) -> None:
        """Place the logged points; the reference gives a coordinate that is not logged."""
        logged: dict[str, dict[int, Array]] = {}
        for reading, off in errors:
            if (axis := reading.channel.kind.axis) is not None:
                logged.setdefault(reading.channel.of, {})[axis] = off
        for name, own in logged.items():
            right = np.zeros(len(self.truth.time_s))
            self.off[name] = np.column_stack([own.get(axis, right) for axis in (0, 1)])
            only = "xy"[next(iter(own))]
            told = "x and y" if len(own) == 2 else f"{only}; the other is that of the truth"
            self.origins[name] = told
            self.marks.append(name)

    def take_sliders(self, errors: Sequence[tuple[Reading, Array]]) -> None:
        """Place the points of sliders, along their guides."""
        for reading, off in errors:
            if reading.channel.kind.body_kind != "slider":
                continue
            slider = self.scene.sliders[reading.channel.of]
            if slider.point in self.off:
                continue
            angle = np.full(off.shape, slider.direction_rad)
            if slider.on != GROUND:
                angle = angle + self.truth.links[slider.on].theta
            self.off[slider.point] = off[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
            self.origins[slider.name] = "its displacement"

    def take_links(self) -> None:
        """Place the links: between known points, about one of them, and at any logged angle, over
        and over, as each gives places to the next."""
        left = dict(self.scene.links)
        ways = (self._take_spanned, self._take_hanging, self._take_free)
        while left:
            taken = next((x.name for way in ways for x in left.values() if way(x)), None)
            if taken is None:
                return
            del left[taken]

    def _placed(self, link: Link) -> list[str]:
        """Return the points of a link that have a place, ground points first."""
        ground = [name for name in link.points if name in self.scene.ground]
        return ground + [name for name in link.points if name in self.off]

    def _take_spanned(self, link: Link) -> bool:
        """Place a link between its points, if at least two are known, and its angle does not
        contradict them. Return False if not."""
        placed = self._placed(link)
        logged = all(name in self.scene.ground or name in self.marks for name in placed)
        by_angle = link.name in self.turned
        if len(placed) < 2 or (by_angle and not logged):
            return False
        self.joined.append(link.name)
        self.origins[link.name] = f"between {listed(placed)}"
        spanned = self._ends(link, placed[0], self._direction_off(placed[0], placed[1]))
        self.off = {**spanned, **self.off}
        if by_angle and link.name in self.out:
            self.ends[link.name] = self._ends(link, placed[0], self.turned[link.name])
            self.origins[link.name] += f", and by its angle, about {placed[0]}"
        return True

    def _take_hanging(self, link: Link) -> bool:
        placed = self._placed(link)
        by = {**dict.fromkeys(self.guided, "guide"), **dict.fromkeys(self.turned, "angle")}
        if not placed or link.name not in by:
            return False
        still = np.zeros(len(self.truth.time_s))
        ends = self._ends(link, placed[0], self.turned.get(link.name, still))
        self.origins[link.name] = f"its {by[link.name]}, about {placed[0]}"
        if len(placed) == 1:
            self.joined.append(link.name)
            self.off |= ends
        else:
            self.ends[link.name] = ends
        return True

    def _take_free(self, link: Link) -> bool:
        """Place a link at its angle about its first point of the reference; no other is known."""
        if link.name not in self.turned:
            return False
        about = next(iter(link.points))
        self.ends[link.name] = self._ends(link, about, self.turned[link.name])
        self.origins[link.name] = f"its angle, about {about} of the truth"
        return True

    def _direction_off(self, first: str, second: str) -> Array:
        """Return the error of the direction from a point to another (T,) [rad]."""
        right = self.truth.points[second].position - self.truth.points[first].position
        nothing = np.zeros_like(right)
        off = self.off.get(second, nothing) - self.off.get(first, nothing)
        cross = right[:, 0] * off[:, 1] - right[:, 1] * off[:, 0]
        return np.asarray(np.arctan2(cross, np.sum(right * (right + off), axis=1)))

    def _ends(self, link: Link, about: str, turned: Array) -> Off:
        """Return the points of a link that is turned about one of them by angles (T,)."""
        base = self.off.get(about, np.zeros((turned.size, 2)))
        middle = self.truth.points[about].position
        return {
            name: base + _swung(self.truth.points[name].position - middle, turned)
            for name in link.points
            if name not in self.scene.ground
        }

    def pieces(self) -> Iterator[LogPlacement]:
        """Yield the piece of all joined bodies first, then the links with ends of their own."""
        joined = tuple(self.joined)
        blocks = tuple(s.point for s in self.scene.sliders.values() if s.point in self.off)
        drawn = {*blocks, *(point for name in joined for point in self.scene.links[name].points)}
        marks = tuple(name for name in self.marks if name not in drawn)
        if joined or blocks or marks:
            yield LogPlacement("the log", joined, blocks, marks, False, self.off)
        for name, ends in self.ends.items():
            yield LogPlacement(f"{name} by its angle", (name,), (), (), True, ends)


def _swung(arm: Array, angle: Array) -> Array:
    """Return the displacement of the ends of arms (T, 2) that turn by angles (T,)."""
    c, s = np.cos(angle) - 1.0, np.sin(angle)
    return np.column_stack([c * arm[:, 0] - s * arm[:, 1], s * arm[:, 0] + c * arm[:, 1]])
