"""How the model was read, driven and run: settings of every line, versions."""

from __future__ import annotations

from collections.abc import Mapping

from reports.own_model.judged import JudgedModel
from reports.own_model.sentences import footer, reading
from reports.page.log_sections.foreign_text import name_text, sentence_text
from reports.page.sections.section import Section
from reports.results.settings_text import value_text


def build(judged: JudgedModel, facts: Mapping[str, str]) -> Section:
    """The section."""
    account = judged.account
    told = {"file": str(account.request.path), **reading(account)}
    return Section(
        anchor="made",
        title="How it was read and run",
        template="model_made.html",
        words={
            "told": {head: sentence_text(text) for head, text in told.items()},
            "lines": [one.cell.profile for one in judged.lines],
            "settings": _settings(judged),
            "facts": {name_text(k): name_text(str(v)) for k, v in facts.items() if k != "made"},
            "means": [sentence_text(text) for text in footer(judged)],
        },
        styles=("log.css",),
    )


def _settings(judged: JudgedModel) -> list[tuple[str, list[tuple[str, bool]]]]:
    """Each setting with its value in every line, and whether that is another than as written."""
    names = dict.fromkeys(name for one in judged.lines for name in one.settings)
    rows = []
    for name in names:
        own = value_text(judged.own.settings.get(name))
        values = [value_text(one.settings.get(name)) for one in judged.lines]
        rows.append((name, [(name_text(value), value != own) for value in values]))
    return rows
