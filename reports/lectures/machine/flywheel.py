"""`crankcheck flywheel`: the flywheel for a coefficient of fluctuation."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from analytic.lectures.regulation.flywheel import CoefficientError, WantedFlywheel, wanted_flywheel
from analytic.lectures.regulation.steady_cycle import cycle_scene
from analytic.lectures.regulation.turning_machine import TurningMachine
from models.errors import CrankcheckError
from models.files.assemble import scene_text
from models.files.reading import find_scene, load_scene
from reports.lectures.machine.cycle import NUMBERS, PAGE, check_outputs_of, tell_of
from reports.lectures.machine.cycle_frame import cycle_frame, flywheel_document, show_flywheel
from reports.output.frame_file import write_frame
from reports.output.write import check_outputs, write
from reports.requests.options import SceneName

SCENE = ".toml"


Output = Annotated[
    Path | None,
    typer.Option("-o", "--output", help="Write .csv, .parquet, .xlsx or .json, or a page, .html."),
]

Figures = Annotated[
    Path | None, typer.Option(metavar="DIR", help="Draw the cycle, as SVG and PDF.")
]


@dataclass(frozen=True)
class FlywheelRequest:
    """What `flywheel` was asked for, as given. ``written`` is where the scene goes, ``free`` says
    that it is let go in it."""

    scene: SceneName
    delta: Annotated[
        float, typer.Option(help="Coefficient of fluctuation that is wanted, such as 0.02.")
    ]
    output: Output = None
    figures: Figures = None
    written: Annotated[
        Path | None,
        typer.Option("--write", metavar="FILE.toml", help="Write the scene with the flywheel."),
    ] = None
    free: Annotated[
        bool,
        typer.Option(
            "--free", help="With --write: let go in its cycle, the drive's torque as a load."
        ),
    ] = False

    def run(self, console: Console, progress: Console) -> int:
        """Show or write a flywheel. Raises CrankcheckError for what can not be asked."""
        _check(self)
        machine = TurningMachine.of(load_scene(self.scene))
        try:
            found = wanted_flywheel(machine, self.delta)
        except CoefficientError as error:
            raise CrankcheckError(f"--{error}") from None  # of the option
        if self.figures is not None:
            from reports.lectures.machine.figures.regulation import Regulated, written_figures

            tell_of(console, written_figures(Regulated(found.cycle, found), self.figures))
        if self.output is not None:
            _write(self.output, found)
            name = found.cycle.machine.scene.name
            tell_of(console, f"{self.output}: the flywheel of {name}, and its cycle")
        if self.written is not None:
            write(self.written, _scene(found, free=self.free))
            told = ", let go in its steady cycle" * self.free
            tell_of(console, f"{self.written}: {found.cycle.machine.scene.name} with it{told}")
        show_flywheel(console, found)
        return 0


def _check(request: FlywheelRequest) -> None:
    """Refuse what can not be written, or goes with nothing."""
    check_outputs_of(request.scene, request.output, request.figures)
    if request.free and request.written is None:
        raise CrankcheckError("--free: it says how the scene is written; give --write FILE.toml")
    if request.written is not None:
        if request.written.suffix.lower() != SCENE:
            raise CrankcheckError(
                f"--write {request.written}: found {request.written.suffix or 'no ending'}; use "
                f"{SCENE}"
            )
        files = {"-o": request.output, "--write": request.written}
        check_outputs(files, inputs=[find_scene(request.scene)])


def _scene(found: WantedFlywheel, *, free: bool) -> str:
    """The scene with the flywheel as the text of a file, the flywheel by itself in it."""
    machine = found.cycle.machine
    scene = cycle_scene(found.cycle, flywheel=False) if free else machine.scene
    return scene_text(scene, {scene.driver.link: found.inertia_kg_m2})


def _write(path: Path, found: WantedFlywheel) -> None:
    """The flywheel as a file of the kind that the ending says."""
    ending, scene = path.suffix.lower(), found.cycle.machine.scene
    if ending == PAGE:
        from reports.lectures.machine.regulation_page import page_of_flywheel

        write(path, page_of_flywheel(found))
    elif ending == NUMBERS:
        write(path, flywheel_document(found))
    else:
        origin = {
            "scene": scene.name,
            "source": scene.source,
            "flywheel_kg_m2": repr(found.inertia_kg_m2),
        }
        write_frame(path, cycle_frame(found.cycle, found.bare), "cycle", origin)
