"""`crankcheck polygon`: the vector polygons of a position."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import numpy as np
from rich.console import Console

from analytic.lectures.drawings import drawn_polygons
from analytic.lectures.drawings.polygon import UNITS, PlacedMechanism
from analytic.structure.mobility import analyse, refuse_other_than_cranked
from models.array import Array
from models.errors import CrankcheckError
from models.files.reading import find_scene, load_scene
from models.scene import Scene
from reports.lectures.drawing.sheet_requests import LogMap
from reports.lectures.drawing.sheets import polygon_instant, polygon_table
from reports.lectures.drawing.sheets.graph_drawing import SheetLog
from reports.lectures.drawing.sheets.paper import Paper, of_elastic
from reports.lectures.drawing.sheets.polygon_on_paper import DrawnPolygon
from reports.lectures.drawing.sheets.polygon_page import (
    ANIMATED,
    ENDINGS,
    PAGE,
    PolygonCourse,
    polygon_file,
    polygon_page,
    turning_file,
)
from reports.lectures.drawing.sheets.polygon_sheet import PolygonSheet, laid_out
from reports.logs.map_file import Map, read_map
from reports.output.console import grid, say_whole
from reports.output.numbers import readable
from reports.output.write import check_file, write
from reports.requests.options import PaperSize, SceneName, option, output_option, seconds


def show_polygons(console: Console, sheet: PolygonSheet) -> None:
    """Print both polygons, step by step, the rates of the links, and their images."""
    say_whole(console, _heading(sheet))
    for drawn in (sheet.velocity, sheet.acceleration):
        quantity, unit = drawn.polygon.quantity, UNITS[drawn.polygon.quantity]
        say_whole(console, f"\n{quantity} polygon, {readable(drawn.scale)} {unit} to the mm")
        heads = ("vector", f"{unit}:", "mm:", "towards deg:", "found")
        console.print(grid(heads, _vector_rows(drawn), cut=heads, wraps=True))
        if drawn.polygon.largest == 0.0:
            say_whole(console, polygon_table.at_rest(quantity))
        _show_log(console, drawn)
    _show_links(console, sheet)
    say_whole(console, *polygon_table.doubts(sheet.drawn))


def _heading(sheet: PolygonSheet) -> str:
    placement, log = sheet.drawn.placement, sheet.log
    scene, driver = placement.scene, placement.driver
    at_time = f", t = {sheet.time_s:.9g} s" if sheet.time_s is not None else ""
    at_time += f" in {log.source}{log.taken}" if log is not None else ""
    alpha = f", {driver.alpha:g} rad/s^2" if driver.alpha else ""
    rigid = of_elastic(scene, "; its elastic links are taken as rigid")
    return (
        f"{scene.name}: {scene.driver.link} at {round(math.degrees(driver.theta), 9) % 360.0:g} deg"
        f"{at_time}, {driver.omega:g} rad/s{alpha}{rigid}"
    )


def _vector_rows(drawn: DrawnPolygon) -> Iterator[tuple[str, ...]]:
    for vector in drawn.polygon.vectors:
        size = drawn.size_of(vector)
        towards = _towards(vector.value if size else np.zeros(2))
        found = f"by crossing, {vector.direction}" if vector.direction else "known"
        yield vector.name, *_sizes(size, drawn), towards, found


def _sizes(size: float, drawn: DrawnPolygon) -> tuple[str, str]:
    """A length in its unit, and on paper [mm]."""
    return f"{size:.7g}", f"{size / drawn.scale:.2f}"


def _towards(vector: Array) -> str:
    """The angle of a vector [deg]; "-" for a zero vector."""
    x, y = vector
    return f"{math.degrees(math.atan2(y, x)):.3f}" if np.any(vector) else "-"


def _show_log(console: Console, drawn: DrawnPolygon) -> None:
    if drawn.logged is None:
        return
    unit = UNITS[drawn.polygon.quantity]
    if not drawn.logged.errors:
        say_whole(console, f"\nno {drawn.polygon.quantity} of any point in the log")
        return
    say_whole(console, f"\n{drawn.logged_by}: {drawn.logged.words} on the sheet")
    numbers = (unit, "mm", f"logged {unit}", "mm", f"error {unit}", "mm", "towards deg")
    heads = ("point", *(f"{head}:" for head in numbers))
    rows = []
    for name, size, own, error in drawn.logged_sizes():
        off, sizes = float(np.hypot(*error)), (*_sizes(size, drawn), *_sizes(own, drawn))
        rows.append((name, *sizes, readable(off * drawn.scale), readable(off), _towards(error)))
    console.print(grid(heads, rows, cut=heads, wraps=True))


def _show_links(console: Console, sheet: PolygonSheet) -> None:
    drawn, links = sheet.drawn, polygon_table.drawn_links(sheet.drawn)
    rates = (
        (name, *(f"{rate:.7g}" for rate in drawn_polygons.link_rates(drawn, name)))
        for name in links
    )
    heads = ("link", "omega rad/s:", "alpha rad/s^2:")
    console.print("", grid(heads, rates, cut=heads, wraps=True), sep="\n")
    quantities = drawn_polygons.QUANTITIES
    images = (
        (name, *(polygon_table.image_words(drawn, name, each) for each in quantities))
        for name in links
    )
    heads = ("image of", "in velocities", "in accelerations")
    console.print("", grid(heads, images, cut=heads), sep="\n")


LEAST_K, MOST_K = 1e-3, 1e3


@dataclass(frozen=True)
class PolygonRequest:
    """Arguments of `polygon`, as given."""

    scene: SceneName
    at_deg: Annotated[float | None, option("The driver's angle (default 90).", "DEG")] = None
    at_s: Annotated[
        float | None, option("The time, in place of an angle.", "SECONDS", parser=seconds)
    ] = None
    omega: Annotated[
        float | None, option("The driver's speed, in place of its law's.", "RAD_S")
    ] = None
    k: Annotated[
        float | None, "Length of the crank's vectors over that of the drawn crank, p b = k AB."
    ] = None
    log: Annotated[
        Path | None, option("A log of the scene, yours or an engine's: drawn beside.", "LOG")
    ] = None
    map: LogMap = None
    paper: PaperSize = "A4"
    output: Annotated[
        Path | None,
        output_option(
            "Draw the sheet: .svg in layers, .pdf, .gif step by step, or .html over a turn."
        ),
    ] = None
    turn: Annotated[bool, "With -o FILE.gif: a turn, in place of the steps of drawing."] = False

    def run(self, console: Console, progress: Console) -> int:
        """Show the vectors, or draw the sheet. Raises CrankcheckError for a faulty request."""
        paper = Paper.of(self.paper)
        _check(self)
        scene = load_scene(self.scene)
        refuse_other_than_cranked(scene, "a vector polygon", analyse(scene))
        log = _logged(scene, self)
        placement = log.placement if log is not None else _placed(scene, self)
        time_s = self.at_s if log is None else log.time_s
        sheet = laid_out(drawn_polygons.polygons_of(placement), paper, self.k, log, time_s)
        if self.output is None:
            show_polygons(console, sheet)
            return 0
        ending = self.output.suffix.lower()
        steady = self.omega is not None
        if ending == PAGE:
            raw: str | bytes = polygon_page(placement, steady=steady)
        else:
            raw = turning_file(sheet, steady=steady) if self.turn else polygon_file(sheet, ending)
        write(self.output, raw)
        say_whole(console, f"{self.output}: {_told(sheet, self)}")
        say_whole(console, *polygon_table.doubts(sheet.drawn))
        return 0


def _check(request: PolygonRequest) -> None:
    """Refuse options that are out of range or contradict each other. Raises CrankcheckError."""
    inputs = [find_scene(request.scene), request.log, request.map]
    ending = ""
    if request.output is not None:
        check_file(request.output, "-o", ENDINGS, inputs=inputs)
        ending = request.output.suffix.lower()
    if request.turn and ending != ANIMATED:
        raise CrankcheckError(f"--turn: a turn is an animation; give -o FILE{ANIMATED}")
    if request.k is not None and not LEAST_K <= request.k <= MOST_K:
        raise CrankcheckError(f"--k {request.k:g}: give a number from {LEAST_K:g} to {MOST_K:g}")
    if told := _contradiction(request, ending):
        raise CrankcheckError(f"{told}; leave one out")


def _contradiction(request: PolygonRequest, ending: str) -> str:
    """Two options that contradict each other, and the reason; empty where there are none."""
    at_time, has_log = request.at_s is not None, request.log is not None
    if at_time and request.at_deg is not None:
        return "--at-s with --at-deg: each sets the instant"
    if at_time and request.omega is not None:
        return "--at-s with --omega: at a time the driver has a speed"
    if has_log and request.omega is not None:
        return "--log with --omega: at its sample the driver has a speed"
    if has_log and (request.turn or ending == PAGE):
        return f"--log with a turn, --turn or -o FILE{PAGE}: a log is drawn at one instant"
    if request.map is not None and not has_log:
        return "--map without --log: it gives the meaning of a log's columns"
    return ""


def _logged(scene: Scene, request: PolygonRequest) -> polygon_instant.LoggedInstant | None:
    if request.log is None:
        return None
    map_ = read_map(request.map) if request.map else Map()
    beside = SheetLog.of_file(scene, request.log, map_, "polygons")
    instants = polygon_instant.LogInstants.of(beside)
    if request.at_s is not None:
        return instants.at_time(request.at_s)
    return instants.at_angle(polygon_instant.AT_DEG if request.at_deg is None else request.at_deg)


def _placed(scene: Scene, request: PolygonRequest) -> PlacedMechanism:
    if request.at_s is not None:
        return polygon_instant.placed_at_time(scene, request.at_s)
    at_deg = polygon_instant.AT_DEG if request.at_deg is None else request.at_deg
    return polygon_instant.placed_at_angle(scene, at_deg, request.omega)


def _told(sheet: PolygonSheet, request: PolygonRequest) -> str:
    name = sheet.drawn.placement.scene.name
    ending = request.output.suffix.lower() if request.output is not None else ""
    if request.turn or ending == PAGE:
        course = PolygonCourse.kind(sheet.drawn.placement.scene, steady=request.omega is not None)
        return f"velocities and accelerations of {name} over {course.words}"
    at_deg = polygon_instant.AT_DEG if request.at_deg is None else request.at_deg
    of = f"at {at_deg:g} deg" if request.at_s is None else f"at {request.at_s:g} s"
    beside = f", {request.log} beside" if request.log is not None else ""
    return (
        f"velocities and accelerations of {name} {of}{beside}, on {sheet.paper.width:g} x "
        f"{sheet.paper.height:g} mm"
    )
