"""Figures of vibration at a speed, over speeds and over inertia, and the notes under them."""

import itertools
import math
from collections.abc import Iterable
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator
from numpy.typing import ArrayLike

from analytic.lectures.vibration.floquet import STABLE
from analytic.lectures.vibration.over_speeds import InertiaMap, OverSpeeds, spectra
from analytic.lectures.vibration.steady_vibration import SteadyVibration
from models.array import Array
from models.scene import Scene
from reports.figures.sheet import SIDES, Panels, columns_of, sheet, spaced
from reports.figures.style import COLUMN_IN, PAGE_IN, SMALL, FigureSet, logarithmic
from reports.lectures.machine.vibration_rows import unstable_speeds
from reports.output.write import crankcheck_version

COLOURS = ("#1f5f9e", "#c04a1d", "#2f7d4c", "#7a4d9e")
"""Colours of the links, one after the other."""
ORDERS = 24
"""Largest number of drawn orders."""
SMALLEST = 1e-7
"""Smallest drawn amplitude over the length."""


def notes(scene: Scene, said: str) -> list[str]:
    """The notes under a figure."""
    links = ", ".join(scene.elastic)
    return [f"crankcheck {crankcheck_version()}; elastic: {links}; {said}."]


def _coloured(links: Iterable[str]) -> dict[str, str]:
    return dict(zip(links, itertools.cycle(COLOURS), strict=False))


def _entry(words: str, **look: Any) -> tuple[Artist, str]:
    return Line2D([], [], **look), words


def _mark_orders(axes: Axes, scene: Scene) -> None:
    axes.xaxis.set_major_locator(MaxNLocator(nbins=12, integer=True))
    axes.set_xlabel(f"order of {scene.driver.link}")


def _field(axes: Axes, x: ArrayLike, y: Array, values: Array, **look: Any) -> QuadMesh:
    """Draw the values at places of a grid as colours."""
    axes.grid(visible=False)
    return axes.pcolormesh(x, y, values, shading="nearest", rasterized=True, **look)


def _add_scale(figure: Figure, axes: Axes, field: QuadMesh, words: str) -> None:
    """Draw the scale of a field's colours on its right."""
    bar = figure.colorbar(field, cax=axes.inset_axes((1.03, 0.0, 0.04, 1.0)))
    bar.set_label(f"log₁₀ {words}", size=SMALL)


SHOWN = "#b8860b"
UNSTABLE = "#c0392b"
LINEAR = "linear in the deflection, about the rigid motion, with the stiffening by tension"


def draw_over_speed(over: OverSpeeds) -> Figure:
    """Draw the largest deflection of each link, and below it the largest multiplier."""
    scene, colours = over.scene, _coloured(over.points[0].swings)
    entries = [
        _entry(f"{name}, largest over length", color=colour) for name, colour in colours.items()
    ]
    entries.append(_entry("critical speed, with order", color="#8a8a8a", linestyle=":"))
    if unstable_speeds(over):
        entries.append(_entry("unstable", color=UNSTABLE, linewidth=3.0, alpha=0.4))
    shape = Panels(2, 1, 1.6, *SIDES, 0.2, between=(0, 0.12))
    title = f"Vibration over speed: {scene.name}"
    figure, (upper, lower) = sheet(COLUMN_IN, shape, title, entries, notes(scene, LINEAR))
    everything = []
    for name, colour in colours.items():
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
    """Draw dotted lines at the strongest critical speeds, with the order where it has room."""
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
    """Draw the spectrum at every speed, a panel for each link, and the orders of the modes."""
    scene, links = over.scene, list(over.points[0].swings)
    entries = [_entry("order that a mode vibrates at", color=SHOWN, linestyle="--")]
    shape = Panels(1, len(links), 2.6, 0.48, 0.62, 0.2, between=(0.75, 0.25))
    title = f"Spectrum of the deflection over speed: {scene.name}"
    width = COLUMN_IN if len(links) == 1 else PAGE_IN
    figure, axes = sheet(width, shape, title, entries, notes(scene, LINEAR))
    for panel, name in zip(axes, links, strict=True):
        amplitudes = np.log10(np.maximum(spectra(over, name), SMALLEST))[:, : ORDERS + 1]
        highest = max(min(math.ceil(np.percentile(amplitudes, 99.9)), 0), -5)
        orders = np.arange(amplitudes.shape[1])
        look = {"cmap": "viridis", "vmin": math.log10(SMALLEST), "vmax": highest}
        field = _field(panel, orders, over.speeds, amplitudes, **look)
        of_modes = np.array([[each.order for each in point.deviations] for point in over.points])
        for own in of_modes.T:
            panel.plot(own, over.speeds, color=SHOWN, linestyle="--", linewidth=0.9)
        panel.set_title(name)
        panel.set_xlim(-0.5, orders[-1] + 0.5)
        panel.set_ylim(over.speeds[0], over.speeds[-1])
        _mark_orders(panel, scene)
        _add_scale(figure, panel, field, "amplitude / length")
    axes[0].set_ylabel(f"speed of {scene.driver.link} [rad/s]")
    return figure


