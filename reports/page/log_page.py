"""The page of a judged log: one HTML file with the verdict, every channel, and the motion."""

import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import PurePath

from models.errors import few
from models.scene.driver import driver_axis
from reports.causes.cause import Cause
from reports.drawing.moving import goes_round, packed, singles
from reports.judge.rules import RULES
from reports.judge.rules.rule import share
from reports.logs.channel import Channel
from reports.output.numbers import count, readable
from reports.own_log import table
from reports.own_log.judged import JudgedLog, LogRow
from reports.page.build import Head, assembled
from reports.page.log_curves import DrawnChannel, Samples, curves
from reports.page.log_motion import has_places, log_motion
from reports.page.sections.section import Section, name_text, sentence_text, toml_text

ROOM = 2_000_000
"""Characters for all curves: with the rest a page stays below 3 MB, Plotly's 4.8 MB aside."""


def log_page(judged: JudgedLog, facts: Mapping[str, str]) -> str:
    """Return the page of a judged log; ``facts`` are versions and the like.

    Raises CrankcheckError for a motion without a reference between the instants of the log.
    """
    drawn = curves(judged, ROOM)
    sections = [
        _verdict(judged, drawn),
        _channels(judged, drawn, has_places(judged)),
        log_motion(judged, drawn),
        _made(judged, facts),
    ]
    return assembled(_head(judged, facts), sections)


def _head(judged: JudgedLog, facts: Mapping[str, str]) -> Head:
    time_s = judged.log.time_s
    return Head(
        title=f"crankcheck: {name_text(PurePath(judged.log.source).name or judged.log.source)}",
        facts=(
            f"beside the {judged.truth_name} of {judged.scene.name}",
            count(len(judged.log.readings), "channel"),
            count(time_s.size, "row"),
            f"{time_s[-1] - time_s[0]:.4g} s" if judged.log.timed else "no times",
        ),
        made=name_text(facts.get("made", "")),
        first="verdict",
    )


MOST_UNUSED = 300
"""Number of unused columns that are listed."""


def _verdict(judged: JudgedLog, drawn: Sequence[DrawnChannel]) -> Section:
    """Return the verdict in one line, its reasons, text for the map, and every error; columns link
    to their curves, by their numbers among those ``drawn``."""
    numbers = {curve.column: number for number, curve in enumerate(drawn)}
    rows = sorted(table.shown_rows(judged), key=lambda row: (row.verdict == "within", -row.taken))
    unused = judged.log.unused
    searched = judged.failures and not judged.scene.is_free  # causes of free motion are not
    unexplained = sentence_text(few(table.unexplained(judged), 6)) if searched else ""
    return Section(
        anchor="verdict",
        title="Verdict",
        template="log_verdict.html",
        words={
            "verdict": sentence_text(table.verdict_line(judged).plain),
            "level": "within" if judged.verdict == "within" else "out",
            "failures": [
                (each.rule, RULES[each.rule].title, sentence_text(each.text))
                for each in judged.failures
            ],
            "causes": [(sentence_text(each.text), map_lines(each)) for each in judged.causes],
            "unexplained": unexplained,
            "fit": table.fit_text(judged) if judged.fit else "",
            "notes": [sentence_text(each) for each in (*judged.notes, judged.known_text) if each],
            "rows": [_row(row, numbers) for row in rows],
            "rest": table.rest_text(judged),
            "not_judged": table.not_judged_lines(judged),
            "unused": [(name_text(name), sentence_text(why)) for name, why in unused[:MOST_UNUSED]],
            "number": len(unused),
        },
        scripts=("copying.js",),
        styles=("log.css",),
    )


def _row(row: LogRow, numbers: dict[str, int]) -> dict[str, object]:
    """Return a row of the table; a gap links to its curve as well."""
    error = row.error
    gap = f"gap of {error.body}"
    columns = row.columns or ((gap,) if gap in numbers else ())
    return {
        "within": row.verdict == "within",
        "columns": [(name_text(name, 40), numbers.get(name)) for name in columns],
        "what": row.what,
        "maximum": error.maximum / row.per_unit,
        "unit": row.unit,
        "pure": error.pure,
        "share": share(error),
        "limit": row.limit.number,
        "origin": row.limit.origin,
        "taken": row.taken,
        "taken_told": table.taken_text(row.taken),
        "time_s": error.time_of_maximum_s,
    }


def map_lines(cause: Cause) -> str:
    """Return the text for the map if the cause is meant in the log; "" if no map corrects it."""
    tables = []
    for column in cause.columns:
        told = {**cause.correction, **cause.of_column.get(column, {})}
        if told:
            pairs = [f"{key} = {toml_text(value)}" for key, value in told.items()]
            tables.append("\n".join(["[[channel]]", f"column = {toml_text(column)}", *pairs]))
    return "\n\n".join(tables)


