"""The figures of a free motion: over time, its energy, and the phase diagram."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from analytic.free.free_motion import FreeMotion
from models.array import Array
from models.motion import Forces, LinkMotion
from models.scene import Scene
from reports.describe.with_forces import with_reactions
from reports.figures import style
from reports.figures.force_figures import reactions
from reports.figures.sheet import ONE, LinePanel, line_figure, sheet, spaced
from reports.output.numbers import error_text

LEAST, MOST, IN_A_TURN = 2401, 7201, 180
"""Samples: of a motion that hardly turns, of one that turns very often, and in a turn at its
largest speed, whose peaks are narrow."""
DRIVER: style.Look = {"color": "#1f5f9e", "linewidth": 1.0}
START: style.Look = {"color": "#c04a1d", "marker": "o", "markersize": 3.5, "linestyle": "none"}
KINETIC: style.Look = {"color": "#c04a1d", "linewidth": 1.0}
TOTAL: style.Look = {"color": style.INK, "linewidth": 0.9, "linestyle": (0, (5.0, 2.0))}
WORK: style.Look = {"color": "#2f7d4c", "linewidth": 0.9, "linestyle": (0, (6.0, 1.5, 1.0, 1.5))}
ROUNDING = 1e-9


@dataclass(frozen=True)
class FreeCourse:
    """A free motion at instants, closely sampled: its driver and the energies [J], kinetic,
    potential, and the work of external forces on both; and its reactions, if requested."""

    free: FreeMotion
    time_s: Array
    driver: LinkMotion
    kinetic: Array
    potential: Array
    work: Array
    acting: Forces | None = None

    @property
    def scene(self) -> Scene:
        return self.free.scene

    def plot(self, axes: Axes, series: Array, **look: Any) -> None:
        """Draw a series over time (T,)."""
        axes.plot(self.time_s, series, **look)

    def mark(self, axes: Axes, *, labelled: bool = True) -> None:
        """Set limits of a time axis, short numbers on the other, and draw the limit positions."""
        axes.set_xlim(float(self.time_s[0]), float(self.time_s[-1]))
        axes.set_xlabel("time [s]" if labelled else "")
        axes.tick_params(labelbottom=labelled)
        style.shorten(axes)
        for one in self.free.passages:
            axes.axvline(one.time_s, color=style.QUIET, linewidth=0.5, linestyle=(0, (1.0, 2.0)))

    @property
    def notes(self) -> list[str]:
        """Notes under each figure."""
        scene, end = self.scene, self.time_s[-1:]
        how = f"integrated to {error_text(float(self.free.error_rad(end)[0]))} rad"
        springs = [f"springs: {', '.join(scene.springs)}"] if scene.springs else []
        return [style.note(scene, how, scene.driver.link, style.loads_told(scene), *springs)]

    @property
    def notes_over_time(self) -> list[str]:
        """Notes under a figure over time."""
        dotted = "Dotted: limit positions, in which the driver turns back."
        return [*self.notes, *([dotted] * bool(self.free.passages))]


def free_course(free: FreeMotion, *, with_forces: bool = False) -> FreeCourse:
    """Return the motion from its start to its end. Raises CrankcheckError as `FreeMotion.at`, and
    for reactions that are open."""
    turns = free.peak_speed_rad_s * free.until_s / math.tau
    count = int(np.clip(IN_A_TURN * turns, LEAST, MOST))
    time_s = np.linspace(0.0, free.until_s, count)
    motion, energy = free.at(time_s, bound=False), free.energy(time_s)
    acting = with_reactions(free, motion, bound=False).forces if with_forces else None
    driver = motion.links[free.scene.driver.link]
    return FreeCourse(free, time_s, driver, energy.kinetic, energy.potential, energy.work, acting)


def _over_time(course: FreeCourse) -> Figure:
    driver = course.driver
    turns = float(np.ptp(driver.theta)) > 4 * math.tau
    unit, per = ("turns", math.tau) if turns else ("deg", math.radians(1.0))
    angle = f"angle of {course.scene.driver.link} [{unit}]"
    panels = [
        LinePanel(angle, [("", driver.theta / per, DRIVER)]),
        LinePanel("angular velocity [rad/s]", [("", driver.omega, DRIVER)], marks_zero=True),
    ]
    notes = course.notes_over_time
    return line_figure(course, "Free motion", panels, notes, height=1.25, down=0.12)[0]


def _energy(course: FreeCourse) -> Figure:
    """Draw kinetic and potential energy over time, from the lowest potential on the way, their sum,
    and the work done on them; energies that stay at 0 are left out."""
    potential = course.potential - np.min(course.potential)
    largest = float(max(np.max(course.kinetic), np.max(potential)))
    curves = [("kinetic", course.kinetic, KINETIC)]
    if np.max(potential) > ROUNDING * largest:
        curves.append(("potential (weights, springs)", potential, DRIVER))
        curves.append(("total", course.kinetic + potential, TOTAL))
    if np.max(np.abs(course.work)) > ROUNDING * largest:
        curves.append(("work of loads, dampers, friction", course.work, WORK))
    panel = LinePanel("energy [J]", curves, marks_zero=True)
    return line_figure(course, "Energy", [panel], course.notes_over_time)[0]


def _phase(course: FreeCourse) -> Figure:
    """Draw the phase diagram, the driver's angular velocity over its angle; where the driver turns
    round, all turns lie over one another."""
    degrees, omega, label = np.degrees(course.driver.theta), course.driver.omega, "angle of"
    turning = float(np.ptp(degrees)) > 360.0
    if turning:
        degrees, omega = _over_one_turn(degrees, omega)
        label = "angle within a turn of"
    title, notes = f"Phase diagram: {course.scene.name}", [*course.notes, "The dot is the start."]
    figure, (axes,) = sheet(style.COLUMN_IN, ONE, title, [], notes)
    style.mark_zero(axes, course.driver.omega)
    axes.plot(degrees, omega, **DRIVER | {"linewidth": 0.8})
    axes.plot(degrees[:1], omega[:1], **START)
    axes.set_xlabel(f"{label} {course.scene.driver.link} [deg]")
    axes.set_ylabel("angular velocity [rad/s]")
    style.shorten(axes)
    if turning:
        axes.set_xlim(0.0, 360.0)
        spaced(axes, 60.0)
    return figure


def _over_one_turn(degrees: Array, omega: Array) -> tuple[Array, Array]:
    """Return angles within a turn, the curve cut where one turn goes over into the next: there it
    ends at one side and goes on at the other."""
    turn = np.floor(np.round(degrees, 9) / 360.0)
    cuts = np.flatnonzero(np.diff(turn)) + 1
    before, after = turn[cuts - 1], turn[cuts]
    edge = 360.0 * np.maximum(before, after)
    share = (edge - degrees[cuts - 1]) / (degrees[cuts] - degrees[cuts - 1])
    there = omega[cuts - 1] + share * (omega[cuts] - omega[cuts - 1])
    none = np.full(cuts.size, math.nan)
    sides = np.column_stack([edge - 360.0 * before, none, edge - 360.0 * after])
    place = np.repeat(cuts, 3)
    return (
        np.insert(degrees - 360.0 * turn, place, sides.ravel()),
        np.insert(omega, place, np.column_stack([there, none, there]).ravel()),
    )


def _reactions(course: FreeCourse) -> Figure | None:
    if course.acting is None:
        return None
    return reactions(course, course.acting, course.notes_over_time)


FREE_FIGURES: style.FigureSet[FreeCourse] = style.FigureSet(
    "a free motion",
    {"over-time": _over_time, "energy": _energy, "phase": _phase, "reactions": _reactions},
)
