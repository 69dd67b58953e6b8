"""What a model holds beside its linkage that can disturb the comparison, kind by kind."""

from __future__ import annotations

from reports.own_model.judged import JudgedModel
from reports.own_model.sentences import EACH, groups
from reports.page.log_sections.foreign_text import sentence_text
from reports.page.sections.section import Section

MOST = 300
"""Things of a kind that are listed."""


def build(judged: JudgedModel) -> Section | None:
    """The section; None where there is nothing of the kind."""
    found = groups(judged)
    if not found:
        return None
    return Section(
        anchor="disturbing",
        title="What can disturb it",
        template="model_disturbing.html",
        words={
            "groups": [
                {
                    "kind": group.kind,
                    "effect": group.effect,
                    "texts": [sentence_text(text) for text in group.texts[:MOST]],
                    "number": len(group.texts),
                }
                for group in found
            ],
            "each": EACH,
        },
        styles=("log.css",),
    )
