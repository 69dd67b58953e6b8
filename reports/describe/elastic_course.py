"""A scene with elastic links over time, beside one with rigid links, for words and drawings."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
from rich.table import Table

from analytic.elastic.elastic_motion import ElasticHistory, bent, energies, sampled
from analytic.elastic.released import ReleasedElasticMotion
from analytic.forces.kinetostatics import forces
from analytic.free.release import release
from analytic.kinematics import solve
from models.array import Array
from models.motion import Motion
from models.scene import Scene, cut_links
from models.scene.driver import Controlled
from models.scene.elastic import Shape
from reports.describe import elastic_words, free_motion
from reports.output.console import plain_table

SHARES = np.linspace(0.0, 1.0, 41)
"""Points of an elastic link at which its shape is computed, over its length; with the middle."""

ROUNDING = 1e-14
"""Rounding, over the largest of a series: its joints are closed to no less."""
LEAST, MOST, IN_A_PERIOD = 180, 7200, 360
"""Intervals of a closely sampled motion: at least and at most, and in a period of the driver."""


@dataclass(frozen=True)
class Apart:
    """A link's angle [rad] or a slider's displacement [m], with elastic links and with rigid ones,
    (T,) each."""

    name: str
    unit: str
    elastic: Array
    rigid: Array

    @property
    def difference(self) -> Array:
        """Elastic less rigid; 0 where it is mere rounding."""
        apart = self.elastic - self.rigid
        rounding = ROUNDING * float(np.max(np.abs(self.rigid), initial=0.0))
        return np.where(np.abs(apart) <= rounding, 0.0, apart)


@dataclass(frozen=True)
class ElasticCourse:
    """Both motions at the same instants, with their forces; ``bent`` is the distance of each
    elastic link from the line between its pins [m], (T, K), at `SHARES` of its length. ``words``
    name the description of the links, and their start. ``uncontrolled`` is the motion without the
    gains of a controller, where requested."""

    scene: Scene
    motion: Motion
    rigid: Motion
    bent: Mapping[str, Array]
    words: str
    uncontrolled: Motion | None = None

    @property
    def time_s(self) -> Array:
        """The instants [s], (T,)."""
        return self.motion.time_s

    @property
    def turns(self) -> float:
        """Periods of the driver from the start to the end."""
        return float(self.time_s[-1]) / self.scene.driver.law.period_s

    @property
    def base(self) -> Motion:
        """Base of drawn displacements: rigid links, where these are driven alike; in free motion
        they are soon elsewhere, and the motion itself is drawn with its links bent."""
        return self.motion if self.scene.is_free else self.rigid

    def apart(self) -> Iterator[Apart]:
        """Yield the effects of elastic links: on the angles of links, without a driver that follows
        a law, and on the displacements of sliders."""
        for name, link in self.motion.links.items():
            gives_way = self.scene.is_free or isinstance(self.scene.driver.law, Controlled)
            if name != self.scene.driver.link or gives_way:
                yield Apart(name, "rad", link.theta, self.rigid.links[name].theta)
        for name, slider in self.motion.sliders.items():
            rigid = self.rigid.sliders[name].displacement
            yield Apart(f"slider {name}", "m", slider.displacement, rigid)

    @property
    def torques(self) -> tuple[Array, Array] | None:
        """Torques of the drive with elastic and with rigid links [N m], (T,); None without a
        drive."""
        acting, rigid = self.motion.forces, self.rigid.forces
        return None if acting is None or rigid is None else (acting.torque, rigid.torque)


def closely_sampled(scene: Scene, until_s: float) -> Array:
    """Return instants from 0 to a time [s], inclusive, close enough for drawings and extremes."""
    count = IN_A_PERIOD * until_s / scene.driver.law.period_s
    return np.linspace(0.0, until_s, int(np.clip(round(count), LEAST, MOST)) + 1)


def elastic_course(motion: ElasticHistory, time_s: Array) -> ElasticCourse:
    """Return a motion at times [s], (T,) in ascending order. Raises CrankcheckError if none."""
    scene = motion.scene
    words = [elastic_words.described(scene, motion.by), f"start {start_of(motion)}"]
    words += ["shortening left out"] * (not motion.stiffened)
    own, rigid = sampled(motion, time_s), _with_rigid_links(motion, time_s)
    return ElasticCourse(scene, own, rigid, bent(motion, time_s, SHARES), ", ".join(words))


def drawn_course(motion: ElasticHistory, time_s: Array) -> ElasticCourse:
    """Return `elastic_course` for a drawing: also a controlled driver without its gains, under the
    torque for rigid links. Raises CrankcheckError as that."""
    course, driver = elastic_course(motion, time_s), motion.scene.driver
    if not isinstance(motion, ReleasedElasticMotion) or not isinstance(driver.law, Controlled):
        return course
    law = replace(driver.law, kp_n_m_rad=0.0, kd_n_m_s=0.0)
    without = replace(motion, scene=replace(motion.scene, driver=replace(driver, law=law)))
    return replace(course, uncontrolled=sampled(without, time_s))


def _with_rigid_links(motion: ElasticHistory, time_s: Array) -> Motion:
    """Return the same mechanism, driven or free alike, with its forces where it is driven."""
    scene = cut_links.with_rigid_links(motion.scene)
    if scene.is_free:
        return release(scene, motion.until_s).at(time_s, bound=False)
    acting = forces(scene, time_s, bound=False, skip_dead_points=True)
    return replace(solve(scene, time_s, bound=False), forces=acting)


def start_of(motion: ElasticHistory) -> Shape:
    """Return the shape at time 0."""
    if isinstance(motion, ReleasedElasticMotion):
        return motion.scene.start.shape or "quasi-static"
    return motion.start


def rigid_columns(rigid: Motion) -> dict[str, Array]:
    """Return the motion of the same mechanism with rigid links, by names with units."""
    columns = {f"{name}_theta_rigid_rad": link.theta for name, link in rigid.links.items()}
    columns |= {
        f"{name}_slider_displacement_rigid_m": slider.displacement
        for name, slider in rigid.sliders.items()
    }
    if rigid.forces is not None:
        columns["torque_rigid_n_m"] = rigid.forces.torque
    return columns


def energy_columns(motion: ElasticHistory, time_s: Array) -> dict[str, Array]:
    """Return energy and work of free motion, by names with units, at times (T,) in any order."""
    if not isinstance(motion, ReleasedElasticMotion):
        return {}
    order = np.argsort(time_s, kind="stable")
    energy, back = energies(motion, time_s[order]), np.argsort(order)
    columns = {"kinetic_j": energy.kinetic, "potential_j": energy.potential, "work_j": energy.work}
    return {name: series[back] for name, series in columns.items()}


def elastic_tables(course: ElasticCourse, width: int) -> list[Table]:
    """Return tables over time: bending and extension of elastic links, and the motion of links and
    sliders with and without them."""
    bodies: list[tuple[str, free_motion.Columns]] = []
    for name, shape in course.motion.elastic.items():
        bent = [("middle\nm", shape.middle)] * course.scene.elastic[name].bends
        bodies.append((name, [*bent, ("extension\nm", shape.extension)]))
    for each in course.apart():
        columns = [("elastic", each.elastic), ("rigid", each.rigid), ("apart", each.difference)]
        bodies.append((each.name, [(f"{head}\n{each.unit}", series) for head, series in columns]))
    if course.torques is not None:
        both = [(f"{h}\nN m", v) for h, v in zip(("elastic", "rigid"), course.torques, strict=True)]
        bodies.append(("torque", both))
    return free_motion.tables_over_time(course.scene, course.motion, bodies, width)


@dataclass(frozen=True)
class DeflectionExtreme:
    """The largest value of a motion, with its sign, in ``unit``; when [s], and the driver's angle
    there [deg]; ``note`` adds a remark."""

    name: str
    value: float
    unit: str
    at_s: float
    at_deg: float
    note: str = ""


def extremes(course: ElasticCourse) -> list[DeflectionExtreme]:
    """Return the largest deflections, extensions, differences to rigid links, and torques."""
    return [_extreme(course, *each) for each in _series(course)]


def _series(course: ElasticCourse) -> Iterator[tuple[str, str, Array, str]]:
    for name, shape in course.motion.elastic.items():
        length_m, places = cut_links.line_of(course.scene, name).length_m, course.bent[name]
        link = course.scene.elastic[name]
        if link.bends:
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


def _extreme(
    course: ElasticCourse, name: str, unit: str, values: Array, note: str
) -> DeflectionExtreme:
    if not np.any(np.abs(values) > 0.0):  # all of them 0, or none determined
        value = 0.0 if np.isfinite(values).any() else math.nan
        return DeflectionExtreme(name, value, unit, math.nan, math.nan, note)
    at = int(np.nanargmax(np.abs(values)))
    driver = course.motion.links[course.scene.driver.link].theta
    degrees = math.degrees(float(driver[at])) % 360.0
    return DeflectionExtreme(
        name, float(values[at]) + 0.0, unit, float(course.time_s[at]), degrees, note
    )


def extremes_table(scene: Scene, rows: list[DeflectionExtreme]) -> Table:
    """Return a table of `extremes`."""
    table = plain_table(gap=2)
    for name, number in (("largest", ""), ("", f"{scene.driver.link} at")):
        table.add_column(name, no_wrap=True)
        table.add_column(number, justify="right", no_wrap=True)
    table.add_column("", overflow="fold")
    for row in rows:
        value = "-" if math.isnan(row.value) else f"{row.value:.6g}"
        at = "-" if math.isnan(row.at_deg) else f"{row.at_deg:.4g} deg"
        table.add_row(row.name, value, row.unit, at, row.note)
    return table


def largest_deflections(course: ElasticCourse) -> dict[str, float]:
    """Return the largest deflection over each elastic link and the motion [m]."""
    return {name: float(np.max(np.abs(each))) for name, each in course.bent.items()}
