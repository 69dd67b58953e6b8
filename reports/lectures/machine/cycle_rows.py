"""What is told of a steady cycle: its numbers with their units, works by what does them, notes."""

from __future__ import annotations

import math
from dataclasses import dataclass

from analytic.lectures.regulation.flywheel import WantedFlywheel
from analytic.lectures.regulation.steady_cycle import SteadyCycle
from reports.output.numbers import readable

EVEN = 1e-9
"""A fluctuation below this has no place."""


@dataclass(frozen=True)
class NumberRow:
    """A number of a cycle by its ``key`` in files and its name, with where the driver stands then
    [deg], NaN where it is of the whole cycle."""

    key: str
    name: str
    value: float
    unit: str
    at_deg: float = math.nan


@dataclass(frozen=True)
class WorkRow:
    """The work that something does in a cycle [J], and its mean torque on the driver, along the
    motion [N m]."""

    name: str
    work_j: float
    mean_n_m: float


def number_rows(cycle: SteadyCycle) -> list[NumberRow]:
    """The numbers of a cycle."""
    high, low = cycle.extreme_speeds_rad_s
    least, most = cycle.inertia_range
    at_high, at_low = (
        math.degrees(cycle.driver_rad(u)) if cycle.delta > EVEN else math.nan
        for u in (cycle.fastest, cycle.slowest)
    )
    rows = [
        NumberRow("mean_rad_s", "mean speed", cycle.mean_rad_s, "rad/s"),
        NumberRow("largest_rad_s", "largest speed", high, "rad/s", at_high),
        NumberRow("smallest_rad_s", "smallest speed", low, "rad/s", at_low),
        NumberRow("delta", "coefficient of fluctuation", cycle.delta, ""),
        NumberRow("time_mean_rad_s", "angle over time", cycle.time_mean_rad_s, "rad/s"),
        NumberRow("period_s", "time of a cycle", cycle.period_s, "s"),
        NumberRow("surplus_j", "surplus of work", cycle.surplus_j, "J"),
        NumberRow("least_inertia_kg_m2", "reduced inertia, least", least, "kg m^2"),
        NumberRow("most_inertia_kg_m2", "reduced inertia, most", most, "kg m^2"),
        NumberRow("power_w", "mean power that drives", cycle.power_w, "W"),
    ]
    if not cycle.machine.scene.is_free:
        rows.append(NumberRow("drive_n_m", "torque of the drive", cycle.drive_n_m, "N m"))
    return rows


def work_rows(cycle: SteadyCycle) -> list[WorkRow]:
    """The works of a cycle, what drives most first."""
    angle = cycle.machine.cycle_rad
    return [
        WorkRow(name, work, work / angle)
        for name, work in sorted(cycle.works_j.items(), key=lambda each: -each[1])
    ]


def heading(cycle: SteadyCycle) -> str:
    """What the cycle is one of."""
    machine = cycle.machine
    turns = machine.cycle_rad / math.tau
    words = {1: "one turn", 2: "two turns"}.get(round(turns), f"{turns:g} turns")
    side = "" if machine.way > 0.0 else ", clockwise"
    return f"{machine.scene.name}: steady cycle of {machine.scene.driver.link}, {words}{side}"


def notes(cycle: SteadyCycle) -> list[str]:
    """How the numbers are meant."""
    told = [
        "Coefficient of fluctuation: (largest - smallest speed) / mean, the mean being half their "
        "sum. Torques count along the motion: what is positive drives."
    ]
    scene = cycle.machine.scene
    if not scene.is_free:
        does = "gives" if cycle.drive_n_m > 0.0 else "takes"
        size = readable(abs(cycle.drive_n_m), 6)
        closing = f"; here it {does} {size} N m" if cycle.drive_n_m else ""
        told.append(
            "The driver's law is taken as the mean speed, kept by a constant torque of the drive "
            f"that closes the balance of work{closing}."
        )
    elif cycle.machine.is_rated:
        told.append(
            "Let go: the loads alone settle the speed. A change of the energy falls to "
            f"{readable(cycle.settling)} of itself in a cycle."
        )
    else:
        told.append(
            "Let go under loads that balance at any speed: that of its start is taken as the mean."
        )
    return told


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


def flywheel_heading(found: WantedFlywheel) -> str:
    """What the flywheel is for."""
    scene = found.cycle.machine.scene
    return (
        f"{scene.name}: a flywheel of {found.inertia_kg_m2:.6g} kg m^2 on {scene.driver.link} "
        f"makes it run with a coefficient of fluctuation of {found.delta:g}"
    )


def flywheel_notes(found: WantedFlywheel) -> list[str]:
    """What is special."""
    steep, flat = found.slopes
    told = [
        f"Tangents of the energy-mass diagram: tan psi_max = {steep:.6g}, tan psi_min = "
        f"{flat:.6g} J/(kg m^2), half the squares of the extreme speeds."
    ]
    if found.bare is None:
        told.append("Without it there is no steady cycle at this speed: the machine stops.")
    return told
