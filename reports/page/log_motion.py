"""The mechanism in motion: the reference, and over it the logged bodies, their error magnified.

Bodies that the log does not place are left out; `reports.page.log_placing` places the rest.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from models.array import Array
from models.motion import Motion
from models.scene import Scene
from reports.compare.compare import Truth
from reports.drawing.moving import FARTHEST, INSTANTS, drawing, drawn_links, moving_points, packed
from reports.logs.channel import Reading
from reports.own_log.judged import JudgedLog, log_rows
from reports.page.log_curves import DrawnChannel, turn_s
from reports.page.log_placing import LogPlacement, Placing
from reports.page.sections.motion import scene_words
from reports.page.sections.section import Section

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
    right = np.concatenate([point.position for point in truth.points.values()])
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
    """Return the start of the turn with the worst place at its middle, within the log."""
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
    placing = Placing(scene, truth, _turned(errors, time_s.size), _angles_out(judged))
    placing.take_points(errors)
    placing.take_sliders(errors)
    placing.take_links()
    return LoggedBodies(scene, tuple(placing.pieces()), placing.turned, placing.origins)


def _angles_out(judged: JudgedLog) -> frozenset[str]:
    angles = [row for row in log_rows(judged) if row.error.quantity in ("angle", "drive")]
    return frozenset(row.error.body for row in angles if row.verdict == "out")


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
