"""`crankcheck vibration`: vibration of elastic links, at a speed and over speeds."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Generic, TypeVar

import numpy as np
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
from models.errors import CrankcheckError, shown
from models.files.reading import find_scene, load_scene
from models.scene import Scene
from reports.figures.layout import Layout, laid_out
from reports.lectures.machine import vibration_tables as files
from reports.lectures.machine.vibration_tables import show_map, show_speeds, show_vibration
from reports.output.console import say_whole
from reports.output.formats import csv
from reports.output.write import check_folder, write
from reports.requests.options import SceneName, option

if TYPE_CHECKING:
    from reports.figures.style import FigureSet

MOST_COUNT = 5000
"""Number of speeds, or of speeds times factors, beyond which it takes minutes."""
RATIOS, COUNT = (12.5, 2.5), 101
"""Default of --map: the frequency ratios of the extreme speeds, and the number of speeds."""
FACTORS, RANGE = "0.1:10:9", "FROM:TO:COUNT"
MOST_RATIO = 1e4
"""Frequency ratio above which a turn has more vibrations than windows follow."""
ONE, MANY = 5, 3
"""Modes across each link, at one speed and at many: three give the deflection to 1e-3 of itself."""

Found = TypeVar("Found")


@dataclass(frozen=True)
class Files(Generic[Found]):
    """Printed form and files of a result: texts and tables by file, and figures by the name of
    their set in `vibration_figures`, whose import waits until they are needed."""

    show: Callable[[Console, Found], None]
    contents: Mapping[str, Callable[[Found], Any]]
    set_name: str

    @property
    def figures(self) -> FigureSet[Any]:
        from reports.lectures.machine import vibration_figures

        found: FigureSet[Any] = vars(vibration_figures)[self.set_name]
        return found


AT_A_SPEED = Files[SteadyVibration](
    show_vibration,
    {
        "vibration.json": files.vibration_document,
        "turn.csv": files.turn_columns,
        "natural.csv": files.natural_columns,
        "spectrum.csv": files.spectrum_columns,
    },
    "AT_A_SPEED",
)
OVER_SPEEDS = Files[OverSpeeds](
    show_speeds,
    {
        "speeds.json": files.speeds_document,
        "speeds.csv": files.speeds_rows,
        "waterfall.csv": files.waterfall_rows,
        "critical.csv": files.critical_columns,
    },
    "OVER_SPEEDS",
)
OVER_INERTIA = Files[InertiaMap](
    show_map, {"map.json": files.map_document, "map.csv": files.map_rows}, "OVER_INERTIA"
)


@dataclass(frozen=True)
class VibrationRequest(Layout):
    """Arguments of `vibration`, as given."""

    scene: SceneName
    speeds: Annotated[
        str | None, option("Over speeds of the driver [rad/s], such as 5:40:200.", RANGE)
    ] = None
    map_link: Annotated[
        str | None,
        option(
            "Over speeds and over the inertia of a rigid link or of a slider's block.",
            "--map LINK",
        ),
    ] = None
    factors: Annotated[
        str | None,
        option("With --map: how many times as heavy (default 0.1:10:9, in equal ratios).", RANGE),
    ] = None
    modes: Annotated[
        int | None, option("Modes of each link (default 5, over speeds 3).", min=1, max=40)
    ] = None
    output: Annotated[Path | None, option("Write tables, JSON and figures.", "-o --output DIR")] = (
        None
    )

    @laid_out
    def run(self, console: Console, progress: Console) -> int:
        """Show or write a vibration. Raises CrankcheckError for a faulty request, and where there
        is no periodic motion."""
        scene = load_scene(self.scene)
        check_vibrates(scene)
        one = self.map_link is None and self.speeds is None
        across = self.modes or (ONE if one else MANY)
        by = Modes(across, min(across, Modes().along))
        if self.factors is not None and self.map_link is None:
            raise CrankcheckError("--factors: factors of the inertia of a link; give --map LINK")
        if self.map_link is not None:
            link = self.map_link
            _answer(self, OVER_INERTIA, lambda: _over_inertia(self, link, scene, by), console)
        elif self.speeds is not None:
            _answer(self, OVER_SPEEDS, lambda: _over_speeds(self, scene, by), console)
        else:
            _answer(self, AT_A_SPEED, lambda: steady_vibration(scene, by), console)
        return 0


def _over_speeds(request: VibrationRequest, scene: Scene, by: Modes) -> OverSpeeds:
    speeds = _asked_speeds(scene, request.speeds)
    _refuse_many(len(speeds), "--speeds")
    return over_speeds(scene, by, speeds)


def _over_inertia(request: VibrationRequest, link: str, scene: Scene, by: Modes) -> InertiaMap:
    low, high, count = asked_range(request.factors or FACTORS, "--factors", "0.1:10:9")
    factors = np.geomspace(low, high, count)
    with_inertia(scene, link, 1.0)  # or refused
    speeds = _asked_speeds(scene, request.speeds)
    _refuse_many(len(speeds) * len(factors), "--speeds and --factors")
    return over_inertia(scene, by, speeds, link, factors)


def _asked_speeds(scene: Scene, text: str | None) -> Array:
    if text is None:
        low, high = (lowest_rad_s(scene) / ratio for ratio in RATIOS)
        return np.linspace(low, high, COUNT)
    low, high, count = asked_range(text, "--speeds", "5:40:200")
    slowest = lowest_rad_s(scene) / MOST_RATIO
    if low < slowest:
        raise CrankcheckError(
            f"--speeds: found {low:g} rad/s; the lowest natural frequency of a link is over "
            f"{MOST_RATIO:g} times that: links do not vibrate; start at {slowest:.2g} or more"
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
        raise CrankcheckError(f"{option}: found {shown(text)}; write {RANGE} like {example}")
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


def _answer(
    request: VibrationRequest, wanted: Files[Found], find: Callable[[], Found], console: Console
) -> None:
    """Find and show a result, and write its tables and figures into a folder, where one is named.
    Raises CrankcheckError for a folder that can not be written."""
    folder, files = request.output, list(wanted.contents)
    if folder is not None:
        files += wanted.figures.files
        check_folder(folder, "-o", files, inputs=[find_scene(request.scene)])
    found = find()
    wanted.show(console, found)
    if folder is None:
        return
    import pandas as pd

    for name, content_of in wanted.contents.items():
        content = content_of(found)
        is_text = isinstance(content, str)
        write(folder / name, content if is_text else csv(pd.DataFrame(content)))
    wanted.figures.written(found, folder)
    say_whole(console, f"{folder}: {', '.join(files)}")
