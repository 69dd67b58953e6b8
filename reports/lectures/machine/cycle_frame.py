"""A steady cycle as a table over the driver's angle, and as JSON, with all digits."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING

import numpy as np
from rich.console import Console
from rich.table import Table

from analytic.lectures.regulation.flywheel import WantedFlywheel
from analytic.lectures.regulation.steady_cycle import SteadyCycle
from models.array import Array
from reports.lectures.machine import cycle_rows
from reports.lectures.machine.cycle_rows import number_rows, way_rows, work_rows
from reports.output.console import plain_table
from reports.output.numbers import NONE, error_text, finite
from reports.output.provenance import crankcheck_version

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True)
class CycleSeries:
    """A cycle at angles ``turned`` since its start [rad], (T,): the driver's angle, time, speed
    along the motion, the reduced moment of inertia, work since the start, energy of motion.

    ``driving`` is the torque of all that does work in a cycle, ``resisting`` that of all that
    takes it, ``returning`` that of what gives back what it takes (weights, springs); ``sources``
    are all of them one by one [N m].
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
    """One row per sample; with the speed without a flywheel, where that is another cycle."""
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
    return _text({**_origin(cycle), "cycle": _numbers(cycle)})


def flywheel_document(found: WantedFlywheel) -> str:
    """The numbers of a flywheel as JSON."""
    steep, flat = found.slopes
    return _text(
        {
            **_origin(found.cycle),
            "delta": found.delta,
            "flywheel_kg_m2": {row.key: row.inertia_kg_m2 for row in way_rows(found)},
            "tan_psi_max_j_per_kg_m2": steep,
            "tan_psi_min_j_per_kg_m2": flat,
            "cycle": _numbers(found.cycle),
            "without": None if found.bare is None else _numbers(found.bare),
        }
    )


def _origin(cycle: SteadyCycle) -> dict[str, object]:
    scene = cycle.machine.scene
    return {"scene": scene.name, "source": scene.source, "crankcheck": crankcheck_version()}


def _numbers(cycle: SteadyCycle) -> dict[str, object]:
    """All numbers of a cycle."""
    numbers: dict[str, object] = {"cycle_rad": cycle.machine.cycle_rad}
    for row in number_rows(cycle):
        numbers[row.key] = row.value
        if row.at_deg == row.at_deg:
            numbers[f"{row.key.removesuffix('_rad_s')}_at_deg"] = row.at_deg
    return numbers | {"settling": cycle.settling, "works": [asdict(r) for r in work_rows(cycle)]}


def _text(content: Mapping[str, object]) -> str:
    return json.dumps(finite(content), indent=1) + "\n"


def show_cycle(console: Console, cycle: SteadyCycle) -> None:
    """Print a cycle."""
    console.print(cycle_rows.heading(cycle), "", highlight=False, markup=False, sep="\n")
    table = _table(("", "value", "", f"{cycle.machine.scene.driver.link} at"))
    for row in cycle_rows.number_rows(cycle):
        at = "" if math.isnan(row.at_deg) else f"{row.at_deg:.4f} deg"
        table.add_row(row.name, _digits(row.value), row.unit, at)
    console.print(table, "")
    works = _table(("work of a cycle by", "work J", "", "mean torque N m"))
    for work in cycle_rows.work_rows(cycle):
        works.add_row(work.name, _digits(work.work_j), "", _digits(work.mean_n_m))
    console.print(works, "")
    _notes(console, cycle_rows.notes(cycle))


def show_flywheel(console: Console, found: WantedFlywheel) -> None:
    """Print a flywheel."""
    console.print(cycle_rows.flywheel_heading(found), "", highlight=False, markup=False, sep="\n")
    ways = _table(("flywheel", "kg m^2", "", "off the exact one"))
    for row in cycle_rows.way_rows(found):
        off = "" if row.key == "exact" else f"{'+' * (row.off > 0.0)}{error_text(row.off)}"
        ways.add_row(row.name, _digits(row.inertia_kg_m2), "", off)
    console.print(ways, "")
    beside = _table(("cycle", "without", "with it", ""))
    for each in cycle_rows.beside_rows(found):
        beside.add_row(each.name, _digits(each.without), _digits(each.with_it), each.unit)
    console.print(beside, "")
    _notes(console, cycle_rows.flywheel_notes(found))


def _table(heads: tuple[str, str, str, str]) -> Table:
    """Names, then numbers; a column without a head has units."""
    table = plain_table(gap=2)
    for k, head in enumerate(heads):
        table.add_column(head, justify="right" if head and k else "left", no_wrap=True)
    return table


def _digits(value: float) -> str:
    """Seven significant digits; a dash where there is none."""
    return NONE if math.isnan(value) else f"{value + 0.0:.7g}"


def _notes(console: Console, told: list[str]) -> None:
    for note in told:
        console.print(note, style="dim", highlight=False, markup=False)
