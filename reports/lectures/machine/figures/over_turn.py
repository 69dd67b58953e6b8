"""The deflection of elastic links over a turn, by the theories, and its spectrum."""

from __future__ import annotations

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MultipleLocator

from analytic.lectures.vibration.steady_vibration import SteadyVibration
from models.array import Array
from reports.figures.sheet import Panels, sheet
from reports.figures.style import COLUMN_IN, logarithmic
from reports.lectures.machine.figures.vibration_figures import (
    COLOURS,
    ORDERS,
    SIDES,
    SMALLEST,
    notes,
    whole_orders,
)

FINE = 361
"""Points of a curve."""
LOOKS = {"": "-", "linear": (0, (1.0, 1.2)), "linear, not stiffened": (0, (4.0, 1.5))}


def draw(vibration: SteadyVibration) -> Figure:
    """Deflection of the middle over the driver's angle, a panel for each link."""
    scene = vibration.scene
    entries: list[tuple[Artist, str]] = [
        (Line2D([], [], color="#1a1a1a", linestyle=look), name or "unlinearised")  # type: ignore[arg-type]  # a pattern of dashes
        for name, look in LOOKS.items()
    ]
    shape = Panels(len(vibration.swings), 1, 1.7, *SIDES, 0.17, between=(0, 0.25))
    said = notes(scene, f"{scene.driver.link} at {vibration.speed_rad_s:.5g} rad/s")
    title = f"Deflection over a turn: {scene.name}"
    figure, axes = sheet(COLUMN_IN, shape, title, entries, said)
    law = scene.driver.law
    turn = np.linspace(0.0, 1.0, FINE)
    degrees = np.degrees(law.at(turn * law.period_s)[0])
    for panel, (name, own), colour in zip(
        axes, vibration.swings.items(), COLOURS * len(axes), strict=False
    ):
        for theory, look in LOOKS.items():
            swing = vibration.theories[theory][name] if theory else own
            curve = 1e3 * between(swing.series, turn)
            panel.plot(degrees, curve, color=colour, linestyle=look, linewidth=1.0)
        panel.set_ylabel(f"{name} {'middle' if own.bends else 'extension'} [mm]")
        panel.set_xlim(*sorted(degrees[[0, -1]]))
        panel.xaxis.set_major_locator(MultipleLocator(60.0))
        panel.tick_params(labelbottom=panel is axes[-1])
    axes[-1].set_xlabel(f"angle of {scene.driver.link} [deg]")
    return figure


def draw_spectrum(vibration: SteadyVibration) -> Figure:
    """Amplitudes over the length at orders of the driver, and the orders of the modes."""
    scene, each = vibration.scene, list(vibration.swings.values())
    entries: list[tuple[Artist, str]] = [
        (Line2D([], [], color=colour, marker="o", markersize=3, linestyle="-"), own.link)
        for own, colour in zip(each, COLOURS * len(each), strict=False)
    ]
    shown = [d for d in vibration.stability.deviations if d.order <= ORDERS]
    if shown:
        entries.append((Line2D([], [], color="#8a8a8a", linestyle=":"), "modes of the mechanism"))
    said = notes(scene, f"{scene.driver.link} at {vibration.speed_rad_s:.5g} rad/s")
    title = f"Spectrum of the deflection: {scene.name}"
    figure, (panel,) = sheet(COLUMN_IN, Panels(1, 1, 2.0, *SIDES, 0.08), title, entries, said)
    tops = []
    for k, (own, colour) in enumerate(zip(each, COLOURS * len(each), strict=False)):
        orders = np.arange(min(ORDERS + 1, len(own.amplitudes)))
        orders = orders[own.amplitudes[orders] > SMALLEST * own.length_m]
        heights = own.amplitudes[orders] / own.length_m
        shift = 0.18 * (k - 0.5 * (len(each) - 1))
        panel.vlines(orders + shift, SMALLEST, heights, color=colour, linewidth=1.2)
        panel.plot(orders + shift, heights, color=colour, marker="o", markersize=2.4, linestyle="")
        tops.append(heights.max(initial=SMALLEST))
    for deviation in shown:
        panel.axvline(deviation.order, color="#8a8a8a", linestyle=":", linewidth=0.9)
    logarithmic(panel, "y", SMALLEST, max(3.0 * max(tops), 1e2 * SMALLEST))
    panel.set_xlim(-0.7, ORDERS + 0.7)
    whole_orders(panel, "x", ORDERS)
    panel.set_xlabel(f"order of {scene.driver.link}")
    panel.set_ylabel("amplitude / length")
    return figure


def between(series: Array, shares: Array) -> Array:
    """What is periodic (N,) at shares of the period (T,)."""
    found = np.fft.rfft(series) / len(series)
    found[1:] *= 2.0
    wave = np.exp(2j * np.pi * np.outer(shares, np.arange(len(found))))
    return np.asarray((wave @ found).real)
