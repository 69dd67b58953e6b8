"""`crankcheck cycle`: the steady cycle of a machine."""

from __future__ import annotations

from pathlib import Path

from rich.console import Console

from analytic.regulation.cycle_search import cycle_of
from analytic.regulation.steady_cycle import SteadyCycle
from analytic.regulation.turning_machine import TurningMachine
from models.errors import harmless
from models.files import find_scene, load_scene
from reports.cli.regulating import CycleRequest
from reports.output.frame_file import ENDINGS, write_frame
from reports.output.write import check_file, check_folder, write
from reports.regulation.cycle_frame import cycle_document, cycle_frame
from reports.regulation.regulation_tables import show_cycle

PAGE, NUMBERS = ".html", ".json"


def run_cycle(request: CycleRequest, console: Console) -> int:
    """Show or write a steady cycle. Raises CrankcheckError for what can not be asked."""
    check_outputs_of(request.scene, request.output, request.figures)
    cycle = cycle_of(TurningMachine.of(load_scene(request.scene)))
    if request.figures is not None:
        from reports.figures.regulation.all_figures import written_figures
        from reports.figures.regulation.regulated import Regulated

        tell_of(console, written_figures(Regulated(cycle), request.figures))
    if request.output is not None:
        _write(request.output, cycle)
        name = cycle.machine.scene.name
        tell_of(console, f"{request.output}: the steady cycle of {name}")
    if request.output is None and request.figures is None:
        show_cycle(console, cycle)
    return 0


def check_outputs_of(scene: str, output: Path | None, figures: Path | None) -> None:
    """Refuse files that could not be written, before anything is worked out. Raises
    CrankcheckError."""
    if output is not None:
        check_file(output, "-o", (*ENDINGS, NUMBERS, PAGE), inputs=[find_scene(scene)])
    if figures is not None:
        from reports.figures.regulation.all_figures import figure_files

        check_folder(figures, "--figures", figure_files(), inputs=[find_scene(scene)])


def tell_of(console: Console, told: str) -> None:
    """Print what was written."""
    console.print(harmless(told), highlight=False, markup=False, soft_wrap=True)


def _write(path: Path, cycle: SteadyCycle) -> None:
    """The cycle as a file of the kind that the ending says."""
    ending, scene = path.suffix.lower(), cycle.machine.scene
    if ending == PAGE:
        from reports.face.regulation_report import page_of_cycle

        write(path, page_of_cycle(cycle))
    elif ending == NUMBERS:
        write(path, cycle_document(cycle))
    else:
        origin = {"scene": scene.name, "source": scene.source}
        write_frame(path, cycle_frame(cycle), "cycle", origin)
