"""Vibration over the speed of the driver: deflection and multipliers, and the waterfall."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from analytic.lectures.vibration.over_speeds import OverSpeeds, spectra
from reports.figures.sheet import Panels, sheet
from reports.figures.style import COLUMN_IN, PAGE_IN, SMALL, logarithmic
from reports.lectures.machine.figures.vibration_figures import (
    COLOURS,
    ORDERS,
    SIDES,
    SMALLEST,
    notes,
    whole_orders,
)
from reports.lectures.machine.speed_rows import unstable_speeds

SHOWN = "#b8860b"
UNSTABLE = "#c0392b"
LINEAR = "linear in the deflection, about the rigid motion, with the stiffness that pull gives"


def draw(over: OverSpeeds) -> Figure:
    """The largest deflection of each link, and below it the largest multiplier."""
    scene, links = over.scene, list(over.points[0].swings)
    entries: list[tuple[Artist, str]] = [
        (Line2D([], [], color=colour), f"{name}, largest over length")
        for name, colour in zip(links, COLOURS * len(links), strict=False)
    ]
    entries.append((Line2D([], [], color="#8a8a8a", linestyle=":"), "critical speed, with order"))
    if unstable_speeds(over):
        entries.append((Line2D([], [], color=UNSTABLE, linewidth=3.0, alpha=0.4), "unstable"))
    shape = Panels(2, 1, 1.6, *SIDES, 0.2, between=(0, 0.12))
    title = f"Vibration over speed: {scene.name}"
    figure, (upper, lower) = sheet(COLUMN_IN, shape, title, entries, notes(scene, LINEAR))
    everything = []
    for name, colour in zip(links, COLOURS * len(links), strict=False):
        shares = np.array([point.swings[name].share for point in over.points])
        everything.append(shares[shares > 0.0])
        upper.plot(over.speeds, np.maximum(shares, 1e-300), color=colour)
    values = np.concatenate(everything)
    logarithmic(upper, "y", 0.5 * float(values.min(initial=1.0)), 2.0 * float(values.max()))
    _mark_critical(upper, over)
    upper.set_ylabel("deflection / length")
    upper.tick_params(labelbottom=False)
    multipliers = np.array([point.stability.largest for point in over.points])
    lower.plot(over.speeds, multipliers, color="#1a1a1a")
    top = float(multipliers.max())
    if top > 10.0:
        logarithmic(lower, "y", 0.5, 2.0 * top)
    else:
        low = float(multipliers.min())
        lower.set_ylim(min(0.9, low - 0.05), max(1.1, 1.05 * top))
    lower.set_ylabel("largest multiplier")
    lower.set_xlabel(f"speed of {scene.driver.link} [rad/s]")
    for axes in (upper, lower):
        axes.set_xlim(over.speeds[0], over.speeds[-1])
        for each in unstable_speeds(over):
            axes.axvspan(each.low_rad_s, each.high_rad_s, color=UNSTABLE, alpha=0.15, linewidth=1.0)
    return figure


def _mark_critical(axes: Axes, over: OverSpeeds) -> None:
    """Dotted lines at the strongest critical speeds, with the order above those that have room."""
    low, high = over.speeds[0], over.speeds[-1]
    taken: list[float] = []
    for each in over.critical[:12]:
        axes.axvline(each.speed_rad_s, color="#8a8a8a", linestyle=":", linewidth=0.8)
        place = (each.speed_rad_s - low) / (high - low)
        if all(abs(place - other) > 0.04 for other in taken) and 0.02 < place < 0.98:
            taken.append(place)
            axes.text(
                each.speed_rad_s, 1.02, str(each.order), size=SMALL, ha="center", va="bottom",
                transform=axes.get_xaxis_transform(),
            )  # fmt: skip


def draw_waterfall(over: OverSpeeds) -> Figure:
    """The spectrum at every speed, a panel for each link, and the orders of the modes."""
    scene, links = over.scene, list(over.points[0].swings)
    entries: list[tuple[Artist, str]] = [
        (Line2D([], [], color=SHOWN, linestyle="--"), "order that a mode vibrates at"),
    ]
    shape = Panels(1, len(links), 2.6, 0.48, 0.62, 0.2, between=(0.75, 0.25))
    title = f"Spectrum of the deflection over speed: {scene.name}"
    width = COLUMN_IN if len(links) == 1 else PAGE_IN
    figure, axes = sheet(width, shape, title, entries, notes(scene, LINEAR))
    for panel, name in zip(axes, links, strict=True):
        amplitudes = np.log10(np.maximum(spectra(over, name), SMALLEST))[:, : ORDERS + 1]
        highest = max(min(math.ceil(np.percentile(amplitudes, 99.9)), 0), -5)
        orders = np.arange(amplitudes.shape[1])
        image = panel.pcolormesh(
            orders, over.speeds, amplitudes, shading="nearest", cmap="viridis",
            vmin=math.log10(SMALLEST), vmax=highest, rasterized=True,
        )  # fmt: skip
        _draw_modes(panel, over)
        panel.grid(visible=False)
        panel.set_title(name)
        panel.set_xlim(-0.5, orders[-1] + 0.5)
        panel.set_ylim(over.speeds[0], over.speeds[-1])
        whole_orders(panel, "x", ORDERS)
        panel.set_xlabel(f"order of {scene.driver.link}")
        bar = figure.colorbar(image, cax=panel.inset_axes((1.03, 0.0, 0.04, 1.0)))
        bar.set_label("log₁₀ amplitude / length", size=SMALL)
    axes[0].set_ylabel(f"speed of {scene.driver.link} [rad/s]")
    return figure


def _draw_modes(axes: Axes, over: OverSpeeds) -> None:
    orders = np.array([[each.order for each in point.deviations] for point in over.points])
    for own in orders.T:
        axes.plot(own, over.speeds, color=SHOWN, linestyle="--", linewidth=0.9)
