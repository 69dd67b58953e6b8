"""The numbers of a steady cycle, works by what does them, and the figures."""

from __future__ import annotations

import base64
from collections.abc import Mapping

from analytic.lectures.regulation.steady_cycle import SteadyCycle
from reports.lectures.machine import cycle_rows
from reports.page.sections.section import Section

CAPTIONS: Mapping[str, str] = {
    "speed": "The speed of the driver over the cycle, and its extremes.",
    "torques": "Torques reduced to the driver, and the work that they have done since the start.",
    "energy-mass": "Work over the machine's own reduced moment of inertia, with its tangents "
    "(Wittenbauer); numbers are angles of the driver in deg.",
}


def build(cycle: SteadyCycle, figures: Mapping[str, bytes]) -> Section:
    """The section; ``figures`` are SVG files by their name."""
    return Section(
        anchor="cycle",
        title="Steady cycle",
        template="steady_cycle.html",
        words={
            "driver": cycle.machine.scene.driver.link,
            "heading": cycle_rows.heading(cycle),
            "rows": cycle_rows.number_rows(cycle),
            "works": cycle_rows.work_rows(cycle),
            "notes": cycle_rows.notes(cycle),
            "figures": [
                (name, CAPTIONS.get(name, name), base64.b64encode(svg).decode("ascii"))
                for name, svg in figures.items()
            ],
        },
        styles=("forces.css",),
    )
