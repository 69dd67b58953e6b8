"""What was let go: how far each engine still knew where it was."""

from __future__ import annotations

from reports.page.sections.section import Section
from reports.results.overview import Report

SHOWN = (
    *("phase_pure", "phase_limit_pure", "geometry_pure", "gap_pure", "energy_pure"),
    *("horizon_1e-1_s", "horizon_1e-3_s", "precision", "sensitivity", "dt_s", "verdict"),
)
"""The columns of the table."""


def build(report: Report) -> Section | None:
    """The section; None where everything was driven."""
    rows = [
        {"scene": line.scene, "look": report.look(line)} | {name: cell[name] for name in SHOWN}
        for line in report.lines
        if line.drive == "free"
        for cell in line.cells.to_dict("records")
    ]
    if not rows:
        return None
    return Section(anchor="free", title="Let go", template="free.html", words={"rows": rows})