TITLE = 24
"""Characters of a column that fit along its axis, on a phone as well."""


def _channels(judged: JudgedLog, drawn: Sequence[DrawnChannel], has_places: bool) -> Section:
    """Return the channels, worst first: the log over the reference, below it error and limit."""
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
    head = f"{standing(curve)}: {name_text(curve.column, 40)}"
    return head if curve.column == curve.name else f"{head} ({curve.name})"


def standing(curve: DrawnChannel) -> str:
    """Return the state of a channel against its limit, in a word or two."""
    if curve.taken < 0.0:
        return "not judged"
    verdict = "ok" if all(row.verdict == "within" for row in curve.judged) else "OUT"
    return f"{verdict} {table.taken_text(curve.taken)}"


def _embedded(judged: JudgedLog, curve: DrawnChannel, axes: dict[str, int]) -> dict[str, object]:
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
    """Return rows of a channel as the script reads them; rows at equal instants share an axis."""
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
    """Yield a channel in sentences: its quantity, its largest error, and the limits."""
    yield f"{name_text(curve.column)}: {curve.name}, in {curve.unit}."
    largest = f"{readable(abs(curve.largest), 4)} {curve.unit}"
    yield f"Its largest error is {largest}{f', at t = {curve.worst_s:.6g} s' * judged.log.timed}."
    if not curve.judged:
        why = f"with --drive {judged.drive}" if judged.log.timed else "where it leads the reference"
        yield f"It is not judged {why}."
    for row in curve.judged:
        error = row.error
        joined = " of both its coordinates together" if len(row.columns) > 1 else ""
        where = {"start": " at the start", "passage": " near a change point"}.get(error.kind, "")
        of = f"{readable(error.pure)} {share(error)}, {table.taken_text(row.taken)} of the limit"
        told = f"The {error.quantity} error{joined}{where} is {of}"
        yield f"{told}, {readable(row.limit.number)} ({row.limit.origin})."
    if curve.turns:
        way = "up" if curve.turns > 0 else "down"
        turns = count(abs(curve.turns), "turn")
        yield f"Whole turns do not count: the {judged.truth_name} is drawn {turns} {way}."
    if curve.reading is not None and curve.reading.channel.relative_to:
        yield "The reference is that of both links."
    if curve.whole.is_thinned:
        yield (
            f"Of {curve.total} rows {curve.whole.error.size} are drawn: the smallest and the "
            "largest of each stretch, so that no spike is lost."
        )


MOST_CHANNELS = 400
"""Channels in the table; a mechanism has no more."""


def _made(judged: JudgedLog, facts: Mapping[str, str]) -> Section:
    log = judged.log
    channels = [(each.channel, "") for each in log.readings]
    channels += [(each.channel, "a further copy, for the gap") for each in log.copies]
    return Section(
        anchor="made",
        title="How it was read and judged",
        template="log_made.html",
        words={
            "settings": _settings(judged),
            "channels": [_channel_row(channel, note) for channel, note in channels[:MOST_CHANNELS]],
            "facts": {name_text(k): name_text(str(v)) for k, v in facts.items() if k != "made"},
            "means": table.footer(judged, facts)[0],
        },
    )


def _settings(judged: JudgedLog) -> dict[str, str]:
    log = judged.log
    time_s = log.time_s
    stamp = f"{name_text(log.stamp[0])}, in {log.stamp[1]}"
    if log.zero_s:
        stamp += f", less {log.zero_s:.9g} s"
    limits = {
        name: f"{readable(limit.number)} ({limit.origin})"
        for name, limit in judged.limits.items()
        if judged.errors and any(row.tolerance == name for row in judged.errors.rows)
    }
    return {
        "log": name_text(log.source),
        "scene": judged.scene.name,
        "rows": f"{time_s.size}, t = {time_s[0]:.6g} to {time_s[-1]:.6g} s"
        + " at the driver's peak speed, as the log has no times" * (not log.timed),
        **({"time": stamp} if log.stamp[0] else {}),
        "drive": judged.drive,
        "step": f"{judged.step_s:g} s" if judged.step_s else "not known",
        **{f"limit of {name}": told for name, told in limits.items()},
    }


def _channel_row(channel: Channel, note: str) -> dict[str, str]:
    told = [
        f"sign {channel.sign}" if channel.sign != 1 else "",
        f"offset {channel.offset:g}" if channel.offset else "",
        "wrapped into one turn" if channel.wrapped else "",
        f"{channel.delay_s:g} s later than its row" if channel.delay_s else "",
        f"times of {name_text(channel.time)}" if channel.time else "",
        note,
    ]
    return {
        "column": name_text(channel.column),
        "name": channel.name,
        "unit": channel.unit,
        "told": ", ".join(each for each in told if each),
    }
