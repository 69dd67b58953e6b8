"""A motion as tables on the terminal: one position in full, or links and sliders over time."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from rich.table import Table

from analytic.mechanism.travel import coriolis
from models.array import Array
from models.motion import Motion
from models.scene import Scene
from models.scene.driver import driver_place
from reports.describe.facts import SpeedFacts
from reports.output.console import plain_table

WIDE = 100
Columns = list[tuple[str, Array]]


def digits(value: float) -> str:
    """Eight significant digits, zeros at the end included; a dash for what is not determined."""
    return "-" if math.isnan(value) else f"{value + 0.0:#.8g}"


def position_tables(scene: Scene, motion: Motion) -> list[Table]:
    """Those that the motion has of links, points and sliders, at one position; the Coriolis
    component of those on a moving guide, where there are any."""
    links = head_table("link", ("theta deg", "theta rad", "omega rad/s", "alpha rad/s^2"))
    for name, link in motion.links.items():
        theta = float(link.theta[0])
        numbers = (math.degrees(theta), theta, float(link.omega[0]), float(link.alpha[0]))
        links.add_row(name, *map(digits, numbers))
    places = head_table("point", ("x m", "y m", "vx m/s", "vy m/s", "v m/s"))
    rates = head_table("point", ("ax m/s^2", "ay m/s^2", "a m/s^2"))
    for name, point in motion.points.items():
        v, a = point.velocity[0], point.acceleration[0]
        row = [*point.position[0], *v, np.hypot(*v)]
        places.add_row(name, *(digits(float(value)) for value in row))
        rates.add_row(name, *(digits(float(value)) for value in (*a, np.hypot(*a))))
    tables = [table for table in (links, places, rates) if table.row_count]
    if motion.sliders:
        whole = motion.sliders.keys() == scene.sliders.keys() and motion.links
        turned = coriolis(scene, motion) if whole else {}
        heads = ("displacement m", "speed m/s", "acceleration m/s^2")
        sliders = head_table("slider", (*heads, "Coriolis m/s^2") if turned else heads)
        for name, slider in motion.sliders.items():
            row = [slider.displacement[0], slider.speed[0], slider.acceleration[0]]
            row += [turned[name][0] if name in turned else 0.0] if turned else []
            sliders.add_row(name, *(digits(float(value)) for value in row))
        tables.append(sliders)
    return tables


def speed_table(speeds: SpeedFacts) -> Table:
    """Extreme speeds, a row for each output; long rows are folded within their column."""
    table = plain_table()
    table.add_column(no_wrap=True)
    table.add_column(speeds.title, overflow="fold")
    for name, words in speeds.rows.items():
        table.add_row(name, words)
    return table


def certainty(motion: Motion) -> str:
    """What the reference may be wrong by, in a line."""
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
    """Links and sliders over time, as many bodies to a table as the terminal has room for."""
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
    """Series by owner beside the time and the driver's angle; ``width`` is the terminal's."""
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
    """A table with a first column of names; each other head is a word and its unit."""
    table = plain_table()
    table.add_column(head, no_wrap=True)
    for column in columns:
        table.add_column(column.replace(" ", "\n", 1), justify="right", no_wrap=True)
    return table
