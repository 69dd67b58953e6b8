"""The pages of regulation, put together with their figures."""

from __future__ import annotations

from analytic.lectures.regulation.flywheel import WantedFlywheel
from analytic.lectures.regulation.steady_cycle import SteadyCycle
from reports.figures.saving import saved
from reports.lectures.machine.figures.all_figures import drawn_figures
from reports.lectures.machine.figures.regulated import Regulated
from reports.lectures.machine.regulation_page import cycle_page, flywheel_page


def page_of_cycle(cycle: SteadyCycle) -> str:
    """The page of a cycle as HTML."""
    return cycle_page(cycle, _figures(Regulated(cycle)))


def page_of_flywheel(found: WantedFlywheel) -> str:
    """The page of a flywheel as HTML."""
    return flywheel_page(found, _figures(Regulated(found.cycle, found)))


def _figures(of: Regulated) -> dict[str, bytes]:
    title = of.cycle.machine.scene.name
    return {name: saved(figure, "svg", f"{title}: {name}") for name, figure in drawn_figures(of)}
