"""A flywheel by every way to it, and the cycle without and with it."""

from __future__ import annotations

from analytic.lectures.regulation.flywheel import WantedFlywheel
from reports.lectures.machine import flywheel_rows
from reports.page.sections.section import Section


def build(found: WantedFlywheel) -> Section:
    """The section."""
    return Section(
        anchor="flywheel",
        title="Flywheel",
        template="flywheel.html",
        words={
            "heading": flywheel_rows.heading(found),
            "ways": flywheel_rows.way_rows(found),
            "rows": flywheel_rows.beside_rows(found),
            "notes": flywheel_rows.notes(found),
        },
    )
