"""What is told of a flywheel: the ways to work it out beside each other, and speeds with it and
without."""

from __future__ import annotations

import math
from dataclasses import dataclass

from analytic.lectures.regulation.flywheel import WantedFlywheel
from reports.lectures.machine.cycle_rows import number_rows


@dataclass(frozen=True)
class WayRow:
    """A way to the flywheel: its ``key`` in files, its name with where it comes from, the moment of
    inertia [kg m^2], and by what share it is off the exact one."""

    key: str
    name: str
    inertia_kg_m2: float
    off: float


@dataclass(frozen=True)
class BesideRow:
    """A number without the flywheel and with it; NaN where there is none."""

    name: str
    without: float
    with_it: float
    unit: str


def way_rows(found: WantedFlywheel) -> list[WayRow]:
    """The exact flywheel first."""
    exact, near = found.inertia_kg_m2, found.approximations
    ways = {
        "exact": ("exact, of the full equation", exact),
        "by_tangents": ("tangents, w^2 (1 +- delta) / 2 (Wittenbauer)", near.by_tangents),
        "by_own_energy": ("own energy at mean speed (Mertsalov)", near.by_own_energy),
        "by_surplus": ("surplus of work / (delta w^2) (textbooks)", near.by_surplus),
    }
    return [WayRow(key, name, value, value / exact - 1.0) for key, (name, value) in ways.items()]


def beside_rows(found: WantedFlywheel) -> list[BesideRow]:
    """The cycle without the flywheel and with it."""
    bare = {} if found.bare is None else {row.key: row for row in number_rows(found.bare)}
    rows = []
    for row in number_rows(found.cycle):
        other = bare.get(row.key)
        without = math.nan if other is None else other.value
        rows.append(BesideRow(row.name, without, row.value, row.unit))
        if not math.isnan(row.at_deg):
            before = math.nan if other is None else other.at_deg
            rows.append(BesideRow(f"{row.name}, driver at", before, row.at_deg, "deg"))
    return rows


def heading(found: WantedFlywheel) -> str:
    """What the flywheel is for."""
    scene = found.cycle.machine.scene
    return (
        f"{scene.name}: a flywheel of {found.inertia_kg_m2:.6g} kg m^2 on {scene.driver.link} "
        f"makes it run with a coefficient of fluctuation of {found.delta:g}"
    )


def notes(found: WantedFlywheel) -> list[str]:
    """What is special."""
    steep, flat = found.slopes
    told = [
        f"Tangents of the energy-mass diagram: tan psi_max = {steep:.6g}, tan psi_min = "
        f"{flat:.6g} J/(kg m^2), half the squares of the extreme speeds."
    ]
    if found.bare is None:
        told.append("Without it there is no steady cycle at this speed: the machine stops.")
    return told
