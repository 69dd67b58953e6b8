"""Words on a steady cycle: its numbers with their units, works by their sources, notes."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING

import numpy as np
from rich.console import Console

from analytic.lectures.regulation.flywheel import WantedFlywheel
from analytic.lectures.regulation.steady_cycle import SteadyCycle
from models.array import Array
from models.scene import Scene
from reports.output.console import grid, say, say_each
from reports.output.formats import json_text
from reports.output.numbers import NONE, error_text, readable
from reports.output.write import crankcheck_version

if TYPE_CHECKING:
    import pandas as pd


EVEN = 1e-9
"""Fluctuation below which the extremes have no place."""


@dataclass(frozen=True)
class NumberRow:
    """A number of a cycle by its ``key`` in files and its name, with the driver's angle at it
    [deg], NaN for a number of the whole cycle."""

    key: str
    name: str
    value: float
    unit: str
    at_deg: float = math.nan


@dataclass(frozen=True)
class WorkRow:
    """The work of a source in a cycle [J], and its mean torque on the driver, positive if it drives
    [N m]."""

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
    """The works of a cycle, the strongest drive first."""
    angle = cycle.machine.cycle_rad
    return [
        WorkRow(name, work, work / angle)
        for name, work in sorted(cycle.works_j.items(), key=lambda each: -each[1])
    ]


def heading(cycle: SteadyCycle) -> str:
    """The heading: scene, driver, and length of the cycle."""
    machine = cycle.machine
    turns = machine.cycle_rad / math.tau
    words = {1: "one turn", 2: "two turns"}.get(round(turns), f"{turns:g} turns")
    side = "" if machine.way > 0.0 else ", clockwise"
    return f"{machine.scene.name}: steady cycle of {machine.scene.driver.link}, {words}{side}"


def notes(cycle: SteadyCycle) -> list[str]:
    """Notes on the meaning of the numbers."""
    told = [
        "Coefficient of fluctuation: (largest - smallest speed) / mean, the mean being half their "
        "sum. Torques count along the motion: positive ones drive."
    ]
    scene = cycle.machine.scene
    if not scene.is_free:
        does = "gives" if cycle.drive_n_m > 0.0 else "takes"
        size = readable(abs(cycle.drive_n_m), 6)
        closing = f"; here it {does} {size} N m" if cycle.drive_n_m else ""
        told.append(
            "The driver's law gives the mean speed, kept by a constant torque of the drive "
            f"that closes the balance of work{closing}."
        )
    elif cycle.machine.is_rated:
        told.append(
            "Free motion: the loads alone settle the speed. A change of the energy decays to "
            f"{readable(cycle.settling)} of itself in a cycle."
        )
    else:
        told.append(
            "Free motion under loads that balance at any speed: the speed of the start is taken as "
            "the mean."
        )
    return told


@dataclass(frozen=True)
class WayRow:
    """A method for the flywheel: its ``key`` in files, its name with its source, the moment of
    inertia [kg m^2], and its deviation from the exact one, as a share."""

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
    """The methods for the flywheel, the exact one first."""
    exact, near = found.inertia_kg_m2, found.approximations
    ways = {
        "exact": ("exact, of the full equation", exact),
        "by_tangents": ("tangents, w^2 (1 +- delta) / 2 (Wittenbauer)", near.by_tangents),
        "by_own_energy": ("own energy at mean speed (Mertsalov)", near.by_own_energy),
        "by_surplus": ("surplus of work / (delta w^2) (textbooks)", near.by_surplus),
    }
    return [WayRow(key, name, value, value / exact - 1.0) for key, (name, value) in ways.items()]


def beside_rows(found: WantedFlywheel) -> list[BesideRow]:
    """The numbers of the cycle without the flywheel and with it."""
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
    """The heading: the flywheel and its purpose."""
    scene = found.cycle.machine.scene
    return (
        f"{scene.name}: a flywheel of {found.inertia_kg_m2:.6g} kg m^2 on {scene.driver.link} "
        f"makes it run with a coefficient of fluctuation of {found.delta:g}"
    )


def flywheel_notes(found: WantedFlywheel) -> list[str]:
    """Notes on the tangents, and on a machine that stops without the flywheel."""
    steep, flat = found.slopes
    told = [
        f"Tangents of the energy-mass diagram: tan psi_max = {steep:.6g}, tan psi_min = "
        f"{flat:.6g} J/(kg m^2), half the squares of the extreme speeds."
    ]
    if found.bare is None:
        told.append("Without it there is no steady cycle at this speed: the machine stops.")
    return told


@dataclass(frozen=True)
class CycleSeries:
    """A cycle at angles ``turned`` since its start [rad], (T,): the driver's angle, time, speed
    along the motion, the reduced moment of inertia, work since the start, energy of motion.

    ``driving`` is the torque of all sources that do work in a cycle, ``resisting`` of those that
    take it, ``returning`` of those that return it (weights, springs); ``sources`` are all of them
    one by one [N m].
    """

    turned: Array
    theta: Array
    time_s: Array
    speed: Array
    inertia: Array
    work: Array
    energy: Array
    driving: Array
    resisting: Array
    returning: Array
    sources: Mapping[str, Array]


def cycle_series(cycle: SteadyCycle) -> CycleSeries:
    """The series of a cycle, each half degree of the driver."""
    u, machine = cycle.fine, cycle.machine
    energy, inertia = cycle.energy(u), cycle.solution.inertia_at(u)
    speed = np.sqrt(2.0 * energy / inertia)
    sources = machine.torques_by_source(u, speed)
    if cycle.drive_n_m:
        sources["drive"] = np.full_like(u, cycle.drive_n_m)
    works = cycle.works_j
    groups = {
        "driving": [n for n in sources if works[n] > 0.0],
        "resisting": [n for n in sources if works[n] < 0.0],
        "returning": [n for n in sources if works[n] == 0.0],
    }
    sums = {
        group: sum((sources[n] for n in names), np.zeros_like(u)) for group, names in groups.items()
    }
    return CycleSeries(
        u, machine.theta(u), cycle.time_s(u), speed, inertia, energy - energy[0], energy,
        sums["driving"], sums["resisting"], sums["returning"], sources,
    )  # fmt: skip


def cycle_frame(cycle: SteadyCycle, bare: SteadyCycle | None = None) -> pd.DataFrame:
    """Table of samples, a row each; with the speed without a flywheel, if that cycle is given."""
    import pandas as pd

    series, link = cycle_series(cycle), cycle.machine.scene.driver.link
    columns = {
        "turned_rad": series.turned,
        f"{link}_theta_rad": series.theta,
        "time_s": series.time_s,
        f"{link}_omega_rad_s": cycle.machine.way * series.speed,
        "inertia_kg_m2": series.inertia,
        "work_j": series.work,
        "energy_j": series.energy,
        "driving_n_m": series.driving,
        "resisting_n_m": series.resisting,
        "returning_n_m": series.returning,
    }
    columns |= {f"{name}_n_m": torque for name, torque in series.sources.items()}
    if bare is not None:
        columns[f"bare_{link}_omega_rad_s"] = bare.machine.way * bare.solution.speed_at(
            series.turned
        )
    return pd.DataFrame(columns)


def cycle_document(cycle: SteadyCycle) -> str:
    """The numbers of a cycle as JSON."""
    return numbers_text(cycle.machine.scene, cycle=_numbers(cycle))


def flywheel_document(found: WantedFlywheel) -> str:
    """The numbers of a flywheel as JSON."""
    steep, flat = found.slopes
    return numbers_text(
        found.cycle.machine.scene,
        delta=found.delta,
        flywheel_kg_m2={row.key: row.inertia_kg_m2 for row in way_rows(found)},
        tan_psi_max_j_per_kg_m2=steep,
        tan_psi_min_j_per_kg_m2=flat,
        cycle=_numbers(found.cycle),
        without=None if found.bare is None else _numbers(found.bare),
    )


def numbers_text(scene: Scene, **numbers: object) -> str:
    """Numbers as JSON, with their origin: the scene, its source, and the version."""
    origin = {"scene": scene.name, "source": scene.source, "crankcheck": crankcheck_version()}
    return json_text(origin | numbers)


def _numbers(cycle: SteadyCycle) -> dict[str, object]:
    numbers: dict[str, object] = {"cycle_rad": cycle.machine.cycle_rad}
    for row in number_rows(cycle):
        numbers[row.key] = row.value
        if row.at_deg == row.at_deg:
            numbers[f"{row.key.removesuffix('_rad_s')}_at_deg"] = row.at_deg
    return numbers | {"settling": cycle.settling, "works": [asdict(r) for r in work_rows(cycle)]}


def show_cycle(console: Console, cycle: SteadyCycle) -> None:
    """Print a cycle."""
    say(console, f"{heading(cycle)}\n")
    _show(console, ("", "value", "", f"{cycle.machine.scene.driver.link} at"), (
        (row.name, _digits(row.value), row.unit,
         "" if math.isnan(row.at_deg) else f"{row.at_deg:.4f} deg")
        for row in number_rows(cycle)
    ))  # fmt: skip
    _show(console, ("work of a cycle by", "work J", "", "mean torque N m"), (
        (work.name, _digits(work.work_j), "", _digits(work.mean_n_m)) for work in work_rows(cycle)
    ))  # fmt: skip
    say_each(console, notes(cycle))


def show_flywheel(console: Console, found: WantedFlywheel) -> None:
    """Print a flywheel."""
    say(console, f"{flywheel_heading(found)}\n")
    _show(console, ("flywheel", "kg m^2", "", "off the exact one"), (
        (row.name, _digits(row.inertia_kg_m2), "",
         "" if row.key == "exact" else f"{'+' * (row.off > 0.0)}{error_text(row.off)}")
        for row in way_rows(found)
    ))  # fmt: skip
    _show(console, ("cycle", "without", "with it", ""), (
        (each.name, _digits(each.without), _digits(each.with_it), each.unit)
        for each in beside_rows(found)
    ))  # fmt: skip
    say_each(console, flywheel_notes(found))


def _show(console: Console, heads: Sequence[str], rows: Iterable[Sequence[str]]) -> None:
    """Print a table of names, then numbers; a column without a head has units."""
    first, *others = heads
    console.print(grid((first, *(head and f"{head}:" for head in others)), rows, whole=heads), "")


def _digits(value: float) -> str:
    return NONE if math.isnan(value) else f"{value + 0.0:.7g}"
