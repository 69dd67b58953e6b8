"""Drawings of a cam: diagrams over its angle, and the cam with its follower to scale, its profile
coloured by the pressure angle."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon

from analytic.cams.cam_design import ExaminedCam
from analytic.cams.profile import CamContact, Plane, largest, touch
from models.array import Array
from models.scene.cams import Cam, OscillatingFollower
from reports.figures.layout import LAYOUT
from reports.figures.sheet import SIDES, Panels, sheet, spaced
from reports.figures.style import COLUMN_IN, INK, QUIET, TINY, Look, saved, shorten, styled
from reports.lectures.cams.profile_files import unit_of
from reports.lectures.drawing.sheets.paper import (
    Canvas,
    Paper,
    ToScale,
    arrow,
    arrow_head,
    headed,
    inner_box,
    text,
)
from reports.output.write import crankcheck_version

CURVE: Look = {"color": "#1f5f9e", "linewidth": 1.2}
PITCH: Look = {"color": "#2f7d4c", "linewidth": 0.7, "linestyle": (0, (5.0, 2.0))}
CIRCLE: Look = {"color": QUIET, "linewidth": 0.6, "linestyle": (0, (6.0, 1.5, 1.0, 1.5))}
FOLLOWER: Look = {"color": INK, "linewidth": 1.0}
FORCE, FILL, COLOURS = "#c04a1d", "#dbe7f3", "viridis_r"
ALPHA = "\N{GREEK SMALL LETTER ALPHA}"
ROUND = np.exp(1j * np.linspace(0.0, math.tau, 361))
STEPS = 240
"""Samples between two knots."""
WORDS_MM, LINE_MM, BAR_MM = 62.0, 5.2, 14.0
"""Width of the numbers beside the cam, and the heights of one, and of the colours below them."""


def drawings(
    name: str, source: str, found: ExaminedCam, numbers: Mapping[str, str], paper: str
) -> Mapping[str, bytes]:
    """Return all drawings by the names of their files; the numbers, by name, stand
    beside the cam."""
    size, note = Paper.of(paper), f"crankcheck {crankcheck_version()}, closed form; {source}"
    files: dict[str, bytes] = {}
    with styled():
        figures = {
            "diagrams": draw_diagrams(name, note, found),
            "checks": draw_checks(name, note, found),
        }
        drawn = draw_cam(name, note, found, numbers, size)
    for kind in LAYOUT.get().formats:
        files |= {
            f"{key}.{kind}": saved(one, kind, f"{name}: {key}") for key, one in figures.items()
        }
        files[f"cam.{kind}"] = drawn.saved(kind, f"{name}: cam")
    return files


def samples(found: ExaminedCam) -> Array:
    """Return angles over a turn, dense between knots, with limits from both sides of them (T,)."""
    knots = found.cam.law.knots_rad
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
    figure, axes = _over_the_turn(f"Law of motion: {name}", found, rows, notes)
    for (start, end), one in zip(pairwise(_borders(found)), found.cam.law.segments, strict=True):
        if end - start >= 36.0:  # it has room for its name
            axes[0].annotate(
                one.kind, (0.5 * (start + end), 1.0), (0.0, 2.0), ha="center", va="bottom",
                xycoords=("data", "axes fraction"), textcoords="offset points", size=TINY,
                color=QUIET,
            )  # fmt: skip
    return figure


def _over_the_turn(
    title: str, found: ExaminedCam, rows: Sequence[tuple[str, Array]], notes: Sequence[str]
) -> tuple[Figure, list[Axes]]:
    """Draw series over the cam's angle, a panel for each label, between borders of segments."""
    panels = Panels(len(rows), 1, 1.0, *SIDES, 0.22, between=(0.0, 0.16))
    figure, axes = sheet(COLUMN_IN, panels, title, [], notes)
    degrees = np.degrees(samples(found))
    for one, (label, series) in zip(axes, rows, strict=True):
        one.plot(degrees, series, **CURVE)
        one.set_ylabel(label)
        one.set_xlim(0.0, 360.0)
        spaced(one, 60.0)
        one.axhline(0.0, color=QUIET, linewidth=0.5)
        for border in _borders(found)[1:-1]:
            one.axvline(border, color=QUIET, linewidth=0.5)
        one.tick_params(labelbottom=one is axes[-1])
        shorten(one)
    axes[-1].set_xlabel("angle of the cam [deg]")
    return figure, axes


