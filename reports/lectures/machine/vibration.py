"""`crankcheck vibration`: vibration of elastic links, at a speed and over speeds."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Generic, TypeVar

import numpy as np
import typer
from rich.console import Console

from analytic.elastic.discretisation import Modes
from analytic.elastic.natural import lowest_rad_s
from analytic.lectures.vibration.over_speeds import (
    InertiaMap,
    OverSpeeds,
    over_inertia,
    over_speeds,
    with_inertia,
)
from analytic.lectures.vibration.steady_vibration import (
    SteadyVibration,
    check_vibrates,
    steady_vibration,
)
from models.array import Array
from models.errors import CrankcheckError, harmless, shown
from models.files.reading import find_scene, load_scene
from models.scene import Scene
from reports.lectures.machine import vibration_tables as files
from reports.lectures.machine.vibration_tables import show_map, show_speeds, show_vibration
from reports.output.formats import csv
from reports.output.write import check_folder, write
from reports.requests.options import SceneName

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST_COUNT = 5000
"""Number of speeds, or of speeds times factors, beyond which it takes minutes."""
RATIOS, COUNT = (12.5, 2.5), 101
"""Default of --map: the frequency ratios of the extreme speeds, and the number of speeds."""
FACTORS = "0.1:10:9"
MOST_RATIO = 1e4
"""Frequency ratio above which a turn has more vibrations than windows follow."""
ONE, MANY = 5, 3
"""Modes across each link, at one speed and at many: three give the deflection to 1e-3 of itself."""

Found = TypeVar("Found")


@dataclass(frozen=True)
class Files(Generic[Found]):
    """Files of a result: texts by file, and ``figures``, with a function of ``draws`` for each,
    whose imports wait until then."""

    texts: Mapping[str, Callable[[Found], str]]
    figures: Sequence[str]
    draws: Callable[[], Sequence[Callable[[Found], Figure]]]


def _over_turn() -> Sequence[Callable[[SteadyVibration], Figure]]:
    from reports.lectures.machine import vibration_figures

    return vibration_figures.draw_over_turn, vibration_figures.draw_spectrum


def _over_speed() -> Sequence[Callable[[OverSpeeds], Figure]]:
    from reports.lectures.machine import vibration_figures

    return vibration_figures.draw_over_speed, vibration_figures.draw_waterfall


def _over_inertia() -> Sequence[Callable[[InertiaMap], Figure]]:
    from reports.lectures.machine import vibration_figures

    return (vibration_figures.draw_over_inertia,)


AT_A_SPEED = Files[SteadyVibration](
    {
        "vibration.json": files.vibration_document,
        "turn.csv": lambda found: csv(files.turn_frame(found)),
        "natural.csv": lambda found: csv(files.natural_frame(found)),
        "spectrum.csv": lambda found: csv(files.spectrum_frame(found)),
    },
    ("deflection", "spectrum"),
    _over_turn,
)
OVER_SPEEDS = Files[OverSpeeds](
    {
        "speeds.json": files.speeds_document,
        "speeds.csv": lambda found: csv(files.speeds_frame(found)),
        "waterfall.csv": lambda found: csv(files.waterfall_frame(found)),
        "critical.csv": lambda found: csv(files.critical_frame(found)),
    },
    ("speeds", "waterfall"),
    _over_speed,
)
OVER_INERTIA = Files[InertiaMap](
    {
        "map.json": files.map_document,
        "map.csv": lambda found: csv(files.map_frame(found)),
    },
    ("map",),
    _over_inertia,
)


@dataclass(frozen=True)
class VibrationRequest:
    """Arguments of `vibration`, as given."""

    scene: SceneName
    speeds: Annotated[
        str | None,
        typer.Option(
            metavar="FROM:TO:COUNT", help="Over speeds of the driver [rad/s], such as 5:40:200."
        ),
    ] = None
    map_link: Annotated[
        str | None,
        typer.Option(
            "--map",
            metavar="LINK",
            help="Over speeds and over the inertia of a rigid link or of a slider's block.",
        ),
    ] = None
    factors: Annotated[
        str | None,
        typer.Option(
            metavar="FROM:TO:COUNT",
            help="With --map: how many times as heavy (default 0.1:10:9, in equal ratios).",
        ),
    ] = None
    modes: Annotated[
        int | None,
        typer.Option(min=1, max=40, help="Modes of each link (default 5, over speeds 3)."),
    ] = None
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="DIR", help="Write tables, JSON and figures."),
    ] = None

    def run(self, console: Console, progress: Console) -> int:
        """Show or write a vibration. Raises CrankcheckError for a faulty request, and where there
        is no periodic motion."""
        scene = load_scene(self.scene)
        check_vibrates(scene)
        one = self.map_link is None and self.speeds is None
        by = _modes(self.modes or (ONE if one else MANY))
        if self.factors is not None and self.map_link is None:
            raise CrankcheckError("--factors: they are of the inertia of a link; give --map LINK")
        if self.map_link is not None:
            _map(self, scene, by, self.map_link, console)
        elif self.speeds is not None:
            _speeds(self, scene, by, console)
        else:
            _vibration(self, scene, by, console)
        return 0


def _modes(across: int) -> Modes:
    return Modes(across, min(across, Modes().along))


def _vibration(request: VibrationRequest, scene: Scene, by: Modes, console: Console) -> None:
    """Show and write the vibration at the speed of the scene."""
    _check(request, AT_A_SPEED)
    found: SteadyVibration = steady_vibration(scene, by)
    show_vibration(console, found)
    _write(request, AT_A_SPEED, found, console, scene)


def _speeds(request: VibrationRequest, scene: Scene, by: Modes, console: Console) -> None:
    """Show and write the vibration over speeds."""
    _check(request, OVER_SPEEDS)
    speeds = _asked_speeds(scene, request.speeds)
    _refuse_many(len(speeds), "--speeds")
    found: OverSpeeds = over_speeds(scene, by, speeds)
    show_speeds(console, found)
    _write(request, OVER_SPEEDS, found, console, scene)


def _map(request: VibrationRequest, scene: Scene, by: Modes, link: str, console: Console) -> None:
    """Show and write the vibration over speeds and inertia."""
    _check(request, OVER_INERTIA)
    low, high, count = asked_range(request.factors or FACTORS, "--factors", "0.1:10:9")
    factors = np.geomspace(low, high, count)
    with_inertia(scene, link, 1.0)  # or refused
    speeds = _asked_speeds(scene, request.speeds)
    _refuse_many(len(speeds) * len(factors), "--speeds and --factors")
    found: InertiaMap = over_inertia(scene, by, speeds, link, factors)
    show_map(console, found)
    _write(request, OVER_INERTIA, found, console, scene)


def _asked_speeds(scene: Scene, text: str | None) -> Array:
    """The requested speeds, or speeds by frequency ratios."""
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
    """Parse FROM:TO:COUNT. Raises CrankcheckError for other text."""
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


def _check(request: VibrationRequest, written: Files[Found]) -> None:
    """Refuse a folder that can not be written. Raises CrankcheckError."""
    if request.output is not None:
        drawn = [f"{name}.{kind}" for name in written.figures for kind in ("svg", "pdf")]
        inputs = [find_scene(request.scene)]
        check_folder(request.output, "-o", [*written.texts, *drawn], inputs=inputs)


def _write(
    request: VibrationRequest, written: Files[Found], found: Found, console: Console, scene: Scene
) -> None:
    """Write tables and figures into a folder, where one was named."""
    folder = request.output
    if folder is None:
        return
    from reports.lectures.machine.vibration_figures import VibrationDrawing, write_figures

    for name, text in written.texts.items():
        write(folder / name, text(found))
    drawings = [
        VibrationDrawing(name, partial(draw, found))
        for name, draw in zip(written.figures, written.draws(), strict=True)
    ]
    figures = write_figures(folder, drawings, scene.name)
    told = f"{folder}: {', '.join((*written.texts, *figures))}"
    console.print(harmless(told), highlight=False, markup=False, soft_wrap=True)
