"""A free motion in words and columns: its energy, its uncertainty, and events on its way."""

import math

import numpy as np
from rich.table import Table

from analytic.free.free_motion import FreeMotion
from models.array import Array
from models.motion import Motion
from reports.describe.motion_tables import Columns, tables_over_time
from reports.output.numbers import count, error_text

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
    """Return the uncertainty of the motion up to an instant [s], and events until then, in
    sentences."""
    last = np.array([until_s])
    off, growth = float(motion.error_rad(last)[0]), float(motion.sensitivity(last)[0])
    angle = f"the angle of {motion.scene.driver.link}" if motion.by_dyads else "every link's angle"
    notes = [
        f"Integrated with high precision, no closed form: {angle} is off by at most "
        f"{error_text(off)} rad at {until_s:g} s.",
        f"Sensitivity {growth:.3g}: what the start is changed by has grown so many times by then.",
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
        notes.append(f"What acts is not smooth at {instants}: {_few(edges)} s.")
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
