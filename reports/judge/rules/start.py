"""CC116: the rates of the first samples are within what taking up the pins explains."""

from __future__ import annotations

import math

from reports.compare.errors import Error, Errors
from reports.judge.rules.rule import Evidence, Finding, Level, place, share
from reports.judge.start_allowance import allowance
from reports.judge.tolerance import in_passage


class StartWithin:
    id = "CC116"
    title = "start"
    explanation = (
        "An engine may take some samples to take up its pins; its rates may jump meanwhile by "
        "half a step's acceleration, and no further. Where joints are solved for in each step, "
        "accelerations may be off by what they change by in a step."
    )
    cure = (
        "Start the engine with the velocities of the instant that its own belong to, or shorten "
        "the step."
    )

    def check(self, evidence: Evidence) -> Finding | None:
        errors = evidence.errors
        every = errors.rows if errors else ()
        rows = [row for row in every if row.kind == "start" and row.tolerance in evidence.limits]
        if errors is None or not rows:
            return None
        limits = {row.tolerance: start_limit(row.tolerance, evidence, errors) for row in rows}

        def part(row: Error) -> float:
            taken = row.pure / limits[row.tolerance]
            return math.inf if math.isnan(taken) else taken

        worst = max(rows, key=part)
        limit = limits[worst.tolerance]
        level: Level = "pass" if worst.pure <= limit else "fail"
        text = f"{worst.tolerance}, {place(worst)}; limit {limit:.2g} {share(worst)}"
        return Finding(self.id, level, text, worst.pure, limit)


def start_limit(tolerance: str, evidence: Evidence, errors: Errors) -> float:
    """What a rate of the first samples is held to, as a pure number."""
    return _settled(tolerance, evidence, errors) + allowance(tolerance, errors, evidence.placing)


def _settled(tolerance: str, evidence: Evidence, errors: Errors) -> float:
    """The limit that later samples are held to, near a change point if the start is."""
    limit = evidence.limits[tolerance]
    return (
        in_passage(tolerance, limit, errors) if errors.of_scene.starts_in_passage else limit
    ).number
