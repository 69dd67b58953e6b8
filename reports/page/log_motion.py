r"""The mechanism in motion: the reference, and over it the logged bodies, their error magnified.

Bodies that the log does not place are left out. A point stands where it was logged. A link lies
between its points where two are known, else at its logged angle about a known point. A four-bar
with three logged angles::

        B ------- C     C'      crank     about A, to B
       /           \   /        coupler   about B, to C
      A             \ /         rocker    about D, to an end C' of its own
    -----          --D--

Readings that contradict each other come apart in the picture, as they do in the log. A link between
logged points is drawn at its logged angle as well if that is out of tolerance.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from models.array import Array
from models.motion import Motion
from models.scene import GROUND, Link, Scene
from reports.compare.compare import Truth
from reports.drawing.moving import FARTHEST, INSTANTS, drawing, drawn_links, moving_points, packed
from reports.drawing.pair_curves import places_of
from reports.logs.channel import Reading
from reports.output.numbers import listed
from reports.own_log.judged import JudgedLog, log_rows
from reports.page.log_curves import DrawnChannel, turn_s
from reports.page.sections.motion import scene_words
from reports.page.sections.section import Section

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
            told = "x and y" if len(own) == 2 else f"{only}; the other is the reference's"
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
        self.origins[link.name] = f"its angle, about {about} of the reference"
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


WHOLE = 1.25
"""Turns up to which a log is drawn whole."""
ROOM = 0.6
"""Margin beyond the reference in which a log is kept in the picture, over the reference's size."""
LIKE = 0.25
"""Distance of two starts [turns] below which their stretches are one."""


@dataclass(frozen=True)
class Stretch:
    """A part of the log that is drawn: its name, start and end [s]."""

    name: str
    start_s: float
    end_s: float


def log_motion(judged: JudgedLog, drawn: Sequence[DrawnChannel]) -> Section | None:
    """Return the section; None where the log has no place of a body. Raises CrankcheckError."""
    if not has_places(judged):
        return None
    shown = [
        (each, np.linspace(each.start_s, each.end_s, INSTANTS)) for each in stretches(judged, drawn)
    ]
    truth = truth_of_all(judged)
    bodies = [logged_bodies(judged, truth, time_s) for _, time_s in shown]
    return Section(
        anchor="motion",
        title="In motion",
        template="log_motion.html",
        words={
            "scene": scene_words(judged.beside.scene),
            "names": [stretch.name for stretch, _ in shown],
            "truth": judged.truth_name,
            "origins": _told(bodies[0]),
            "left_out": bodies[0].left_out,
            "apart": any(piece.apart for piece in bodies[0].pieces),
        },
        embedded={
            "stretches": [
                {
                    "start": repr(stretch.start_s),  # with all its digits
                    "end": repr(stretch.end_s),
                    "drawing": _drawing(truth.at(time_s), body),
                    "pieces": body.embedded(time_s.size),
                }
                for (stretch, time_s), body in zip(shown, bodies, strict=True)
            ]
        },
        scripts=("mechanism.js", "stage.js", "log_motion.js"),
        styles=("log.css",),
    )


def _drawing(truth: Motion, bodies: LoggedBodies) -> dict[str, object]:
    """Return the drawing of the reference, with room for the logged bodies."""
    shape = drawing(bodies.scene, truth.time_s, truth)
    right = places_of(bodies.scene, truth)
    low, high = right.min(axis=0), right.max(axis=0)
    beyond = ROOM * float(np.max(high - low))
    logged = [
        truth.points[name].position + off
        for piece in bodies.pieces
        for name, off in piece.off.items()
    ]
    every = np.clip(np.concatenate([right, *logged]), low - beyond, high + beyond)
    return {**shape, "box": [*np.nanmin(every, axis=0), *np.nanmax(every, axis=0)]}


def has_places(judged: JudgedLog) -> bool:
    """True if the log has a place or an angle of any body."""
    return any(reading.channel.kind.order == 0 for reading in judged.log.readings)


def stretches(judged: JudgedLog, drawn: Sequence[DrawnChannel]) -> list[Stretch]:
    """Return the whole of a short log; of a longer one the turn of the largest error of a place,
    the first and the last."""
    first, last = float(judged.log.time_s[0]), float(judged.log.time_s[-1])
    turn = turn_s(judged)
    if last - first <= WHOLE * turn:
        return [Stretch("the whole log", first, last)]
    starts = {
        "the turn of the largest error": _worst_start(drawn, first, last, turn),
        "the first turn": first,
        "the last turn": last - turn,
    }
    names: dict[float, list[str]] = {}
    for name, start in starts.items():
        like = next((x for x in names if abs(x - start) <= LIKE * turn), start)
        names.setdefault(like, []).append(name)
    return [Stretch(", ".join(told), start, start + turn) for start, told in names.items()]


