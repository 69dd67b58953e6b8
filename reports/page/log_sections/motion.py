"""The mechanism in motion: the truth, and over it what the log has of it, its error magnified."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from models.array import Array
from models.motion import Motion
from reports.drawing.moving import INSTANTS, drawing
from reports.own_log.judged import JudgedLog
from reports.page.log_sections.bodies import LoggedBodies, logged_bodies, truth_of_all
from reports.page.log_sections.curves import DrawnChannel, turn_s
from reports.page.sections.motion import scene_words
from reports.page.sections.section import Section

WHOLE = 1.25
"""A log of no more turns is drawn whole."""
ROOM = 0.6
"""How far beyond the truth a log is kept in the picture, over the truth's size."""
LIKE = 0.25
"""Stretches that begin within so much of a turn are one."""


@dataclass(frozen=True)
class Stretch:
    """A part of the log that is drawn: what it is called, and from when until when [s]."""

    name: str
    start_s: float
    end_s: float


def build(judged: JudgedLog, drawn: Sequence[DrawnChannel]) -> Section | None:
    """The section; None where the log has no place of a body. Raises CrankcheckError."""
    if not has_places(judged):
        return None
    shown = [(each, _instants(each)) for each in stretches(judged, drawn)]
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
            ],
        },
        scripts=("mechanism.js", "stage.js", "log_motion.js"),
        styles=("log.css",),
    )


def _drawing(truth: Motion, bodies: LoggedBodies) -> dict[str, object]:
    """The truth to be drawn, with room for what the log has of it."""
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
    """Whether the log says of any body where it is."""
    return any(reading.channel.kind.order == 0 for reading in judged.log.readings)


def _instants(stretch: Stretch) -> Array:
    return np.linspace(stretch.start_s, stretch.end_s, INSTANTS)


def stretches(judged: JudgedLog, drawn: Sequence[DrawnChannel]) -> list[Stretch]:
    """The whole of a short log; of a longer one the turn of the largest error of a place, the first
    and the last."""
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
    """Where the turn begins in whose middle the worst place is, as far as the log goes."""
    worst = next(
        (x for x in drawn if x.reading is not None and x.reading.channel.kind.order == 0), None
    )
    middle = first if worst is None else worst.worst_s
    return min(max(middle - turn / 2.0, first), last - turn)


def _told(bodies: LoggedBodies) -> list[tuple[str, str]]:
    """Of each body that is drawn, from what of the log: links first, in their order."""
    links = {name: n for n, name in enumerate(bodies.scene.links)}
    return sorted(bodies.origins.items(), key=lambda pair: links.get(pair[0], len(links)))
