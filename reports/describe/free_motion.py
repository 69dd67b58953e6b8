"""A motion as tables on the terminal and as a pandas frame; a free motion also in words."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from rich.table import Table

from analytic.free.free_motion import FreeMotion
from analytic.mechanism.cycle import coriolis
from models.array import Array
from models.motion import Forces, Motion, each_array
from models.scene import Scene
from models.scene.driver import driver_place
from reports.describe.facts import SpeedFacts
from reports.output.console import plain_table
from reports.output.numbers import count, error_text
from sim.engine import Run

if TYPE_CHECKING:
    import pandas as pd


WIDE = 100
Columns = list[tuple[str, Array]]


def digits(value: float) -> str:
    """Return eight significant digits, with zeros at the end; a dash for undetermined values."""
    return "-" if math.isnan(value) else f"{value + 0.0:#.8g}"


def position_tables(scene: Scene, motion: Motion) -> list[Table]:
    """Return tables of the links, points and sliders in the motion, at one position; with the
    Coriolis component on a moving guide, where there is any."""
    links = head_table("link", ("theta deg", "theta rad", "omega rad/s", "alpha rad/s^2"))
    for name, link in motion.links.items():
        theta = link.theta[0]
        add_numbers(links, name, math.degrees(theta), theta, link.omega[0], link.alpha[0])
    places = head_table("point", ("x m", "y m", "vx m/s", "vy m/s", "v m/s"))
    rates = head_table("point", ("ax m/s^2", "ay m/s^2", "a m/s^2"))
    for name, point in motion.points.items():
        v, a = point.velocity[0], point.acceleration[0]
        add_numbers(places, name, *point.position[0], *v, np.hypot(*v))
        add_numbers(rates, name, *a, np.hypot(*a))
    whole = motion.sliders.keys() == scene.sliders.keys() and motion.links
    turned = coriolis(scene, motion) if motion.sliders and whole else {}
    heads = ("displacement m", "speed m/s", "acceleration m/s^2")
    sliders = head_table("slider", (*heads, *["Coriolis m/s^2"] * bool(turned)))
    for name, slider in motion.sliders.items():
        row = [slider.displacement[0], slider.speed[0], slider.acceleration[0]]
        row += [turned[name][0] if name in turned else 0.0] * bool(turned)
        add_numbers(sliders, name, *row)
    return [table for table in (links, places, rates, sliders) if table.row_count]


def speed_table(speeds: SpeedFacts) -> Table:
    """Return extreme speeds, a row for each output; long rows are folded within their column."""
    table = plain_table()
    table.add_column(no_wrap=True)
    table.add_column(speeds.title, overflow="fold")
    for name, words in speeds.rows.items():
        table.add_row(name, words)
    return table


def certainty(motion: Motion) -> str:
    """Return the uncertainty of the reference, in a line."""
    if motion.bound is None or not motion.bound.links:
        return ""
    links = motion.bound.links.values()
    theta = max(float(np.max(link.theta)) for link in links)
    omega = max(float(np.max(link.omega)) for link in links)
    alpha = max(float(np.max(link.alpha)) for link in links)
    return (
        f"Certain to {theta:.1e} rad, {omega:.1e} rad/s, {alpha:.1e} rad/s^2 "
        "(rounding, over the conditioning of the dyads)."
    )


def motion_tables(scene: Scene, motion: Motion, width: int) -> list[Table]:
    """Return links and sliders over time, as many bodies to a table as the terminal can hold."""
    bodies: list[tuple[str, Columns]] = [
        (name, [("theta\nrad", m.theta), ("omega\nrad/s", m.omega), ("alpha\nrad/s^2", m.alpha)])
        for name, m in motion.links.items()
        if name != scene.driver.link or not scene.driver.is_crank
    ]
    for name, s in motion.sliders.items():
        rates = [("speed\nm/s", s.speed), ("accel.\nm/s^2", s.acceleration)]
        bodies.append((f"slider {name}", [("place\nm", s.displacement), *rates]))
    return tables_over_time(scene, motion, bodies, width)


def tables_over_time(
    scene: Scene, motion: Motion, bodies: Sequence[tuple[str, Columns]], width: int
) -> list[Table]:
    """Return series by owner beside time and driver's angle; ``width`` is the terminal's."""
    together = 2 if width >= WIDE else 1
    place, driver = driver_place(scene, motion), scene.driver
    instants: Columns = [("\ntime\ns", motion.time_s)]
    if place is not None and driver.is_crank:
        instants.append((f"{driver.link}\ntheta\ndeg", np.degrees(place)))
    elif place is not None and driver.slider is None:
        instants.append((f"pin {driver.pin}\nangle\ndeg", np.degrees(place)))
    tables = []
    for first in range(0, len(bodies), together):
        table = plain_table(gap=2)
        columns = [*instants]
        for name, series in bodies[first : first + together]:
            owners = (name, *[""] * (len(series) - 1))
            columns += [(f"{o}\n{head}", v) for o, (head, v) in zip(owners, series, strict=True)]
        for title, _ in columns:
            table.add_column(title, justify="right", no_wrap=True)
        for index in range(motion.time_s.size):
            numbers = (float(series[index]) for _, series in columns)
            table.add_row(*("-" if math.isnan(x) else f"{x:.7g}" for x in numbers))
        tables.append(table)
    return tables


def head_table(head: str, columns: Sequence[str]) -> Table:
    """Return a table with a first column of names; each other head is a word and its unit."""
    table = plain_table()
    table.add_column(head, no_wrap=True)
    for column in columns:
        table.add_column(column.replace(" ", "\n", 1), justify="right", no_wrap=True)
    return table


def add_numbers(table: Table, name: str, *row: str | float) -> None:
    """Add a row of numbers, or words, to a table."""
    table.add_row(name, *(each if isinstance(each, str) else digits(float(each)) for each in row))


def motion_frame(motion: Motion, *, lengths: bool = True) -> pd.DataFrame:
    """Return one row per sample: each link, point and slider with its rates, vectors also by
    length; middle deflection and extension of elastic links; and the forces, where there are any
    (`reports.describe.free_motion`)."""
    import pandas as pd

    columns: dict[str, object] = {"time_s": motion.time_s}
    for name, link in motion.links.items():
        columns[f"{name}_theta_rad"] = link.theta
        columns[f"{name}_omega_rad_s"] = link.omega
        columns[f"{name}_alpha_rad_s2"] = link.alpha
    for name, point in motion.points.items():
        for symbol, vectors, unit in (
            ("", point.position, "m"),
            ("v", point.velocity, "m_s"),
            ("a", point.acceleration, "m_s2"),
        ):
            columns[f"{name}_{symbol}x_{unit}"] = vectors[:, 0]
            columns[f"{name}_{symbol}y_{unit}"] = vectors[:, 1]
            if symbol and lengths:
                columns[f"{name}_{symbol}_{unit}"] = np.hypot(vectors[:, 0], vectors[:, 1])
    for name, slider in motion.sliders.items():
        columns[f"{name}_slider_displacement_m"] = slider.displacement
        columns[f"{name}_slider_speed_m_s"] = slider.speed
        columns[f"{name}_slider_acceleration_m_s2"] = slider.acceleration
    for name, shape in motion.elastic.items():
        columns[f"{name}_deflection_m"] = shape.middle
        columns[f"{name}_extension_m"] = shape.extension
    if motion.forces is not None:
        columns |= force_columns(motion.forces, lengths=lengths)
    return pd.DataFrame(columns)


def run_frame(run: Run) -> pd.DataFrame:
    """Return the log of a run, one row per sample, no rows where it logged nothing.

    As `motion_frame`, but without lengths of vectors, and with the opening of each pin and slider.
    The instants of velocities and accelerations are beside those of the positions where they
    differ. Series that the engine does not report are left out.
    """
    if run.motion is None:
        import pandas as pd

        return pd.DataFrame({"time_s": np.zeros(0)})
    frame = motion_frame(run.motion, lengths=False)
    for name, gap_m in run.gaps.items():
        frame[f"{name}_gap_m"] = gap_m
    frame = frame.dropna(axis="columns", how="all")
    instants = {"velocity_time_s": run.velocity_time_s}
    if run.reports_accelerations:
        instants["acceleration_time_s"] = run.acceleration_time_s
    if run.motion.forces is not None:
        instants["force_time_s"] = run.motion.forces.time_s
    others = {
        name: time_s
        for name, time_s in instants.items()
        if time_s is not None and np.any(time_s != run.motion.time_s)
    }
    for place, (name, time_s) in enumerate(others.items(), 1):
        frame.insert(place, name, time_s)
    return frame


def cleaned(motion: Motion) -> Motion:
    """Return the motion for readers: numbers that are 0 within their own bound are 0, and those
    with an infinite bound NaN."""
    bound = motion.bound
    if bound is None:
        return motion

    def clean(values: Array, limit: Array) -> Array:
        """Clean a series (T,) or (T, 2) by its bound (T,)."""
        shown = np.where(np.abs(values.T) <= limit, 0.0, values.T)
        return np.where(np.isfinite(limit), shown, np.nan).T

    return replace(
        motion,
        links=each_array(clean, motion.links, bound.links),
        points=each_array(clean, motion.points, bound.points),
        sliders=each_array(clean, motion.sliders, bound.sliders),
    )


def acted_on(acting: Forces) -> Iterator[tuple[str, str, str, Array]]:
    """Yield each pin, the body under the force, its source, and that force [N], (T, 2).

    Where two bodies meet, it is the force on the second, from the first; of more, that on each,
    from the pin.
    """
    for point, bodies in acting.pins.items():
        names = list(bodies)
        told = names[1:] if len(names) == 2 else names
        for name in told:
            yield point, name, names[0] if len(names) == 2 else "pin", bodies[name]


def force_columns(acting: Forces, *, lengths: bool = True) -> dict[str, Array]:
    """Return columns by name: the driving torque or force, pins by point and body, sliders, and
    friction; vectors also by length."""
    drive = {"N m": "torque_n_m", "N": "drive_force_n"}
    columns = {drive[acting.drive_unit]: acting.torque} if acting.drive_unit else {}
    for point, body, _, force in acted_on(acting):
        stem = f"{point}_{body.replace(' ', '_')}"
        columns[f"{stem}_fx_n"], columns[f"{stem}_fy_n"] = force[:, 0], force[:, 1]
        if lengths:
            columns[f"{stem}_f_n"] = np.hypot(force[:, 0], force[:, 1])
    for name, slider in acting.sliders.items():
        columns[f"{name}_slider_normal_n"] = slider.normal
        columns[f"{name}_slider_moment_n_m"] = slider.moment
    for joint, series in acting.friction.items():
        is_slider = joint in acting.sliders
        columns[f"{joint}_slider_friction_n" if is_slider else f"{joint}_friction_n_m"] = series
    return columns


ROUNDING = 1e-15
"""Part of the largest energy below which an energy is 0."""
NAMED = 4
"""Number of instants that a note names."""


def free_columns(free: FreeMotion, time_s: Array) -> dict[str, Array]:
    """Return further columns of a free motion, by names with units: energies, the work of loads,
    dampers and friction since the start, the sensitivity, and the uncertainty of the driver's
    angle."""
    energy = free.energy(time_s)
    return {
        "kinetic_j": energy.kinetic,
        "potential_j": energy.potential,
        "work_j": energy.work,
        "sensitivity": free.sensitivity(time_s),
        "error_rad": free.error_rad(time_s),
    }


def free_tables(free: FreeMotion, motion: Motion, width: int) -> list[Table]:
    """Return the driver's motion and the energy over time."""
    energy = free.energy(motion.time_s)
    driver = motion.links[free.scene.driver.link]
    own: Columns = [("omega\nrad/s", driver.omega), ("alpha\nrad/s^2", driver.alpha)]
    series = {"kinetic": energy.kinetic, "potential": energy.potential, "work": energy.work}
    largest = max(float(np.max(np.abs(each))) for each in series.values())
    kept: Columns = [
        (f"{name}\nJ", np.where(np.abs(each) <= ROUNDING * largest, 0.0, each))
        for name, each in series.items()
    ]
    bodies = [("", own), ("energy", kept)]
    return tables_over_time(free.scene, motion, bodies, width)


