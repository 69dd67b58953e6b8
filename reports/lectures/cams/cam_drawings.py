"""Diagrams of a cam over its angle, and its profile coloured by the pressure angle."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MultipleLocator

from analytic.cams.cam_design import ExaminedCam
from analytic.cams.profile import touch, turn_of
from models.array import Array
from reports.figures.sheet import SIDES, Panels, sheet
from reports.figures.style import COLUMN_IN, INK, QUIET, SMALL, TINY, Look, saved, shorten, styled
from reports.lectures.cams.cam_sheet import coloured, draw_cam
from reports.lectures.cams.profile_files import unit_of
from reports.lectures.drawing.sheets.paper import Paper
from reports.output.write import crankcheck_version

CURVE: Look = {"color": "#1f5f9e", "linewidth": 1.2}
LIMIT: Look = {"color": "#c04a1d", "linewidth": 0.7, "linestyle": (0, (4.0, 1.5))}
STEPS = 240
"""Samples between two knots."""


def drawings(name: str, source: str, found: ExaminedCam, paper: str) -> Mapping[str, bytes]:
    """Return all drawings as SVG and PDF by the names of their files."""
    size, note = Paper.of(paper), f"crankcheck {crankcheck_version()}, closed form; {source}"
    files: dict[str, bytes] = {}
    with styled():
        figures = {
            "diagrams": draw_diagrams(name, note, found),
            "checks": draw_checks(name, note, found),
        }
        if found.rise_pressure[0] or found.return_pressure[0]:
            figures["pressure"] = draw_pressure(name, note, found)
        drawn = draw_cam(name, note, found, size)
    for kind in ("svg", "pdf"):
        files |= {
            f"{key}.{kind}": saved(one, kind, f"{name}: {key}") for key, one in figures.items()
        }
        files[f"cam.{kind}"] = drawn.saved(kind, f"{name}: cam")
    return files


def samples(found: ExaminedCam) -> Array:
    """Return angles over a turn, dense between knots, with limits from both sides of them (T,)."""
    knots = turn_of(found.cam)
    spans = [np.linspace(a, np.nextafter(b, 0.0), STEPS) for a, b in pairwise(knots)]
    return np.concatenate(spans)


def draw_diagrams(name: str, note: str, found: ExaminedCam) -> Figure:
    """Draw lift, velocity, acceleration and jerk over the cam's angle, by time at its speed."""
    phi, unit, omega = samples(found), unit_of(found.cam), found.speed_rad_s
    rates = ("lift", ""), ("velocity", "/s"), ("acceleration", "/s²"), ("jerk", "/s³")
    series = enumerate(zip(rates, found.cam.law.at(phi), strict=True))
    rows = [(f"{rate} [{unit}{by}]", one * omega**n) for n, ((rate, by), one) in series]
    notes = [f"{note}; at {omega:g} rad/s."]
    if found.cam.law.continuous < 2:
        notes.append("Where a rate jumps, the next one is infinite, and is not drawn there.")
    figure, top = _over_the_turn(f"Law of motion: {name}", found, rows, notes)
    _name_segments(top, found)
    return figure


def _over_the_turn(
    title: str, found: ExaminedCam, rows: Sequence[tuple[str, Array]], notes: Sequence[str]
) -> tuple[Figure, Axes]:
    """Draw series over the cam's angle, a panel for each label; return the figure and its top."""
    panels = Panels(len(rows), 1, 1.0, *SIDES, 0.22, between=(0.0, 0.16))
    figure, axes = sheet(COLUMN_IN, panels, title, [], notes)
    degrees = np.degrees(samples(found))
    for one, (label, series) in zip(axes, rows, strict=True):
        one.plot(degrees, series, **CURVE)
        one.set_ylabel(label)
        _mark(one, found, labelled=one is axes[-1])
    return figure, axes[0]