def _borders(found: ExaminedCam) -> list[float]:
    spans = [math.degrees(one.span_rad) for one in found.cam.law.segments]
    return [0.0, *np.cumsum(spans).tolist()]


def draw_checks(name: str, note: str, found: ExaminedCam) -> Figure:
    """Draw pressure angle, curvature of the profile, contact force and torque over the angle."""
    phi = samples(found)
    contact = touch(found.cam, phi)
    with np.errstate(divide="ignore"):
        rows = [
            ("pressure angle [deg]", np.degrees(contact.pressure_rad)),
            ("curvature [1/m]", 1.0 / contact.radius_m),
        ]
    notes = [f"{note}; curvature of the profile, positive where convex"]
    if found.load is not None:
        forces = found.forces(phi)
        notes[0] += f"; forces at {found.speed_rad_s:g} rad/s"
        rows += [
            ("contact force [N]", forces.contact_n),
            ("driving torque [N m]", forces.torque_nm),
        ]
    notes[0] += "."
    return _over_the_turn(f"Pressure angle and forces: {name}", found, rows, notes)[0]


@dataclass(frozen=True)
class CamPlot:
    """Axes in millimetres of the sheet, and a drawing to scale in them."""

    axes: Axes
    scaled: ToScale

    def place(self, points: Plane) -> Array:
        return self.scaled.at(np.stack([points.real, points.imag], axis=-1))

    def curve(self, points: Plane, **look: object) -> None:
        self.axes.add_line(Line2D(*self.place(points).T, **look))  # type: ignore[arg-type]  # a look

    def write(self, point: complex, words: str, right: float, up: float, ha: str = "left") -> None:
        x, y = self.place(np.array(point))
        text(self.axes, x + right, y + up, words, ha=ha)


def draw_cam(
    name: str, note: str, found: ExaminedCam, numbers: Mapping[str, str], paper: Paper
) -> Canvas:
    """Draw the cam with its follower where the pressure angle of the rise is largest, or the speed
    of one that has no such angle; the colour of the profile is the contact force there, or the
    pressure angle of a cam without a load."""
    cam, (most, phi) = found.cam, found.pressures[0]
    if not most:
        phi = largest(cam.law.knots_rad, lambda at: cam.law.at(at).first)[1]
    contact, turned = touch(cam, np.array([phi])), np.exp(1j * cam.sense * phi)
    angles = np.linspace(0.0, math.tau, 1441)
    round_ = touch(cam, angles)
    profile = round_.on_cam(round_.contact) * turned
    size = 0.5 * float(np.abs(profile).max())
    lines = _follower(cam, contact, size)
    drawing, words = inner_box(paper).side_by_side(WORDS_MM, 4.0)
    canvas, frame = headed(paper, f"Cam: {name}", note, drawing)
    every = np.concatenate([profile, *lines, cam.base_m * ROUND])
    scale, middle = drawing.fitted(np.stack([every.real, every.imag], axis=1), 4.0)
    plot = CamPlot(canvas.layer("cam"), ToScale(drawing, scale, middle))
    plot.axes.add_patch(Polygon(plot.place(profile), closed=True, fc=FILL, ec="none"))
    plot.curve(cam.base_m * ROUND, **CIRCLE)
    if cam.follower.roller_m and round_.pitch is not None:
        plot.curve(round_.on_cam(round_.pitch) * turned, **PITCH)
    plot.curve(profile, **CURVE)
    if found.load is not None:
        label = f"contact force [N] at {found.speed_rad_s:g} rad/s"
        shades = found.forces(angles).contact_n
    else:
        label, shades = "pressure angle [deg]", np.abs(np.degrees(round_.pressure_rad))
    if np.ptp(shades) > 0.0:
        points = plot.place(profile)
        drawn = LineCollection(
            list(np.stack([points[:-1], points[1:]], axis=1)), cmap=COLOURS, linewidths=3.0,
            array=shades[:-1], capstyle="round",
        )  # fmt: skip
        plot.axes.add_collection(drawn)
        place = np.array([words.left, words.bottom + BAR_MM - 4.0, 0.9 * WORDS_MM, 4.0])
        bar = canvas.figure.add_axes(place / np.tile([paper.width, paper.height], 2))
        canvas.figure.colorbar(drawn, cax=bar, orientation="horizontal").set_label(label)
    plot.curve(0.06 * size * ROUND, **FOLLOWER)
    plot.write(0j, "O", 2.0, -4.0)
    for line in lines:
        plot.curve(line, **FOLLOWER)
    if isinstance(cam.follower, OscillatingFollower):
        plot.write(complex(cam.follower.pivot_m), "B", 1.5, -4.5)
    _draw_pressure(plot, contact, size)
    arc = 0.55 * cam.base_m * np.exp(1j * cam.sense * np.linspace(-2.4, -0.9, 60))
    plot.curve(arc, **FOLLOWER)
    before, end = plot.place(arc[-2:])
    arrow_head(plot.axes, end, (end - before) / np.hypot(*(end - before)), INK)
    shown = {"scale m/mm": f"{scale:g}", "shown at deg": f"{math.degrees(phi):.4g}", **numbers}
    down = min(LINE_MM, (words.height - BAR_MM) / (len(shown) + 1))
    for k, (head, number) in enumerate(shown.items(), start=1):
        text(frame, words.left, words.top - k * down, head, color=QUIET)
        text(frame, words.left + 0.65 * WORDS_MM, words.top - k * down, number)
    return canvas


