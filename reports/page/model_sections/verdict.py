"""The verdict on a model: in one line, why, the lines with what they gain, every joint."""

from __future__ import annotations

import math

from reports.judge.halving import worst_place
from reports.judge.rules import RULES
from reports.own_model.account import CheckedLine
from reports.own_model.judged import JointGap, JudgedModel, errors_of
from reports.own_model.sentences import (
    factor_text,
    share_text,
    step_heads,
    steps_text,
    still_out,
    verdict_text,
)
from reports.page.log_sections.foreign_text import name_text, sentence_text
from reports.page.model_sections.line_looks import line_looks
from reports.page.sections.section import Section


def build(judged: JudgedModel) -> Section:
    """The section."""
    return Section(
        anchor="verdict",
        title="Verdict",
        template="model_verdict.html",
        words={
            "verdict": sentence_text(verdict_text(judged)),
            "level": "within" if judged.verdict == "within" else "out",
            "failures": [
                (each.rule, RULES[each.rule].title, sentence_text(each.text))
                for each in judged.failures
            ],
            "cure": sentence_text(judged.own.remedy),
            "steps": steps_text(judged),
            "heads": step_heads(judged),
            "rows": [_row(judged, one) for one in (*judged.three, *judged.others)],
            "still_out": sentence_text(still_out(judged)),
            "lines": [one.cell.profile for one in judged.three],
            "joints": [_joint(judged, joint) for joint in judged.joints()],
        },
        styles=("log.css", "model.css"),
    )


def _row(judged: JudgedModel, one: CheckedLine) -> dict[str, object]:
    """A line of the table: at each step its error, and what it gains."""
    worst = worst_place(one.errors) if one.errors else None
    steps = len(step_heads(judged))
    first = math.nan if worst is None else worst.pure
    gains = [math.nan] * steps if one is judged.own else judged.gains(one)[:steps]
    ended = one.convergence.words if one.convergence else ""
    if one.status != "ok":
        ended = f"{one.status}: {one.reason}"
    return {
        "look": line_looks(judged).get(one.cell.profile),
        "line": one.cell.profile,
        "within": one.verdict == "within",
        "errors": list(zip([first, *errors_of(one)[1:]], map(_gain, gains), strict=False)),
        "worst": name_text(f"{worst.quantity} of {worst.body}") if worst else "",
        "ended": sentence_text(ended),
    }


def _gain(factor: float) -> str:
    return "" if math.isnan(factor) else factor_text(factor)


def _joint(judged: JudgedModel, joint: JointGap) -> dict[str, object]:
    """A joint: how far open it is drawn, and its widest gap in each line."""
    names = [one.cell.profile for one in judged.three]
    return {
        "name": name_text(joint.name, 40),
        "open_m": joint.open_m,
        "gaps": [joint.gap_m.get(name, math.nan) for name in names],
        "share": joint.share,
        "share_told": share_text(joint.share) if math.isfinite(joint.share) else "",
        "out": joint.share > 1.0,
    }
