"""The mechanism as it was read, in motion: the closed form, and over it the lines."""

from __future__ import annotations

import numpy as np

from models.array import Array
from reports.drawing.moving import INSTANTS, displacements, drawing
from reports.own_model.judged import JudgedModel
from reports.page.log_sections.foreign_text import sentence_text
from reports.page.model_sections.line_looks import line_looks
from reports.page.sections.motion import scene_words
from reports.page.sections.section import Section


def build(judged: JudgedModel) -> Section:
    """The section."""
    time_s = _instants(judged)
    looks = line_looks(judged)
    off = {
        looks[one.cell.profile].number: displacements(judged.scene, one.last_turn, time_s)
        for one in judged.three
    }
    words = scene_words(judged.scene)
    return Section(
        anchor="motion",
        title="In motion",
        template="model_motion.html",
        words={
            "driver": sentence_text(str(words["driver"])),
            "facts": [sentence_text(str(fact)) for fact in words["facts"]],  # type: ignore[attr-defined]  # a list
            "missing": [
                one.cell.profile
                for one in judged.three
                if off[looks[one.cell.profile].number] is None
            ],
        },
        embedded={
            "drawing": drawing(judged.scene, time_s),
            "lines": [{"look": number, "off": rows} for number, rows in off.items() if rows],
        },
        scripts=("legend.js", "mechanism.js", "stage.js", "model_motion.js"),
        styles=("log.css", "model.css"),
    )


def _instants(judged: JudgedModel) -> Array:
    """The instants of the longest last turn of a line; where there is none, those of a turn."""
    empty = np.zeros(0)
    times = [one.last_turn.get("time_s", empty) for one in judged.three if one.status == "ok"]
    longest = max(times, key=len, default=empty)
    if len(longest) > 1:
        return longest
    account = judged.account
    end_s = account.dt_s * account.steps
    start_s = max(0.0, end_s - account.scene.driver.law.period_s)
    return np.linspace(start_s, end_s, INSTANTS)
