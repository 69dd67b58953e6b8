"""Origin of the numbers: versions, processor, studies, commands, settings and every cell, and the
rules by which engines are compared."""

import json
import math
import shlex
from collections.abc import Mapping, Sequence

from reports.output.write import crankcheck_version
from reports.page.sections.section import Section, setting_rows
from reports.results.lines import Line, left_out, usual
from reports.results.looks import Look
from reports.results.overview import Report


def provenance(report: Report) -> Section:
    """Return the section on the origin of the numbers."""
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
    command, facts = run.get("command"), run.get("provenance")
    typed = shlex.join(str(part) for part in command) if isinstance(command, Sequence) else ""
    return {
        "started": run.get("started", ""),
        "command": typed,
        "facts": facts if isinstance(facts, Mapping) else {},
        "study": json.dumps(run.get("study", {}), indent=1),
    }


def _settings(report: Report, engine: str) -> dict[str, object]:
    variants: dict[Look, Line] = {}
    for line in report.lines:
        if line.engine == engine:
            variants.setdefault(report.look(line), line)
    first = usual(report.lines, engine)
    rows = setting_rows([line.settings for line in variants.values()], first.settings)
    return {"engine": engine, "looks": list(variants), "usual": first.name, "rows": rows}


RULES = {
    "One reference for all engines": "Every engine is compared with the closed-form solution of "
    "the mechanism, whose own error is bounded at every sample. No engine is the reference for "
    "another.",
    "One scene": "Lengths, masses, joints and the assembly branch come from one scene file. Each "
    "engine's model is built from it and from nothing else.",
    "One start": "Every run starts from the same state: angles, positions and velocities of the "
    "closed form at the first instant, with all pins closed.",
    "One drive": "The crank follows the same law everywhere. Its distance from the commanded angle "
    "is the drive error, shown apart from the error of the geometry.",
    "Each engine at its own instants": "Positions and velocities are compared at the instants to "
    "which they belong: some engines log a velocity half a step away from the position.",
    "Rates twice where possible": "Velocities and accelerations are taken as an engine reports "
    "them, and by differencing its logged positions.",
    "Tolerances follow the step": "A limit follows from the step, the curvature of the motion "
    "and the conditioning of its dyads. It is one number per quantity, for every engine "
    "alike.",
    "Judged with profile tuned, shown as shipped": "Profile tuned is judged, with the settings "
    "that suit an engine best. Results as shipped, and with other settings, are shown beside it.",
    "Errors and times apart": "Error runs record every step; timed runs record nothing. Timed runs "
    "go one by one, warmed up, with no other run beside them, several times.",
    "Time is advice": "The shortest of the repeats is shown. Times are compared on one processor "
    "only, and called equal if they differ by less than two timings of one run.",
    "Failed runs stay in": "A run that diverged, came apart or was not supported is a row with its "
    "reason, and takes no part in a recommendation.",
}

LET_GO = {
    "One reference for all engines": (
        "One reference for all engines",
        "Every engine is compared with the equation of the machine, integrated with high "
        "precision; a second integration bounds the error of the first. No engine is the reference "
        "for another.",
    ),
    "One start": (
        "One start",
        "Every run starts from the same state: angles, positions, velocities, the accelerations "
        "from weights and loads, and all pins closed.",
    ),
    "One drive": (
        "No drive",
        "Weights, springs and loads alone move the mechanism. An error of phase is separated from "
        "one of geometry, and judged over the sensitivity of the motion.",
    ),
}
"""Replacements of rules where every run is a free motion."""
BENT = {
    "One reference for all engines": (
        "One reference for all engines",
        "Every engine is compared with the beam with foreshortening, whose motion is solved "
        "without an engine; a finer description estimates the error of that solution. The exact "
        "chain of as many segments shows the error of the engine itself.",
    ),
    "One start": (
        "One start",
        "Every run starts from the same state: that of the exact chain of segments, with all pins "
        "closed.",
    ),
}
"""Replacements of rules where links bend in every run."""


def fairness(report: Report) -> Section:
    """Return the section on the rules."""
    return Section(
        anchor="fairness",
        title="How it is kept fair",
        template="fairness.html",
        words={
            "rules": [_other(report).get(rule[0], rule) for rule in RULES.items()],
            "noise": report.noise if math.isfinite(report.noise) else None,
        },
    )


def _other(report: Report) -> Mapping[str, tuple[str, str]]:
    """Return the replacements of rules, where nothing was driven with rigid links."""
    if report.driven is not None:
        return {}
    kinds = {"free": LET_GO, "elastic": BENT}
    there = (rules for kind, rules in kinds.items() if report.of_kind(kind))
    return {name: rule for rules in there for name, rule in rules.items()}