LOWEST, HIGHEST = -5.0, 0.0
"""Decades of the deflection over the length that have separate colours."""
MOST_GROWTH = 3.0
"""Decades of a turn's growth that have separate colours."""


def draw_over_inertia(found: InertiaMap) -> Figure:
    """Draw the deflection on the left, multipliers on the right."""
    scene, driver = found.scene, found.scene.driver.link
    entries = [_entry("deviations do not grow", color="#eeeeee", marker="s", linestyle="")]
    columns = columns_of(4, 4) // 2 or 1  # each with its scale beside
    shape = Panels(2 // columns, columns, 2.5, 0.55, 0.62, 0.2, between=(1.15, 0.5))
    title = f"Vibration over speed and inertia of {found.link}: {scene.name}"
    figure, (left, right) = sheet(PAGE_IN, shape, title, entries, notes(scene, LINEAR))
    ratios = np.array([point.ratio for point in found.over[0].points])
    height = np.log10(found.factors)
    shares = np.log10(np.clip(found.shares, 10.0**LOWEST, 10.0**HIGHEST))
    low, high = math.floor(shares.min()), math.ceil(shares.max())
    look = {"cmap": "viridis", "vmin": low, "vmax": max(high, low + 1)}
    drawn = _field(left, ratios, height, shares, **look)
    growth = np.log10(np.maximum(found.multipliers, 1.0))
    growth = np.where(found.multipliers > 1.0 + STABLE, growth, np.nan)
    _field(right, ratios, height, np.zeros_like(shares), cmap=ListedColormap(["#eeeeee"]))
    grown = _field(right, ratios, height, growth, cmap="YlOrRd", vmin=0.0, vmax=MOST_GROWTH)
    scales = ((left, drawn, "largest deflection / length"), (right, grown, "growth in a turn"))
    for panel, field, words in scales:
        panel.set_xlim(ratios.min(), ratios.max())
        panel.set_ylim(height.min(), height.max())
        ticks = found.factors[:: max(1, len(found.factors) // 5)]
        panel.set_yticks(np.log10(ticks), [f"{tick:.3g}" for tick in ticks])
        panel.set_xlabel(f"lowest natural frequency / speed of {driver}")
        panel.set_ylabel(f"{found.link}, times its inertia")
        _add_scale(figure, panel, field, words)
    return figure


FINE = 361
"""Number of points of a curve."""
LOOKS = {"": "-", "linear": (0, (1.0, 1.2)), "linear, not stiffened": (0, (4.0, 1.5))}


def draw_over_turn(vibration: SteadyVibration) -> Figure:
    """Draw the deflection of the middle over the driver's angle, a panel for each link."""
    scene = vibration.scene
    entries = [
        _entry(name or "unlinearised", color="#1a1a1a", linestyle=look)
        for name, look in LOOKS.items()
    ]
    shape = Panels(len(vibration.swings), 1, 1.7, *SIDES, 0.17, between=(0, 0.25))
    said = notes(scene, f"{scene.driver.link} at {vibration.speed_rad_s:.5g} rad/s")
    title = f"Deflection over a turn: {scene.name}"
    figure, axes = sheet(COLUMN_IN, shape, title, entries, said)
    law = scene.driver.law
    turn = np.linspace(0.0, 1.0, FINE)
    degrees = np.degrees(law.at(turn * law.period_s)[0])
    colours = _coloured(vibration.swings)
    for panel, (name, own) in zip(axes, vibration.swings.items(), strict=True):
        for theory, look in LOOKS.items():
            swing = vibration.theories[theory][name] if theory else own
            curve = 1e3 * between(swing.series, turn)
            panel.plot(degrees, curve, color=colours[name], linestyle=look, linewidth=1.0)
        panel.set_ylabel(f"{name} {'middle' if own.bends else 'extension'} [mm]")
        panel.set_xlim(*sorted(degrees[[0, -1]]))
        spaced(panel, 60.0)
        panel.tick_params(labelbottom=panel is axes[-1])
    axes[-1].set_xlabel(f"angle of {scene.driver.link} [deg]")
    return figure


def draw_spectrum(vibration: SteadyVibration) -> Figure:
    """Draw amplitudes over the length at orders of the driver, and the orders of the modes."""
    scene, colours = vibration.scene, _coloured(vibration.swings)
    entries = [
        _entry(link, color=colour, marker="o", markersize=3, linestyle="-")
        for link, colour in colours.items()
    ]
    shown = [d for d in vibration.stability.deviations if d.order <= ORDERS]
    if shown:
        entries.append(_entry("modes of the mechanism", color="#8a8a8a", linestyle=":"))
    said = notes(scene, f"{scene.driver.link} at {vibration.speed_rad_s:.5g} rad/s")
    title = f"Spectrum of the deflection: {scene.name}"
    figure, (panel,) = sheet(COLUMN_IN, Panels(1, 1, 2.0, *SIDES, 0.08), title, entries, said)
    tops = []
    for k, (link, colour) in enumerate(colours.items()):
        own = vibration.swings[link]
        orders = np.arange(min(ORDERS + 1, len(own.amplitudes)))
        orders = orders[own.amplitudes[orders] > SMALLEST * own.length_m]
        heights = own.amplitudes[orders] / own.length_m
        shift = 0.18 * (k - 0.5 * (len(colours) - 1))
        panel.vlines(orders + shift, SMALLEST, heights, color=colour, linewidth=1.2)
        panel.plot(orders + shift, heights, color=colour, marker="o", markersize=2.4, linestyle="")
        tops.append(heights.max(initial=SMALLEST))
    for deviation in shown:
        panel.axvline(deviation.order, color="#8a8a8a", linestyle=":", linewidth=0.9)
    logarithmic(panel, "y", SMALLEST, max(3.0 * max(tops), 1e2 * SMALLEST))
    panel.set_xlim(-0.7, ORDERS + 0.7)
    _mark_orders(panel, scene)
    panel.set_ylabel("amplitude / length")
    return figure


def between(series: Array, shares: Array) -> Array:
    """A periodic series (N,) at shares of the period (T,)."""
    found = np.fft.rfft(series) / len(series)
    found[1:] *= 2.0
    wave = np.exp(2j * np.pi * np.outer(shares, np.arange(len(found))))
    return np.asarray((wave @ found).real)


AT_A_SPEED = FigureSet[SteadyVibration](
    "", {"deflection": draw_over_turn, "spectrum": draw_spectrum}
)
OVER_SPEEDS = FigureSet[OverSpeeds]("", {"speeds": draw_over_speed, "waterfall": draw_waterfall})
OVER_INERTIA = FigureSet[InertiaMap]("", {"map": draw_over_inertia})
