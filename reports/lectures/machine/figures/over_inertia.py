"""The map of deflection and of stability over the frequency ratio and the inertia of a link."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.artist import Artist
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from analytic.lectures.vibration.floquet import STABLE
from analytic.lectures.vibration.over_inertia import InertiaMap
from reports.figures.sheet import Panels, sheet
from reports.figures.style import PAGE_IN, SMALL
from reports.lectures.machine.figures.over_speed import LINEAR
from reports.lectures.machine.figures.vibration_figures import notes

LOWEST, HIGHEST = -5.0, 0.0
"""Decades of the deflection over the length that are told apart."""
MOST_GROWTH = 3.0
"""Decades of a turn's growth that are told apart."""


def draw(found: InertiaMap) -> Figure:
    """Deflection on the left, multipliers on the right."""
    scene, driver = found.scene, found.scene.driver.link
    entries: list[tuple[Artist, str]] = [
        (Line2D([], [], color="#eeeeee", marker="s", linestyle=""), "deviations do not grow"),
    ]
    shape = Panels(1, 2, 2.5, 0.55, 0.62, 0.2, between=(1.15, 0.25))
    title = f"Vibration over speed and inertia of {found.link}: {scene.name}"
    figure, (left, right) = sheet(PAGE_IN, shape, title, entries, notes(scene, LINEAR))
    ratios = np.array([point.ratio for point in found.over[0].points])
    height = np.log10(found.factors)
    shares = np.log10(np.clip(found.shares, 10.0**LOWEST, 10.0**HIGHEST))
    low, high = math.floor(shares.min()), math.ceil(shares.max())
    drawn = left.pcolormesh(
        ratios, height, shares, shading="nearest", cmap="viridis", vmin=low,
        vmax=max(high, low + 1), rasterized=True,
    )  # fmt: skip
    growth = np.log10(np.maximum(found.multipliers, 1.0))
    growth = np.where(found.multipliers > 1.0 + STABLE, growth, np.nan)
    right.pcolormesh(
        ratios, height, np.zeros_like(shares), shading="nearest", cmap=ListedColormap(["#eeeeee"]),
        rasterized=True,
    )  # fmt: skip
    grown = right.pcolormesh(
        ratios, height, growth, shading="nearest", cmap="YlOrRd", vmin=0.0, vmax=MOST_GROWTH,
        rasterized=True,
    )  # fmt: skip
    bars = ((left, drawn, "largest deflection / length"), (right, grown, "growth in a turn"))
    for panel, image, told in bars:
        panel.grid(visible=False)
        panel.set_xlim(ratios.min(), ratios.max())
        panel.set_ylim(height.min(), height.max())
        ticks = found.factors[:: max(1, len(found.factors) // 5)]
        panel.set_yticks(np.log10(ticks), [f"{tick:.3g}" for tick in ticks])
        panel.set_xlabel(f"lowest natural frequency / speed of {driver}")
        panel.set_ylabel(f"{found.link}, times its inertia")
        bar = figure.colorbar(image, cax=panel.inset_axes((1.03, 0.0, 0.04, 1.0)))
        bar.set_label(f"log₁₀ {told}", size=SMALL)
    return figure
