"""The page of a steady cycle, and of a flywheel: one HTML file."""

import base64
from collections.abc import Mapping

from analytic.lectures.regulation.flywheel import WantedFlywheel
from analytic.lectures.regulation.steady_cycle import SteadyCycle
from reports.lectures.machine import cycle_rows
from reports.lectures.machine.regulation_figures import REGULATION_FIGURES, Regulated
from reports.output.numbers import count
from reports.output.write import crankcheck_version
from reports.page.build import Head, assembled
from reports.page.sections.section import Section

CAPTIONS: Mapping[str, str] = {
    "speed": "The speed of the driver over the cycle, and its extremes.",
    "torques": "Torques reduced to the driver, and the work that they have done since the start.",
    "energy-mass": "Work over the machine's own reduced moment of inertia, with its tangents "
    "(Wittenbauer); numbers are angles of the driver in deg.",
}


def cycle_section(cycle: SteadyCycle, figures: Mapping[str, bytes]) -> Section:
    """The section of a cycle; ``figures`` are SVG files by their name."""
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


def flywheel_section(found: WantedFlywheel) -> Section:
    """The section of a flywheel."""
    return Section(
        anchor="flywheel",
        title="Flywheel",
        template="flywheel.html",
        words={
            "heading": cycle_rows.flywheel_heading(found),
            "ways": cycle_rows.way_rows(found),
            "rows": cycle_rows.beside_rows(found),
            "notes": cycle_rows.flywheel_notes(found),
        },
    )


def regulation_page(cycle: SteadyCycle, found: WantedFlywheel | None) -> str:
    """The page of a cycle, or of a flywheel and its cycle, as HTML."""
    figures = REGULATION_FIGURES.pictures(Regulated(cycle, found))
    sections = [cycle_section(cycle, figures)]
    if found is not None:
        sections.insert(0, flywheel_section(found))
    scene = cycle.machine.scene
    facts = ["regulation", count(len(scene.links), "link")]
    facts += [count(len(scene.loads), "load")] * bool(scene.loads)
    facts.append(f"crankcheck {crankcheck_version()}")
    head = Head(f"crankcheck: {scene.name}", facts, made="", first=sections[0].anchor)
    return assembled(head, sections)
