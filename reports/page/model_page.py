"""The page of a judged model: one HTML file with the verdict, its lines, the motion, the diff."""

from __future__ import annotations

from collections.abc import Mapping

from reports.output.numbers import count
from reports.own_model.judged import JudgedModel
from reports.page.build import Head, assembled
from reports.page.log_sections.foreign_text import name_text
from reports.page.model_sections import disturbing, lines, made, motion, recommended, verdict
from reports.page.model_sections.line_looks import line_looks


def model_page(judged: JudgedModel, facts: Mapping[str, str]) -> str:
    """The page of a judged model; ``facts`` are versions and the like."""
    sections = [
        verdict.build(judged),
        lines.build(judged),
        motion.build(judged),
        disturbing.build(judged),
        recommended.build(judged),
        made.build(judged, facts),
    ]
    return assembled(_head(judged, facts), [each for each in sections if each is not None])


def _head(judged: JudgedModel, facts: Mapping[str, str]) -> Head:
    account = judged.account
    request = account.request
    return Head(
        title=f"crankcheck: {name_text(request.path.name)}",
        facts=(
            f"{name_text(request.joint)} driven at {request.speed_rad_s:g} rad/s",
            count(len(account.scene.links), "link"),
            f"{account.steps} steps of {account.dt_s:g} s",
            *(f"{one.cell.engine} {one.version}" for one in judged.lines[:1] if one.version),
        ),
        made=name_text(facts.get("made", "")),
        first="verdict",
        looks=list(line_looks(judged).values()),
    )
