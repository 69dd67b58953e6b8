"""Page of `sensitivity --engine`: the gradient of each engine over that of the reference."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from reports.lectures.machine.engine_gradients import TOLERANCE, EngineGradient, Question
from reports.lectures.machine.gradient_table import angle_text
from reports.output.numbers import count, short
from reports.output.write import crankcheck_version
from reports.page.build import Head, assembled
from reports.page.sections.section import Section, name_text, sentence_text

ROW, BAR, DIAL = 22.0, 62.0, 30.0
"""Height of a dimension in a figure, and lengths of its largest bar and of the arrow of the
reference [px]."""


def gradient_page(question: Question, found: Sequence[EngineGradient]) -> str:
    """Return the page of a comparison, one file that loads nothing."""
    compared = [one for one in found if one.slopes is not None]
    out = [one for one in compared if not one.within]
    verdict = f"{len(out)} of {count(len(compared), 'gradient')} beyond {TOLERANCE:g}"
    section = Section(
        anchor="gradients",
        title=f"Gradient of {name_text(question.of)}",
        template="gradients.html",
        words={
            "verdict": verdict if out else f"All gradients within {TOLERANCE:g}",
            "level": "out" if out else "within",
            "steps": question.steps,
            "height": ROW * len(question.names) + 8.0,
            "engines": [_engine(question, one) for one in compared],
            "rows": [
                {**row, "angle": angle_text(row["angle_rad"]), "size": short(row["error"])}
                for one in compared
                for row in one.rows()
            ],
            "refused": [
                (one.label, one.method, sentence_text(one.refusal)) for one in found if one.refusal
            ],
        },
        styles=("gradients.css",),
    )
    turn = question.scene.driver.law.period_s / question.dt_s
    facts = (
        *dict.fromkeys(f"{one.engine} {one.version}" for one in found),
        f"{turn:g} steps in a turn",
        f"crankcheck {crankcheck_version()}",
    )
    title = f"crankcheck: gradients of {name_text(question.scene.name)}"
    return assembled(Head(title, facts, made="", first="gradients"), [section])


def _engine(question: Question, one: EngineGradient) -> dict[str, object]:
    """Return an engine's figures, one for each number of steps."""
    return {
        "name": one.label,
        "method": one.method,
        "figures": [
            {
                "steps": number,
                "bars": list(_bars(question, one, k)),
                "arrow": _arrow(one, k),
                "angle": angle_text(one.angle(k)),
                "error": short(one.error(k)),
                "within": one.is_within(k),
                "findings": [sentence_text(text) for text in one.findings(k)],
            }
            for k, number in enumerate(question.steps)
        ],
    }


def _bars(
    question: Question, one: EngineGradient, k: int
) -> Iterator[tuple[str, float, float, float]]:
    """Yield each dimension with its height in the figure, and the ends of the bars of the reference
    and of the engine, which is not a number without a derivative by it. Of a follower with two
    coordinates the larger one is drawn."""
    assert one.slopes is not None
    columns = question.followed
    truth, own = question.truth[k][:, columns], one.slopes[k][:, columns]
    sizes = np.nan_to_num(np.abs(truth)).max(axis=0)
    column = int(np.argmax(sizes))
    largest = float(sizes[column]) or 1.0
    for p, name in enumerate(question.names):
        ends = [float(np.clip(each[p, column] / largest, -1.15, 1.15)) for each in (truth, own)]
        yield name_text(name), ROW * (p + 0.5) + 4.0, BAR * ends[0], BAR * ends[1]


def _arrow(one: EngineGradient, k: int) -> tuple[float, float] | None:
    """Return the head of the engine's arrow, in the plane of both gradients, that of the reference
    along x; None for a gradient of zero."""
    own, truth = one.vectors(k)
    angle = one.angle(k)
    if math.isnan(angle):
        return None
    length = DIAL * min(float(np.linalg.norm(own) / np.linalg.norm(truth)), 1.3)
    return length * math.cos(angle), -length * math.sin(angle)
