"""`crankcheck polygon`: the vector polygons of a position."""

from __future__ import annotations

import math

from rich.console import Console

from analytic.drawings.drawn_polygons import DrawnPolygons, draw_polygons
from analytic.drawings.placed_mechanism import DriverState
from models.errors import CrankcheckError, harmless
from models.files import find_scene, load_scene
from models.scene import Scene
from reports.cli.drawing_sheets import PolygonRequest
from reports.describe.driver_at import angle_at, driver_at
from reports.output.write import check_file, write
from reports.sheets.paper import Paper
from reports.sheets.polygon_files import ANIMATED, ENDINGS, polygon_file, turning_file
from reports.sheets.polygon_sheet import PolygonSheet, laid_out
from reports.sheets.polygon_tables import show_polygons

MOST_K = 1e3


def run_polygon(request: PolygonRequest, console: Console) -> int:
    """Show the vectors, or draw the sheet. Raises CrankcheckError for what can not be asked."""
    paper = Paper.of(request.paper)
    _check(request)
    scene = load_scene(request.scene)
    sheet = laid_out(draw_polygons(scene, _driver(scene, request)), paper, request.k)
    if request.output is None:
        show_polygons(console, sheet)
        return 0
    ending = request.output.suffix.lower()
    raw = turning_file(sheet) if request.turn else polygon_file(sheet, ending)
    write(request.output, raw)
    told = f"{request.output}: {_told(sheet, request)}"
    console.print(harmless(told), highlight=False, markup=False, soft_wrap=True)
    _tell_undetermined(console, sheet.drawn)
    return 0


def _check(request: PolygonRequest) -> None:
    """Refuse what can not be asked."""
    if request.output is not None:
        check_file(request.output, "-o", ENDINGS, inputs=[find_scene(request.scene)])
    if request.turn and (request.output is None or request.output.suffix.lower() != ANIMATED):
        raise CrankcheckError(f"--turn: a turn is an animation; give -o FILE{ANIMATED}")
    if request.k is not None and not 0.0 < request.k <= MOST_K:
        raise CrankcheckError(f"--k {request.k:g}: give a number above 0, up to {MOST_K:g}")
    if request.omega is not None and not (math.isfinite(request.omega) and request.omega):
        raise CrankcheckError(
            f"--omega {request.omega:g}: give a speed other than 0 in rad/s; at rest there is "
            "nothing to draw"
        )


def _driver(scene: Scene, request: PolygonRequest) -> DriverState:
    if request.omega is not None:
        return DriverState(angle_at(request.at_deg), request.omega)
    if scene.is_free:
        raise CrankcheckError(
            f"{scene.name}: its driver is let go, and no law says how fast it is at "
            f"{request.at_deg:g} deg; give --omega"
        )
    return DriverState(*driver_at(scene, request.at_deg))


def _told(sheet: PolygonSheet, request: PolygonRequest) -> str:
    """What was drawn."""
    name = sheet.drawn.placement.scene.name
    of = "over a turn" if request.turn else f"at {request.at_deg:g} deg"
    return (
        f"velocities and accelerations of {name} {of}, on {sheet.paper.width:g} x "
        f"{sheet.paper.height:g} mm"
    )


def _tell_undetermined(console: Console, drawn: DrawnPolygons) -> None:
    for told in drawn.undetermined:
        console.print(f"not drawn: {told}", highlight=False, markup=False, soft_wrap=True)