def _mark(axes: Axes, found: ExaminedCam, *, labelled: bool) -> None:
    """Mark the turn, the line at 0, and the borders of the segments."""
    axes.set_xlim(0.0, 360.0)
    axes.xaxis.set_major_locator(MultipleLocator(60.0))
    axes.axhline(0.0, color=QUIET, linewidth=0.5)
    for border in _borders(found)[1:-1]:
        axes.axvline(border, color=QUIET, linewidth=0.5)
    axes.tick_params(labelbottom=labelled)
    shorten(axes)
    if labelled:
        axes.set_xlabel("angle of the cam [deg]")


def _borders(found: ExaminedCam) -> list[float]:
    spans = [math.degrees(one.span_rad) for one in found.cam.law.segments]
    return [0.0, *np.cumsum(spans).tolist()]


def _name_segments(axes: Axes, found: ExaminedCam) -> None:
    """Write the kinds of motion above a panel, where they have room."""
    borders = _borders(found)
    for start, end, one in zip(borders, borders[1:], found.cam.law.segments, strict=False):
        if end - start >= 36.0:
            axes.annotate(
                one.kind, (0.5 * (start + end), 1.0), (0.0, 2.0), ha="center", va="bottom",
                xycoords=("data", "axes fraction"), textcoords="offset points", size=TINY,
                color=QUIET,
            )  # fmt: skip


def draw_checks(name: str, note: str, found: ExaminedCam) -> Figure:
    """Draw pressure angle, curvature of the profile, contact force and torque over the angle."""
    phi = samples(found)
    contact, forces = touch(found.cam, phi), found.forces(phi)
    with np.errstate(divide="ignore"):
        rows = [
            ("pressure angle [deg]", np.degrees(contact.pressure_rad)),
            ("curvature [1/m]", 1.0 / contact.radius_m),
        ]
    if forces is not None:
        rows += [
            ("contact force [N]", forces.contact_n),
            ("driving torque [N m]", forces.torque_nm),
        ]
    notes = [f"{note}; curvature of the profile, positive where convex"]
    notes[0] += f"; forces at {found.speed_rad_s:g} rad/s." if forces is not None else "."
    return _over_the_turn(f"Pressure angle and forces: {name}", found, rows, notes)[0]


def draw_pressure(name: str, note: str, found: ExaminedCam) -> Figure:
    """Draw the profile coloured by the magnitude of the pressure angle of the point in contact."""
    contact = touch(found.cam, samples(found))
    profile = contact.on_cam(contact.contact) * 1000.0
    (rise, at), (back, back_at) = found.rise_pressure, found.return_pressure
    words = [
        f"{note}; dots: largest in the rise {math.degrees(rise):.4g} deg, in the return "
        f"{math.degrees(back):.4g} deg."
    ]
    marker: Look = {
        "color": INK, "marker": "o", "markersize": 4.0, "linestyle": "none",
        "markeredgecolor": "white", "markeredgewidth": 0.7,
    }  # fmt: skip
    base: Look = {"color": QUIET, "linewidth": 0.6, "linestyle": (0, (6.0, 1.5, 1.0, 1.5))}
    entries = [(Line2D([], [], **base), "base circle"), (Line2D([], [], **marker), "largest")]
    panels = Panels(1, 1, 2.5, 0.48, 0.62, 0.1)
    figure, (axes,) = sheet(COLUMN_IN, panels, f"Pressure angle: {name}", entries, words)
    points = np.array([profile.real, profile.imag]).T
    drawn = coloured(points, np.abs(np.degrees(contact.pressure_rad)))
    axes.add_collection(drawn)
    turn = np.exp(1j * np.linspace(0.0, math.tau, 361)) * found.cam.base_m * 1000.0
    axes.plot(turn.real, turn.imag, **base)
    axes.plot(0.0, 0.0, "+", color=INK, markersize=5.0)
    there = touch(found.cam, np.array([at, back_at]))
    dots = there.on_cam(there.contact) * 1000.0
    axes.plot(dots.real, dots.imag, **marker)
    axes.set(xlabel="x [mm]", ylabel="y [mm]")
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.06)
    box = axes.get_position()
    bar = figure.add_axes((box.x1 + 0.03, box.y0, 0.03, box.height))
    figure.colorbar(drawn, cax=bar).set_label("pressure angle [deg]", size=SMALL)
    return figure