def free_notes(motion: FreeMotion, until_s: float) -> list[str]:
    """Return the uncertainty of the motion and events up to an instant [s], in sentences."""
    last = np.array([until_s])
    off, growth = float(motion.error_rad(last)[0]), float(motion.sensitivity(last)[0])
    angle = f"the angle of {motion.scene.driver.link}" if motion.by_dyads else "every link's angle"
    notes = [
        f"Integrated with high precision, no closed form: uncertainty of {angle} at most "
        f"{error_text(off)} rad at {until_s:g} s.",
        f"Sensitivity {growth:.3g}: growth of a small change of the start until then.",
    ]
    passed = [one for one in motion.passages if one.time_s <= until_s]
    limits = [
        f"{math.degrees(one.driver_rad):.6g} deg at {one.time_s:.6g} s ({one.dyad})"
        for one in passed
    ]
    if limits:
        notes.append(f"Limits in which {motion.scene.driver.link} turns back: {_few(limits)}.")
    edges = [f"{time_s:.6g}" for time_s in motion.edges_s if time_s <= until_s]
    if edges:
        instants = count(len(edges), "instant")
        notes.append(f"Loads are not smooth at {instants}: {_few(edges)} s.")
    return notes


def _few(words: list[str]) -> str:
    left = len(words) - NAMED
    return ", ".join(words[:NAMED]) + (f", and {left} more" if left > 0 else "")


LEAST, MOST, IN_A_TURN, IN_A_SECOND = 121, 1201, 45, 60
"""Instants of the drawing: at least and at most, in a turn, and in a second."""


def instants(free: FreeMotion) -> int:
    """Return the number of instants in a drawing of a free motion."""
    turns = free.peak_speed_rad_s * free.until_s / math.tau
    wanted = max(IN_A_TURN * turns, IN_A_SECOND * free.until_s)
    return int(np.clip(wanted, LEAST, MOST))
