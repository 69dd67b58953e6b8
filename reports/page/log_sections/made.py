"""How the log was read and judged: columns, drive, limits, versions."""

from __future__ import annotations

from collections.abc import Mapping

from reports.logs.channel import Channel
from reports.output.numbers import readable
from reports.own_log.judged import JudgedLog
from reports.own_log.table import footer
from reports.page.log_sections.foreign_text import name_text
from reports.page.sections.section import Section

MOST = 400
"""Channels in the table; a mechanism has no more."""


def build(judged: JudgedLog, facts: Mapping[str, str]) -> Section:
    """The section."""
    log = judged.log
    channels = [(each.channel, "") for each in log.readings]
    channels += [(each.channel, "a further copy, for the gap") for each in log.copies]
    return Section(
        anchor="made",
        title="How it was read and judged",
        template="log_made.html",
        words={
            "settings": _settings(judged),
            "channels": [_row(channel, note) for channel, note in channels[:MOST]],
            "facts": {name_text(k): name_text(str(v)) for k, v in facts.items() if k != "made"},
            "means": footer(judged, facts)[0],
        },
    )


def _settings(judged: JudgedLog) -> dict[str, str]:
    """What the log was judged by."""
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
        "rows": f"{time_s.size}, t = {time_s[0]:.6g} to {time_s[-1]:.6g} s",
        **({"time": stamp} if log.stamp[0] else {}),
        "drive": judged.drive,
        "step": f"{judged.step_s:g} s" if judged.step_s else "not known",
        **{f"limit of {name}": told for name, told in limits.items()},
    }


def _row(channel: Channel, note: str) -> dict[str, str]:
    """A column with all that was made of it; empty where there is nothing to say."""
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
