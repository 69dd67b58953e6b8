"""`crankcheck vibration`: how elastic links vibrate, at a speed and over speeds."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from rich.console import Console

from analytic.elastic.discretisation import Modes
from analytic.elastic.natural import lowest_rad_s
from analytic.elastic.over_inertia import InertiaMap, over_inertia, with_inertia
from analytic.elastic.over_speeds import OverSpeeds, over_speeds
from analytic.elastic.steady_vibration import SteadyVibration, check_vibrates, steady_vibration
from models.array import Array
from models.errors import CrankcheckError, harmless, shown
from models.files import find_scene, load_scene
from models.scene import Scene
from reports.cli.vibrating import VibrationRequest
from reports.output.frame_file import csv
from reports.output.write import check_folder, write
from reports.vibration import vibration_files as files
from reports.vibration.vibration_tables import show_map, show_speeds, show_vibration

if TYPE_CHECKING:
    from reports.figures.vibration.vibration_figures import Drawing

MOST_COUNT = 5000
"""Speeds, or speeds times factors, beyond which it takes minutes."""
RATIOS, COUNT = (12.5, 2.5), 101
"""With --map alone: frequency ratios that speeds are between, and how many."""
FACTORS = "0.1:10:9"
MOST_RATIO = 1e4
"""A frequency ratio from which on a turn holds more vibrations than windows follow."""
ONE, MANY = 5, 3
"""Modes across each link, at one speed and at many: three give the deflection to 1e-3 of itself."""

Written = Mapping[str, Callable[[], str]]


def run_vibration(request: VibrationRequest, console: Console) -> int:
    """Show or write a vibration. Raises CrankcheckError for what can not be asked, and where there
    is no periodic motion."""
    scene = load_scene(request.scene)
    check_vibrates(scene)
    one = request.map_link is None and request.speeds is None
    by = _modes(request.modes or (ONE if one else MANY))
    if request.factors is not None and request.map_link is None:
        raise CrankcheckError("--factors: they are of the inertia of a link; give --map LINK")
    if request.map_link is not None:
        _map(request, scene, by, request.map_link, console)
    elif request.speeds is not None:
        _speeds(request, scene, by, console)
    else:
        _vibration(request, scene, by, console)
    return 0


def _modes(across: int) -> Modes:
    return Modes(across, min(across, Modes().along))


def _vibration(request: VibrationRequest, scene: Scene, by: Modes, console: Console) -> None:
    """At the speed of the scene."""
    names = ("vibration.json", "turn.csv", "natural.csv", "spectrum.csv")
    _check(request, (*names, *_drawn("deflection", "spectrum")))
    found: SteadyVibration = steady_vibration(scene, by)
    show_vibration(console, found)
    contents = (
        lambda: files.vibration_document(found),
        lambda: csv(files.turn_frame(found)),
        lambda: csv(files.natural_frame(found)),
        lambda: csv(files.spectrum_frame(found)),
    )
    if request.output is not None:
        from reports.figures.vibration import over_turn
        from reports.figures.vibration.vibration_figures import Drawing

        drawings = (
            Drawing("deflection", lambda: over_turn.draw(found)),
            Drawing("spectrum", lambda: over_turn.draw_spectrum(found)),
        )
        _write(request.output, dict(zip(names, contents, strict=True)), drawings, console, scene)


def _speeds(request: VibrationRequest, scene: Scene, by: Modes, console: Console) -> None:
    """Over speeds."""
    names = ("speeds.json", "speeds.csv", "waterfall.csv", "critical.csv")
    _check(request, (*names, *_drawn("speeds", "waterfall")))
    speeds = _asked_speeds(scene, request.speeds)
    _refuse_many(len(speeds), "--speeds")
    found: OverSpeeds = over_speeds(scene, by, speeds)
    show_speeds(console, found)
    contents = (
        lambda: files.speeds_document(found),
        lambda: csv(files.speeds_frame(found)),
        lambda: csv(files.waterfall_frame(found)),
        lambda: csv(files.critical_frame(found)),
    )
    if request.output is not None:
        from reports.figures.vibration import over_speed
        from reports.figures.vibration.vibration_figures import Drawing

        drawings = (
            Drawing("speeds", lambda: over_speed.draw(found)),
            Drawing("waterfall", lambda: over_speed.draw_waterfall(found)),
        )
        _write(request.output, dict(zip(names, contents, strict=True)), drawings, console, scene)


def _map(request: VibrationRequest, scene: Scene, by: Modes, link: str, console: Console) -> None:
    """Over speeds and inertia."""
    names = ("map.json", "map.csv")
    _check(request, (*names, *_drawn("map")))
    low, high, count = asked_range(request.factors or FACTORS, "--factors", "0.1:10:9")
    factors = np.geomspace(low, high, count)
    with_inertia(scene, link, 1.0)  # or refused
    speeds = _asked_speeds(scene, request.speeds)
    _refuse_many(len(speeds) * len(factors), "--speeds and --factors")
    found: InertiaMap = over_inertia(scene, by, speeds, link, factors)
    show_map(console, found)
    contents = (lambda: files.map_document(found), lambda: csv(files.map_frame(found)))
    if request.output is not None:
        from reports.figures.vibration import over_inertia as figure
        from reports.figures.vibration.vibration_figures import Drawing

        drawings = (Drawing("map", lambda: figure.draw(found)),)
        _write(request.output, dict(zip(names, contents, strict=True)), drawings, console, scene)


def _asked_speeds(scene: Scene, text: str | None) -> Array:
    """Speeds as they are asked for, or by frequency ratios."""
    if text is None:
        low, high = (lowest_rad_s(scene) / ratio for ratio in RATIOS)
        return np.linspace(low, high, COUNT)
    low, high, count = asked_range(text, "--speeds", "5:40:200")
    slowest = lowest_rad_s(scene) / MOST_RATIO
    if low < slowest:
        raise CrankcheckError(
            f"--speeds: found {low:g} rad/s, which the lowest natural frequency of a link is over "
            f"{MOST_RATIO:g} times of: links do not vibrate there; start at {slowest:.2g} or more"
        )
    return np.linspace(low, high, count)


def asked_range(text: str, option: str, example: str) -> tuple[float, float, int]:
    """FROM:TO:COUNT as numbers. Raises CrankcheckError for what is none."""
    parts = text.split(":")
    try:
        low, high, count = float(parts[0]), float(parts[1]), int(parts[2])
        whole = len(parts) == 3 and math.isfinite(low) and math.isfinite(high)
    except (ValueError, IndexError):
        whole = False
    if not whole:
        raise CrankcheckError(f"{option}: found {shown(text)}; write FROM:TO:COUNT like {example}")
    if not 0.0 < low < high:
        raise CrankcheckError(
            f"{option}: found {low:g} to {high:g}; give two numbers above 0, the smaller first"
        )
    if count < 2:
        raise CrankcheckError(f"{option}: found a count of {count}; give 2 or more")
    return low, high, count


def _refuse_many(count: int, option: str) -> None:
    if count > MOST_COUNT:
        raise CrankcheckError(f"{option}: found {count} points; give {MOST_COUNT} or fewer")


def _drawn(*names: str) -> list[str]:
    """The files of figures, without loading what draws them."""
    return [f"{name}.{kind}" for name in names for kind in ("svg", "pdf")]


def _check(request: VibrationRequest, names: tuple[str, ...]) -> None:
    if request.output is not None:
        check_folder(request.output, "-o", names, inputs=[find_scene(request.scene)])


def _write(
    folder: Path, texts: Written, drawings: tuple[Drawing, ...], console: Console, scene: Scene
) -> None:
    """Tables and figures into a folder."""
    from reports.figures.vibration.vibration_figures import write_figures

    for name, text in texts.items():
        write(folder / name, text())
    figures = write_figures(folder, drawings, scene.name)
    told = f"{folder}: {', '.join((*texts, *figures))}"
    console.print(harmless(told), highlight=False, markup=False, soft_wrap=True)
