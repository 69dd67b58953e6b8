"""The section of beads in the page."""

from pathlib import Path

from reports.page.sections.section import PageReport, Section, WaySection


def build(report: PageReport) -> Section | None:
    lines = report.of_kind("bead")
    if not lines:
        return None
    rows = [
        (line.scene, line.name, f"{cell['period_off']:+.1e}")
        for line in lines
        for cell in line.cells.to_dict("records")
    ]
    return Section("bead", "Beads", Path(__file__).with_name("section.html"), {"rows": rows})


SECTION = WaySection(build)