def _worst_start(drawn: Sequence[DrawnChannel], first: float, last: float, turn: float) -> float:
    worst = next(
        (x for x in drawn if x.reading is not None and x.reading.channel.kind.order == 0), None
    )
    middle = first if worst is None else worst.worst_s
    return min(max(middle - turn / 2.0, first), last - turn)


def _told(bodies: LoggedBodies) -> list[tuple[str, str]]:
    """Return the bodies that are drawn with their channels: links first, in their order."""
    links = {name: n for n, name in enumerate(bodies.scene.links)}
    return sorted(bodies.origins.items(), key=lambda pair: links.get(pair[0], len(links)))


@dataclass(frozen=True)
class LoggedBodies:
    """Logged bodies at some instants: the pieces that are drawn, the error of the angles of links
    (T,) [rad], and the origin in words of each body that is drawn."""

    scene: Scene
    pieces: tuple[LogPlacement, ...]
    turned: Mapping[str, Array]
    origins: Mapping[str, str]

    @property
    def left_out(self) -> list[str]:
        """Links that the log does not place."""
        drawn = {name for piece in self.pieces for name in piece.links}
        return [name for name in self.scene.links if name not in drawn]

    def embedded(self, samples: int) -> list[dict[str, object]]:
        """Return the pieces as the script reads them, with rows as in `reports.drawing.moving`."""
        return [
            {
                "name": piece.name,
                "apart": piece.apart,
                "only": {"links": piece.links, "blocks": piece.blocks, "marks": piece.marks},
                "rows": packed(self._rows(piece, samples)),
            }
            for piece in self.pieces
        ]

    def _rows(self, piece: LogPlacement, samples: int) -> Array:
        nowhere = np.full((samples, 2), np.nan)
        places = [piece.off.get(name, nowhere).T for name in moving_points(self.scene)]
        angles = [[self.turned.get(name, np.zeros(samples))] for name in drawn_links(self.scene)]
        reach = FARTHEST * self.scene.longest_m
        return np.asarray(np.clip(np.vstack([*places, *angles]), -reach, reach))


def truth_of_all(judged: JudgedLog) -> Truth:
    """Return the reference of the log for every body: the judged quantities may need fewer."""
    return replace(judged.beside.truth, bound=False, links=None, points=None, _motions={})


def logged_bodies(judged: JudgedLog, truth_of: Truth, time_s: Array) -> LoggedBodies:
    """Return the logged bodies at instants (T,), beside a reference of every point."""
    scene, truth = judged.beside.scene, truth_of.at(time_s)
    errors = [
        (reading, _error_at(truth_of, reading, time_s))
        for reading in judged.log.readings
        if reading.channel.kind.order == 0
    ]
    angles = [row for row in log_rows(judged) if row.error.quantity in ("angle", "drive")]
    out = frozenset(row.error.body for row in angles if row.verdict == "out")
    placing = Placing(scene, truth, _turned(errors, time_s.size), out)
    placing.take_points(errors)
    placing.take_sliders(errors)
    placing.take_links()
    return LoggedBodies(scene, tuple(placing.pieces()), placing.turned, placing.origins)


def _error_at(truth: Truth, reading: Reading, time_s: Array) -> Array:
    """Return the error of a reading between its instants by straight lines, NaN beyond them; whole
    turns that an angle loses on the way are no error."""
    after = np.searchsorted(reading.instants, time_s)
    near = np.unique(np.concatenate([after - 1, after]))
    rows = near[(near >= 0) & (near < reading.instants.size)]
    own = reading.instants[rows]
    error = reading.channel.error(reading.values[rows], reading.channel.expected(truth.at(own)))
    if reading.channel.kind.turns:
        error = np.unwrap(error)
    return np.interp(time_s, own, error, left=math.nan, right=math.nan)


def _turned(errors: Sequence[tuple[Reading, Array]], samples: int) -> dict[str, Array]:
    """Return the angle errors of links; a relative angle has that of the other link as well."""
    own = {e.channel.of: (e.channel.relative_to, off) for e, off in errors if e.channel.kind.turns}
    found: dict[str, Array] = {}
    for link in own:
        total, at, passed = np.zeros(samples), link, set[str]()
        while at in own and at not in passed:
            passed.add(at)
            total, at = total + own[at][1], own[at][0]
        found[link] = total
    return found
