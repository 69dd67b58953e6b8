"""`crankcheck cycle`: the steady cycle of a machine."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from analytic.lectures.regulation.cycle_search import cycle_of
from analytic.lectures.regulation.steady_cycle import SteadyCycle
from analytic.lectures.regulation.turning_machine import TurningMachine
from models.errors import harmless
from models.files.reading import find_scene, load_scene
from reports.lectures.machine.cycle_frame import cycle_document, cycle_frame, show_cycle
from reports.output.frame_file import ENDINGS, write_frame
from reports.output.write import check_file, check_folder, write
from reports.requests.options import SceneName

PAGE, NUMBERS = ".html", ".json"


Output = Annotated[
    Path | None,
    typer.Option("-o", "--output", help="Write .csv, .parquet, .xlsx or .json, or a page, .html."),
]

Figures = Annotated[
    Path | None, typer.Option(metavar="DIR", help="Draw the cycle, as SVG and PDF.")
]


@dataclass(frozen=True)
class CycleRequest:
    """What `cycle` was asked for, as given."""

    scene: SceneName
    output: Output = None
    figures: Figures = None

    def run(self, console: Console, progress: Console) -> int:
        """Show or write a steady cycle. Raises CrankcheckError for what can not be asked."""
        check_outputs_of(self.scene, self.output, self.figures)
        cycle = cycle_of(TurningMachine.of(load_scene(self.scene)))
        if self.figures is not None:
            from reports.lectures.machine.figures.regulation import Regulated, written_figures

            tell_of(console, written_figures(Regulated(cycle), self.figures))
        if self.output is not None:
            _write(self.output, cycle)
            name = cycle.machine.scene.name
            tell_of(console, f"{self.output}: the steady cycle of {name}")
        show_cycle(console, cycle)
        return 0


def check_outputs_of(scene: str, output: Path | None, figures: Path | None) -> None:
    """Refuse files that could not be written, before anything is worked out. Raises
    CrankcheckError."""
    if output is not None:
        check_file(output, "-o", (*ENDINGS, NUMBERS, PAGE), inputs=[find_scene(scene)])
    if figures is not None:
        from reports.lectures.machine.figures.regulation import figure_files

        check_folder(figures, "--figures", figure_files(), inputs=[find_scene(scene)])


def tell_of(console: Console, told: str) -> None:
    """Print what was written."""
    console.print(harmless(told), highlight=False, markup=False, soft_wrap=True)


def _write(path: Path, cycle: SteadyCycle) -> None:
    """The cycle as a file of the kind that the ending says."""
    ending, scene = path.suffix.lower(), cycle.machine.scene
    if ending == PAGE:
        from reports.lectures.machine.regulation_page import page_of_cycle

        write(path, page_of_cycle(cycle))
    elif ending == NUMBERS:
        write(path, cycle_document(cycle))
    else:
        origin = {"scene": scene.name, "source": scene.source}
        write_frame(path, cycle_frame(cycle), "cycle", origin)