def _follower(cam: Cam, contact: CamContact, size: float) -> list[Plane]:
    """Return the lines of the follower at its contact (1,), in the frame of the ground: roller or
    face, its stem in a guide, or its arm and pivot, of a ``size`` [m] where it has none."""
    follower, (touched,), (normal,) = cam.follower, contact.contact, contact.normal
    tip = touched + follower.roller_m * normal
    lines = [tip + follower.roller_m * ROUND] if follower.roller_m else []
    if isinstance(follower, OscillatingFollower):
        pivot = complex(follower.pivot_m)
        lines.append(pivot + 0.05 * size * ROUND)
        if not follower.is_flat:
            return [*lines, np.array([pivot, tip])]
        foot = pivot + follower.face_m * normal  # on the face, drawn to beyond the contact
        return [*lines, np.array([pivot, foot, tip + 0.5 * size * (tip - foot) / abs(tip - foot)])]
    if follower.is_flat:
        tip = follower.offset_m + 1j * tip.imag
        reach = max(0.6 * size, *(1.15 * abs(speed) for speed in cam.law.extremes[1]))
        lines.append(tip + np.array([-reach, reach]))
    guide = tip + np.array([1.0j, 1.3j]) * size
    return [*lines, tip + np.array([0.0, 1.4j * size]), guide - 0.07 * size, guide + 0.07 * size]


def _draw_pressure(plot: CamPlot, contact: CamContact, size: float) -> None:
    """Draw the normal, the velocity of the follower, and the angle between them at the contact."""
    (touched,), (normal,), (alpha,) = contact.contact, contact.normal, contact.pressure_rad
    centre = touched if contact.pitch is None else contact.pitch[0]
    start, end = plot.place(np.array([touched, centre + 0.9 * size * normal]))
    arrow(plot.axes, start, end, "normal", FORCE)
    motion = normal * np.exp(-1j * alpha)
    plot.curve(np.array([centre, centre + 0.8 * size * motion]), color=QUIET, linewidth=0.4)
    arc = centre + 0.6 * size * motion * np.exp(1j * alpha * np.linspace(0.0, 1.0, 40))
    plot.curve(arc, color=FORCE, linewidth=0.6)
    if abs(alpha) > math.radians(3.0):
        beside = centre + 0.6 * size * motion * np.exp(1.15j * alpha)
        side = "right" if (normal * np.exp(0.5j * math.pi * np.sign(alpha))).real < 0.0 else "left"
        plot.write(beside, f"{ALPHA} = {abs(math.degrees(alpha)):.3g}°", 0.0, 0.0, side)
