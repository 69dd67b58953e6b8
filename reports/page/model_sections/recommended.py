"""The recommended settings, to be copied into the file."""

from __future__ import annotations

from models.errors import harmless
from reports.own_model.judged import JudgedModel
from reports.own_model.sentences import factor_words, is_diff
from reports.page.log_sections.foreign_text import name_text
from reports.page.sections.section import Section


def build(judged: JudgedModel) -> Section:
    """The section."""
    last = judged.lines[-1]
    gain = judged.gains(last)[0]
    return Section(
        anchor="recommended",
        title="Recommended settings",
        template="model_recommended.html",
        words={
            "patch": harmless(judged.patch),
            "is_diff": is_diff(judged.patch),
            "file": name_text(judged.account.request.path.name),
            "within": last.verdict == "within",
            "gain": factor_words(gain) if gain == gain else "",
        },
        scripts=("copying.js",),
        styles=("log.css",),
    )
