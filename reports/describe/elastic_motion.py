"""A motion with elastic links in columns and tables, beside the same with rigid ones."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from rich.table import Table

from analytic.elastic.elastic_motion import ElasticHistory, energies
from analytic.elastic.released import ReleasedElasticMotion
from models.array import Array
from models.cut_links import line_of
from models.motion import Motion
from models.scene import Scene
from reports.describe.elastic_course import SHARES, ElasticCourse
from reports.describe.frame import motion_frame
from reports.describe.tables import Columns, tables_over_time
from reports.output.columns import plain_table

if TYPE_CHECKING:
    import pandas as pd


def rigid_columns(rigid: Motion) -> dict[str, Array]:
    """What the same mechanism does with rigid links, by names with units."""
    columns = {f"{name}_theta_rigid_rad": link.theta for name, link in rigid.links.items()}
    columns |= {
        f"{name}_slider_displacement_rigid_m": slider.displacement
        for name, slider in rigid.sliders.items()
    }
    if rigid.forces is not None:
        columns["torque_rigid_n_m"] = rigid.forces.torque
    return columns


def energy_columns(motion: ElasticHistory, time_s: Array) -> dict[str, Array]:
    """What is let go has of energy and work, by names with units, at times (T,) in any order."""
    if not isinstance(motion, ReleasedElasticMotion):
        return {}
    order = np.argsort(time_s, kind="stable")
    energy, back = energies(motion, time_s[order]), np.argsort(order)
    columns = {"kinetic_j": energy.kinetic, "potential_j": energy.potential, "work_j": energy.work}
    return {name: series[back] for name, series in columns.items()}


def elastic_frame(course: ElasticCourse, *, with_forces: bool) -> pd.DataFrame:
    """One row per sample: the motion, and what rigid links would have."""
    motion, rigid = course.motion, course.rigid
    if not with_forces:
        motion, rigid = replace(motion, forces=None), replace(rigid, forces=None)
    return motion_frame(motion).assign(**rigid_columns(rigid))


def elastic_tables(course: ElasticCourse, width: int) -> list[Table]:
    """Over time: how elastic links are bent and stretched, and what links and sliders do with them
    and without."""
    bodies: list[tuple[str, Columns]] = []
    for name, shape in course.motion.elastic.items():
        bent = [("middle\nm", shape.middle)] * course.scene.elastic[name].bends
        bodies.append((name, [*bent, ("extension\nm", shape.extension)]))
    for each in course.apart():
        columns = [("elastic", each.elastic), ("rigid", each.rigid), ("apart", each.difference)]
        bodies.append((each.name, [(f"{head}\n{each.unit}", series) for head, series in columns]))
    if course.torques is not None:
        both = [(f"{h}\nN m", v) for h, v in zip(("elastic", "rigid"), course.torques, strict=True)]
        bodies.append(("torque", both))
    return tables_over_time(course.scene, course.motion, bodies, width)


@dataclass(frozen=True)
class Extreme:
    """The largest value of a motion, with its sign, in ``unit``; when [s], and the driver's angle
    there [deg]; ``note`` says what more is to be told of it."""

    name: str
    value: float
    unit: str
    at_s: float
    at_deg: float
    note: str = ""


def extremes(course: ElasticCourse) -> list[Extreme]:
    """The largest deflections, extensions, differences to rigid links, and torques."""
    return [_extreme(course, *each) for each in _series(course)]


def _series(course: ElasticCourse) -> Iterator[tuple[str, str, Array, str]]:
    for name, shape in course.motion.elastic.items():
        length_m, places = line_of(course.scene, name).length_m, course.bent[name]
        if course.scene.elastic[name].bends:
            middle = float(np.max(np.abs(shape.middle)))
            share = f"1/{length_m / middle:.4g} of its length" if middle > 0.0 else ""
            yield f"{name}, deflection of its middle", "m", shape.middle, share
            where = int(np.argmax(np.max(np.abs(places), axis=0)))
            yield (
                f"{name}, deflection where it is largest", "m", places[:, where],
                f"at {SHARES[where]:.3g} of its length",
            )  # fmt: skip
        yield f"{name}, extension", "m", shape.extension, ""
    for each in course.apart():
        yield f"{each.name}, elastic less rigid", each.unit, each.difference, ""
    if course.torques is not None:
        elastic, rigid = course.torques
        yield "driving torque, elastic", "N m", elastic, ""
        yield "driving torque, rigid", "N m", rigid, ""


def _extreme(course: ElasticCourse, name: str, unit: str, values: Array, note: str) -> Extreme:
    if not np.any(np.abs(values) > 0.0):  # all of them 0, or none determined
        value = 0.0 if np.isfinite(values).any() else math.nan
        return Extreme(name, value, unit, math.nan, math.nan, note)
    at = int(np.nanargmax(np.abs(values)))
    driver = course.motion.links[course.scene.driver.link].theta
    degrees = math.degrees(float(driver[at])) % 360.0
    return Extreme(name, float(values[at]) + 0.0, unit, float(course.time_s[at]), degrees, note)


def extremes_table(scene: Scene, rows: list[Extreme]) -> Table:
    """What `extremes` has."""
    table = plain_table(gap=2)
    table.add_column("largest", no_wrap=True)
    table.add_column("", justify="right", no_wrap=True)
    table.add_column("", no_wrap=True)
    table.add_column(f"{scene.driver.link} at", justify="right", no_wrap=True)
    table.add_column("", overflow="fold")
    for row in rows:
        value = "-" if math.isnan(row.value) else f"{row.value:.6g}"
        at = "-" if math.isnan(row.at_deg) else f"{row.at_deg:.4g} deg"
        table.add_row(row.name, value, row.unit, at, row.note)
    return table


def largest_deflections(course: ElasticCourse) -> dict[str, float]:
    """Over each elastic link and the motion [m]."""
    return {name: float(np.max(np.abs(each))) for name, each in course.bent.items()}
