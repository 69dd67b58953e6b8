"""Sheets of a cam to scale: the cam with its follower, and its construction by inversion.

In the construction the cam rests, and the follower goes round it against the cam's sense, as
textbooks draw it: the base circle is divided, lifts are carried over from their diagram, and the
profile is the envelope of the follower's positions (Norton, Design of Machinery, 5th ed. 2012,
ch. 8; the problem book, chapter on cams).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon

from analytic.cams.cam_design import ExaminedCam
from analytic.cams.profile import CamContact, Plane, largest, touch, turn_of
from models.array import Array
from models.scene.cams import Cam, OscillatingFollower
from reports.figures.style import INK, QUIET, SMALL, Look
from reports.lectures.drawing.sheets.paper import (
    Box,
    Canvas,
    Paper,
    ToScale,
    arrow,
    arrow_head,
    headed,
    inner_box,
    text,
)

CAM: Look = {"color": "#1f5f9e", "linewidth": 1.3}
PITCH: Look = {"color": "#2f7d4c", "linewidth": 0.7, "linestyle": (0, (5.0, 2.0))}
CIRCLE: Look = {"color": QUIET, "linewidth": 0.5, "linestyle": (0, (8.0, 1.5, 1.0, 1.5))}
FOLLOWER: Look = {"color": INK, "linewidth": 1.0}
THIN: Look = {"color": QUIET, "linewidth": 0.4}
FORCE = "#c04a1d"
COLOURS = "viridis_r"
FILL = "#dbe7f3"
ALPHA = "\N{GREEK SMALL LETTER ALPHA}"
ROUND = np.exp(1j * np.linspace(0.0, math.tau, 361))
WORDS_MM = 62.0


@dataclass(frozen=True)
class CamPlot:
    """Axes in millimetres of the sheet, and a drawing to scale in them."""

    axes: Axes
    scaled: ToScale

    def place(self, points: Plane) -> Array:
        return self.scaled.at(np.stack([points.real, points.imag], axis=-1))

    def curve(self, points: Plane, **look: object) -> None:
        x, y = self.place(np.asarray(points)).T
        self.axes.add_line(Line2D(x, y, **look))  # type: ignore[arg-type]  # a look

    def write(self, point: complex, words: str, right: float, up: float, **look: object) -> None:
        x, y = self.place(np.array([point]))[0]
        text(self.axes, x + right, y + up, words, **({"size": SMALL} | look))  # type: ignore[arg-type]  # a look


def coloured(places: Array, values: Array) -> LineCollection:
    """Return a curve through places (n, 2), coloured by values (n,)."""
    sides = list(np.stack([places[:-1], places[1:]], axis=1))
    return LineCollection(sides, cmap=COLOURS, linewidths=3.0, array=values[:-1], capstyle="round")


def follower_lines(cam: Cam, contact: CamContact, k: int, size: float) -> list[Plane]:
    """Return the lines of the follower in the frame of the ground: roller or edge, stem or arm, of
    a ``size`` [m] where it has none of its own."""
    tip = complex(contact.contact[k]) if contact.pitch is None else complex(contact.pitch[k])
    normal, roller = complex(contact.normal[k]), cam.follower.roller_m
    lines = [tip + roller * ROUND] if roller else []
    if isinstance(cam.follower, OscillatingFollower):
        pivot = complex(cam.follower.pivot_m)
        if cam.follower.is_flat:  # a foot on the face, and the face from it to beyond the contact
            foot = pivot + cam.follower.face_m * normal
            along = (tip - foot) / abs(tip - foot)
            return [np.array([pivot, foot, tip + 0.5 * size * along])]
        return [*lines, np.array([pivot, tip])]
    if cam.follower.is_flat:
        middle = cam.follower.offset_m + 1j * tip.imag
        reach = max(
            0.6 * size, 1.15 * abs(cam.law.extremes(1)[1]), 1.15 * abs(cam.law.extremes(1)[0])
        )
        return [middle + np.array([-reach, reach]), middle + np.array([0.0, 1.4j * size])]
    edge = tip + size * np.array([-0.12 + 0.25j, 0.0, 0.12 + 0.25j]) if not roller else None
    start = tip + (0.25j * size if edge is not None else 0.0)
    stem = np.array([start, tip + 1.4j * size])
    return [*lines, stem] if edge is None else [np.append(edge, edge[:1]), stem]


def draw_cam(name: str, note: str, found: ExaminedCam, paper: Paper) -> Canvas:
    """Draw the cam with its follower where the pressure angle of the rise is largest, or the speed
    of one that has no such angle."""
    cam, (most, phi) = found.cam, found.rise_pressure
    if not most:
        phi = largest(turn_of(cam), lambda at: cam.law.at(at).first)[1]
    contact = touch(cam, np.array([phi]))
    turned = np.exp(1j * cam.sense * phi)
    angles = np.linspace(0.0, math.tau, 1441)
    round_, forces = touch(cam, angles), found.forces(angles)
    profile = round_.on_cam(round_.contact) * turned
    size = 0.5 * float(np.abs(profile).max())
    lines = follower_lines(cam, contact, 0, size)
    drawing, words = inner_box(paper).side_by_side(WORDS_MM, 4.0)
    canvas, frame = headed(paper, f"Cam: {name}", note, drawing)
    plot = _plot(canvas.layer("cam"), drawing, [profile, *lines, cam.base_m * ROUND])
    plot.axes.add_patch(Polygon(plot.place(profile), closed=True, fc=FILL, ec="none"))
    plot.curve(cam.base_m * ROUND, **CIRCLE)
    if cam.follower.roller_m and round_.pitch is not None:
        plot.curve(round_.on_cam(round_.pitch) * turned, **PITCH)
    plot.curve(profile, **CAM)
    if forces is not None:
        label = f"contact force [N] at {found.speed_rad_s:g} rad/s"
        _colour(plot, words, coloured(plot.place(profile), forces.contact_n), label)
    plot.curve(0.06 * size * ROUND, **FOLLOWER)
    plot.write(0j, "O", 2.0, -4.0)
    for line in lines:
        plot.curve(line, **FOLLOWER)
    _draw_supports(plot, cam, lines, size)
    _draw_pressure(plot, cam, contact, size)
    _draw_sense(plot, cam)
    _write_facts(frame, words, found, plot.scaled.scale, phi)
    return canvas


def _plot(axes: Axes, box: Box, curves: list[Plane]) -> CamPlot:
    every = np.concatenate(curves)
    scale, middle = box.fitted(np.stack([every.real, every.imag], axis=1), 4.0)
    return CamPlot(axes, ToScale(box, scale, middle))


def _colour(plot: CamPlot, box: Box, curve: LineCollection, label: str) -> None:
    """Draw a coloured curve, and its colour bar at the foot of a box."""
    plot.axes.add_collection(curve, autolim=False)
    place = (box.left, box.bottom + 2.0, 4.0, min(0.35 * box.height, box.height - 78.0))
    bar = plot.axes.inset_axes(place, transform=plot.axes.transData)
    plot.axes.figure.colorbar(curve, cax=bar)
    bar.set_title(label, size=SMALL, loc="left")


def _draw_supports(plot: CamPlot, cam: Cam, lines: list[Plane], size: float) -> None:
    """The guide of a stem, or the pivot of an arm."""
    if isinstance(cam.follower, OscillatingFollower):
        pivot = complex(cam.follower.pivot_m)
        plot.curve(pivot + 0.05 * size * ROUND, **FOLLOWER)
        plot.write(pivot, "B", 1.5, -4.5)
        return
    stem = lines[-1]
    for side in (-1, 1):
        x = stem[0].real + side * 0.07 * size
        y = stem[-1].imag - np.array([0.4, 0.1]) * size
        plot.curve(x + 1j * y, color=INK, linewidth=1.6)


def _draw_pressure(plot: CamPlot, cam: Cam, contact: CamContact, size: float) -> None:
    """The normal, the velocity of the follower, and the angle between them at the contact."""
    touched, normal = complex(contact.contact[0]), complex(contact.normal[0])
    alpha = float(contact.pressure_rad[0])
    centre = touched if contact.pitch is None else complex(contact.pitch[0])
    start, end = plot.place(np.array([touched, centre + 0.9 * size * normal]))
    arrow(plot.axes, start, end, "normal", FORCE)
    motion = normal * np.exp(-1j * alpha)
    plot.curve(np.array([centre, centre + 0.8 * size * motion]), **THIN)
    arc = centre + 0.6 * size * motion * np.exp(1j * alpha * np.linspace(0.0, 1.0, 40))
    plot.curve(arc, color=FORCE, linewidth=0.6)
    if abs(alpha) > math.radians(3.0):
        beside = centre + 0.6 * size * motion * np.exp(1.15j * alpha)
        side = "right" if (normal * np.exp(0.5j * math.pi * np.sign(alpha))).real < 0.0 else "left"
        plot.write(beside, f"{ALPHA} = {abs(math.degrees(alpha)):.3g}°", 0.0, 0.0, ha=side)


def _draw_sense(plot: CamPlot, cam: Cam) -> None:
    """An arc with an arrow head in the sense of the cam."""
    arc = 0.55 * cam.base_m * np.exp(1j * cam.sense * np.linspace(-2.4, -0.9, 60))
    plot.curve(arc, color=INK, linewidth=0.8)
    before, end = plot.place(arc[-2:])
    arrow_head(plot.axes, end, (end - before) / np.hypot(*(end - before)), INK)


def _write_facts(axes: Axes, box: Box, found: ExaminedCam, scale: float, phi: float) -> None:
    """The numbers beside the drawing."""
    cam, deg = found.cam, math.degrees
    follower = cam.follower
    stroke = cam.law.stroke
    rows = [("scale K_l", f"{scale:g} m/mm"), ("base radius", f"{1e3 * cam.base_m:.5g} mm")]
    if isinstance(follower, OscillatingFollower):
        rows += [
            ("stroke", f"{deg(stroke):.5g}°"),
            ("pivot at", f"{1e3 * follower.pivot_m:.5g} mm"),
        ]
        rows += [("arm", f"{1e3 * follower.arm_m:.5g} mm")] * (not follower.is_flat)
    else:
        rows += [
            ("stroke", f"{1e3 * stroke:.5g} mm"),
            ("offset", f"{1e3 * follower.offset_m:.5g} mm"),
        ]
    rows += [("roller", f"{1e3 * follower.roller_m:.5g} mm")] * bool(follower.roller_m)
    (rise, at), (back, back_at) = found.rise_pressure, found.return_pressure
    rows += [
        ("shown at", f"{deg(phi):.4g}° of the cam"),
        (f"largest {ALPHA}, rise", f"{deg(rise):.4g}° at {deg(at):.4g}°"),
        (f"largest {ALPHA}, return", f"{deg(back):.4g}° at {deg(back_at):.4g}°"),
        ("convex radius", f"{1e3 * found.convex_radius[0]:.4g} mm or more"),
    ]
    if math.isfinite(found.concave_radius[0]):
        rows.append(("concave radius", f"{1e3 * found.concave_radius[0]:.4g} mm or more"))
    if found.lift_off is not None and math.isfinite(found.lift_off.omega_rad_s):
        rows.append(("leaves at", f"{found.lift_off.omega_rad_s:.5g} rad/s"))
    for k, (head, words) in enumerate(rows):
        y = box.top - 6.0 - 5.2 * k
        text(axes, box.left, y, head, SMALL, color=QUIET)
        text(axes, box.left + 24.0, y, words, SMALL)
