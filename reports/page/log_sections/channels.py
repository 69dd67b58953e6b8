"""Channel by channel: the log over the truth, and below it the error with its limit."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence

from models.driver import driver_axis
from reports.drawing.moving import goes_round
from reports.drawing.packed import packed, singles
from reports.judge.rules.rule import share
from reports.output.numbers import count, readable
from reports.own_log.judged import JudgedLog
from reports.own_log.table import taken_text
from reports.page.log_sections.curves import DrawnChannel, Samples
from reports.page.log_sections.foreign_text import name_text
from reports.page.sections.section import Section

TITLE = 24
"""Characters of a column that stand along its axis, on a phone as well."""


def build(judged: JudgedLog, drawn: Sequence[DrawnChannel], has_places: bool) -> Section:
    """The section; the first channel is the worst."""
    axes: dict[str, int] = {}
    channels = [_embedded(judged, curve, axes) for curve in drawn]
    scene = judged.beside.scene
    turning, axis = goes_round(scene), driver_axis(scene)
    return Section(
        anchor="channels",
        title="Channel by channel",
        template="log_channels.html",
        words={
            "options": [_option(curve) for curve in drawn],
            "against": axis.rpartition(" [")[0] if turning else "part of the period",
            "is_thinned": any(curve.near is not None for curve in drawn),
            "has_places": has_places,
            "truth": judged.truth_name,
        },
        embedded={
            "channels": channels,
            "truth": judged.truth_name,
            "axes": [json.loads(axis) for axis in axes],
            "phase": axis if turning else "part of the period [%]",
            "round": 360 if turning else 100,
        },
        scripts=("legend.js", "charts.js", "channels.js"),
        styles=("log.css",),
        plotly=True,
    )


def _option(curve: DrawnChannel) -> str:
    """A channel in the list: how it stands, its column, and what that was read as."""
    head = f"{standing(curve)}: {name_text(curve.column, 40)}"
    return head if curve.column == curve.name else f"{head} ({curve.name})"


def standing(curve: DrawnChannel) -> str:
    """How a channel stands against its limit, in a word or two."""
    if curve.taken < 0.0:
        return "not judged"
    verdict = "ok" if all(row.verdict == "within" for row in curve.judged) else "OUT"
    return f"{verdict} {taken_text(curve.taken)}"


def _embedded(judged: JudgedLog, curve: DrawnChannel, axes: dict[str, int]) -> dict[str, object]:
    """A channel as the script reads it."""
    near = None if curve.near is None else _samples(curve.near, axes)
    return {
        "label": name_text(curve.column, TITLE),
        "unit": curve.unit,
        "told": [*_told(judged, curve)],
        "turn": curve.turn,
        "limit": curve.limit,
        "out": any(row.verdict == "out" for row in curve.judged),
        "whole": _samples(curve.whole, axes),
        "near": near,
    }


def _samples(samples: Samples, axes: dict[str, int]) -> dict[str, object]:
    """Rows of a channel as the script reads them. Those at the same instants share one axis."""
    start = float(samples.time_s[0])
    axis = json.dumps(
        {
            "start": repr(start),  # with all its digits
            "time": singles(samples.time_s - start),
            "phase": packed(samples.phase),
        },
        default=list,
    )
    return {
        "axis": axes.setdefault(axis, len(axes)),
        "thinned": samples.is_thinned,
        "logged": singles(samples.logged),
        "error": packed(samples.error),
        "worst": samples.worst,
    }


def _told(judged: JudgedLog, curve: DrawnChannel) -> Iterator[str]:
    """A channel in sentences: what it was read as, how far it is off, and what that may be."""
    yield f"{name_text(curve.column)}: {curve.name}, in {curve.unit}."
    largest = f"{readable(abs(curve.largest), 4)} {curve.unit}"
    yield f"Its largest error is {largest}, at t = {curve.worst_s:.6g} s."
    if not curve.judged:
        yield f"It is not judged with --drive {judged.drive}."
    for row in curve.judged:
        error = row.error
        joined = " of both its coordinates together" if len(row.columns) > 1 else ""
        where = {"start": " at the start", "passage": " near a change point"}.get(error.kind, "")
        of = f"{readable(error.pure)} {share(error)}, {taken_text(row.taken)} of the limit"
        told = f"The {error.quantity} error{joined}{where} is {of}"
        yield f"{told}, {readable(row.limit.number)} ({row.limit.origin})."
    if curve.turns:
        way = "up" if curve.turns > 0 else "down"
        turns = count(abs(curve.turns), "turn")
        yield f"Whole turns do not count: the {judged.truth_name} is drawn {turns} {way}."
    if curve.reading is not None and curve.reading.channel.relative_to:
        yield "The truth is that of both links."
    if curve.whole.is_thinned:
        yield (
            f"Of {curve.total} rows {curve.whole.error.size} are drawn: the smallest and the "
            "largest of each stretch, so that no spike is lost."
        )
