"""`crankcheck positions`: a sheet drawn to scale."""

from __future__ import annotations

from pathlib import Path

from rich.console import Console

from models.errors import harmless
from models.files import find_scene, load_scene
from reports.cli.drawing_sheets import PositionsRequest
from reports.output.write import check_file, write
from reports.sheets.canvas import Canvas
from reports.sheets.paper import Paper
from reports.sheets.position_sheet import draw_positions, positions
from reports.sheets.sheet_note import sheet_note

ENDINGS = (".svg", ".pdf")


def run_positions(request: PositionsRequest, console: Console) -> int:
    """Draw positions. Raises CrankcheckError for what can not be asked."""
    paper = _checked(request.scene, request.output, request.paper)
    scene = load_scene(request.scene)
    sheet = positions(scene, request.divisions, paper)
    told = f"{request.divisions} positions of {scene.name}, K_l = {sheet.scale:g} m/mm"
    save_sheet(console, draw_positions(sheet, sheet_note(scene)), request.output, told)
    return 0


def _checked(scene: str, output: Path, paper: str) -> Paper:
    """The paper; refuse a file that could not be written."""
    check_file(output, "-o", ENDINGS, inputs=[find_scene(scene)])
    return Paper.of(paper)


def save_sheet(console: Console, canvas: Canvas, path: Path, told: str) -> None:
    """Write a sheet, and say so."""
    write(path, canvas.saved(path.suffix.lower()[1:], told))
    console.print(harmless(f"{path}: {told}"), highlight=False, markup=False, soft_wrap=True)
