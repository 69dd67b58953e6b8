"""Sections of the page, in their order on it.

A function builds a section from the `PageReport`; None where the store has nothing for it. A
further section is a function, a template beside the others, and a line in `SECTIONS`; a way gives
its section as its part ``section``.
"""

from collections.abc import Callable
from typing import cast

from reports.page.sections.cams import build as cams
from reports.page.sections.copied import reading_forces, recommendation
from reports.page.sections.engines import build as engines
from reports.page.sections.errors import convergence, precision
from reports.page.sections.hard import build as hard
from reports.page.sections.motion import build as motion
from reports.page.sections.provenance import fairness, provenance
from reports.page.sections.section import PageReport, Section, WaySection
from reports.page.sections.stability import build as stability
from reports.page.sections.verdict import build as verdict
from reports.protocol.way import own_parts
from reports.results.overview import Report

Build = Callable[[PageReport], Section | None]


def _of_driven(build: Callable[[Report], Section | None]) -> Build:
    """Return the builder of a section on turns and places: driven scenes with rigid links alone."""
    return lambda report: None if report.driven is None else build(report.driven)


OF_WAYS = {name: cast(WaySection, own) for name, own in own_parts("section").items()}
"""Sections of ways, by the name of the way."""
SECTIONS: dict[str, Build] = {
    "verdict": verdict,
    "engines": engines,
    "recommendation": _of_driven(recommendation),
    "precision": _of_driven(precision),
    **{name: own.build for name, own in OF_WAYS.items()},
    "convergence": _of_driven(convergence),
    "reading_forces": _of_driven(reading_forces),
    "motion": _of_driven(motion),
    "cams": cams,
    "stability": stability,
    "hard": hard,
    "fairness": fairness,
    "provenance": provenance,
}
