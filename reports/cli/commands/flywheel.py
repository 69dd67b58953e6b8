"""`crankcheck flywheel`: the flywheel for a coefficient of fluctuation."""

from __future__ import annotations

from pathlib import Path

from rich.console import Console

from analytic.regulation.cycle_scene import cycle_scene
from analytic.regulation.flywheel import CoefficientError, WantedFlywheel, wanted_flywheel
from analytic.regulation.turning_machine import TurningMachine
from models.errors import CrankcheckError
from models.files import find_scene, load_scene
from models.scene_text import scene_text
from reports.cli.commands.cycle import NUMBERS, PAGE, check_outputs_of, tell_of
from reports.cli.regulating import FlywheelRequest
from reports.output.frame_file import write_frame
from reports.output.write import check_outputs, write
from reports.regulation.cycle_frame import cycle_frame, flywheel_document
from reports.regulation.regulation_tables import show_flywheel

SCENE = ".toml"


def run_flywheel(request: FlywheelRequest, console: Console) -> int:
    """Show or write a flywheel. Raises CrankcheckError for what can not be asked."""
    _check(request)
    machine = TurningMachine.of(load_scene(request.scene))
    try:
        found = wanted_flywheel(machine, request.delta)
    except CoefficientError as error:
        raise CrankcheckError(f"--{error}") from None  # of the option
    if request.figures is not None:
        from reports.figures.regulation.all_figures import written_figures
        from reports.figures.regulation.regulated import Regulated

        tell_of(console, written_figures(Regulated(found.cycle, found), request.figures))
    if request.output is not None:
        _write(request.output, found)
        name = found.cycle.machine.scene.name
        tell_of(console, f"{request.output}: the flywheel of {name}, and its cycle")
    if request.written is not None:
        write(request.written, _scene(found, free=request.free))
        told = ", let go in its steady cycle" * request.free
        tell_of(console, f"{request.written}: {found.cycle.machine.scene.name} with it{told}")
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
        from reports.face.regulation_report import page_of_flywheel

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
