"""`crankcheck positions`: a sheet drawn to scale."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from models.errors import harmless
from models.files.reading import find_scene, load_scene
from reports.lectures.drawing.sheets.paper import Canvas, Paper, sheet_note
from reports.lectures.drawing.sheets.position_sheet import draw_positions, positions
from reports.output.write import check_file, write
from reports.requests.options import PaperSize, SceneName

ENDINGS = (".svg", ".pdf")


Output = Annotated[Path, typer.Option("-o", "--output", help="Draw it: .svg in layers, or .pdf.")]


@dataclass(frozen=True)
class PositionsRequest:
    """What `positions` was asked for, as given."""

    scene: SceneName
    output: Output
    divisions: Annotated[int, typer.Option(min=2, max=360, help="Parts of the crank circle.")] = 12
    paper: PaperSize = "A4"

    def run(self, console: Console, progress: Console) -> int:
        """Draw positions. Raises CrankcheckError for what can not be asked."""
        paper = _checked(self.scene, self.output, self.paper)
        scene = load_scene(self.scene)
        sheet = positions(scene, self.divisions, paper)
        told = f"{self.divisions} positions of {scene.name}, K_l = {sheet.scale:g} m/mm"
        save_sheet(console, draw_positions(sheet, sheet_note(scene)), self.output, told)
        return 0


def _checked(scene: str, output: Path, paper: str) -> Paper:
    """The paper; refuse a file that could not be written."""
    check_file(output, "-o", ENDINGS, inputs=[find_scene(scene)])
    return Paper.of(paper)


def save_sheet(console: Console, canvas: Canvas, path: Path, told: str) -> None:
    """Write a sheet, and say so."""
    write(path, canvas.saved(path.suffix.lower()[1:], told))
    console.print(harmless(f"{path}: {told}"), highlight=False, markup=False, soft_wrap=True)
