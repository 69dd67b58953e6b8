"""The page of a steady cycle, and of a flywheel: one HTML file."""

from __future__ import annotations

from collections.abc import Mapping

from analytic.lectures.regulation.flywheel import WantedFlywheel
from analytic.lectures.regulation.steady_cycle import SteadyCycle
from reports.lectures.machine.sections import flywheel, numbers
from reports.output.numbers import count
from reports.output.provenance import crankcheck_version
from reports.page.build import Head, assembled


def cycle_page(cycle: SteadyCycle, figures: Mapping[str, bytes]) -> str:
    """The page of a cycle; ``figures`` are SVG files by name."""
    return assembled(_head(cycle, "cycle"), [numbers.build(cycle, figures)])


def flywheel_page(found: WantedFlywheel, figures: Mapping[str, bytes]) -> str:
    """The page of a flywheel, with its cycle."""
    sections = [flywheel.build(found), numbers.build(found.cycle, figures)]
    return assembled(_head(found.cycle, "flywheel"), sections)


def _head(cycle: SteadyCycle, first: str) -> Head:
    scene = cycle.machine.scene
    return Head(
        title=f"crankcheck: {scene.name}",
        facts=(
            "regulation",
            count(len(scene.links), "link"),
            *((count(len(scene.loads), "load"),) if scene.loads else ()),
            f"crankcheck {crankcheck_version()}",
        ),
        made="",
        first=first,
    )
