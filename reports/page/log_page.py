"""The page of a judged log: one HTML file with the verdict, every channel, and the motion."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import PurePath

from reports.output.numbers import count
from reports.own_log.judged import JudgedLog
from reports.page.build import Head, assembled
from reports.page.log_sections import channels, made, motion, verdict
from reports.page.log_sections.curves import curves
from reports.page.log_sections.foreign_text import name_text

ROOM = 2_000_000
"""Characters for all curves: with the rest a page stays below 3 MB, Plotly's 4.8 MB aside."""


def log_page(judged: JudgedLog, facts: Mapping[str, str]) -> str:
    """The page of a judged log; ``facts`` are versions and the like.

    Raises
    ------
    CrankcheckError
        A motion that there is no reference for, between the instants of the log.
    """
    drawn = curves(judged, ROOM)
    sections = [
        verdict.build(judged, drawn),
        channels.build(judged, drawn, motion.has_places(judged)),
        motion.build(judged, drawn),
        made.build(judged, facts),
    ]
    return assembled(_head(judged, facts), [each for each in sections if each is not None])


def _head(judged: JudgedLog, facts: Mapping[str, str]) -> Head:
    time_s = judged.log.time_s
    return Head(
        title=f"crankcheck: {name_text(PurePath(judged.log.source).name or judged.log.source)}",
        facts=(
            f"beside the {judged.truth_name} of {judged.scene.name}",
            count(len(judged.log.readings), "channel"),
            count(time_s.size, "row"),
            f"{time_s[-1] - time_s[0]:.4g} s",
        ),
        made=name_text(facts.get("made", "")),
        first="verdict",
    )
