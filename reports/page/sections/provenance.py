"""Where the numbers come from: versions, processor, studies, commands, settings, every cell."""

from __future__ import annotations

import json
import math
import shlex
from collections.abc import Mapping, Sequence

from reports.output.provenance import crankcheck_version
from reports.page.sections.section import Section
from reports.results.lines import Line
from reports.results.looks import Look
from reports.results.one_processor import left_out
from reports.results.overview import Report
from reports.results.settings_text import usual, value_text


def build(report: Report) -> Section:
    """The section."""
    runs = [_run(run) for run in report.stored.manifest.runs]
    older = len(report.stored.cells) - len(report.cells)
    return Section(
        anchor="provenance",
        title="Where the numbers come from",
        template="provenance.html",
        words={
            "runs": runs,
            "written_by": crankcheck_version(),
            "older": older,
            "damage": report.stored.notice,
            "other_processors": left_out(report.stored.cells),
            "settings": [_settings(report, engine) for engine in report.engines],
            "cells": [
                {"look": report.look(line), "drive_pure": math.nan, **row}
                for line in report.lines
                for row in line.cells.to_dict("records")
            ],
            "scenes": report.stored.manifest.scenes,
        },
    )


def _run(run: Mapping[str, object]) -> dict[str, object]:
    """A run of the sweep: when, what was typed, on what, and its study."""
    command, facts = run.get("command"), run.get("provenance")
    typed = shlex.join(str(part) for part in command) if isinstance(command, Sequence) else ""
    return {
        "started": run.get("started", ""),
        "command": typed,
        "facts": facts if isinstance(facts, Mapping) else {},
        "study": json.dumps(run.get("study", {}), indent=1),
    }


def _settings(report: Report, engine: str) -> dict[str, object]:
    """All settings of all variants of an engine: a row per setting."""
    variants: dict[Look, Line] = {}
    for line in report.lines:
        if line.engine == engine:
            variants.setdefault(report.look(line), line)
    first = usual(report.lines, engine)
    rows = []
    for name in dict.fromkeys(name for line in variants.values() for name in line.settings):
        known = value_text(first.settings.get(name))
        values = [value_text(line.settings.get(name)) for line in variants.values()]
        rows.append((name, [(value, value != known) for value in values]))
    return {"engine": engine, "looks": list(variants), "usual": first.name, "rows": rows}
