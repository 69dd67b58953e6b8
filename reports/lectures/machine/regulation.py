"""`cycle` and `flywheel`: the evenness of a machine's speed, and the flywheel for it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from rich.console import Console

from analytic.lectures.regulation.flywheel import CoefficientError, WantedFlywheel, wanted_flywheel
from analytic.lectures.regulation.steady_cycle import (
    SteadyCycle,
    cycle_of,
    cycle_scene,
    with_flywheel,
)
from analytic.lectures.regulation.turning_machine import TurningMachine
from models.errors import CrankcheckError
from models.files.assemble import scene_text
from models.files.reading import find_scene, load_scene
from models.scene import Scene
from reports.figures.layout import Layout, laid_out
from reports.lectures.machine import cycle_rows
from reports.output.console import say_whole
from reports.output.formats import ENDINGS, write_frame
from reports.output.write import Outputs, check_file, check_folder, write
from reports.requests.arguments import SceneLike, kind_of, scene_of, told_at_the_call
from reports.requests.options import SceneName, option, output_option
from reports.requests.shown import Shown

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, eq=False, repr=False)
class MachineCycle(Shown):
    """The steady cycle of a scene (`cycle`). Torques count along the motion: positive ones drive.

    ``details`` has all facts of it: ``delta``, ``mean_rad_s``, ``extreme_speeds_rad_s``,
    ``surplus_j``, ``works_j``, ``drive_n_m``, ``period_s`` and the like.
    """

    details: SteadyCycle

    @property
    def delta(self) -> float:
        """The coefficient of fluctuation, (largest - smallest speed) / mean."""
        return self.details.delta

    @property
    def mean_rad_s(self) -> float:
        """Half the sum of the largest and the smallest speed of the driver."""
        return self.details.mean_rad_s

    @property
    def extreme_speeds_rad_s(self) -> tuple[float, float]:
        """The largest and the smallest speed."""
        return self.details.extreme_speeds_rad_s

    @property
    def surplus_j(self) -> float:
        """The surplus of work over the cycle."""
        return self.details.surplus_j

    @property
    def drive_n_m(self) -> float:
        """The constant torque of the drive that closes the balance of work."""
        return self.details.drive_n_m

    def scene_let_go(self, cycles: float = 5.0) -> Scene:
        """The scene released in this cycle, for so many cycles, with the drive's torque as a load:
        an engine that runs it free runs the cycle."""
        return cycle_scene(self.details, cycles)

    def frame(self) -> pd.DataFrame:
        """Table of the cycle, a row each half degree: speed, inertia, torques, work, energy."""
        return cycle_rows.cycle_frame(self.details)

    def show(self, console: Console) -> None:
        cycle_rows.show_cycle(console, self.details)


@dataclass(frozen=True, eq=False, repr=False)
class MachineFlywheel(Shown):
    """The flywheel of a scene for a coefficient of fluctuation (`flywheel`); ``details`` has the
    approximations of the textbooks beside it, and the cycle without it."""

    details: WantedFlywheel

    @property
    def inertia_kg_m2(self) -> float:
        """The moment of inertia to be added to the driver."""
        return self.details.inertia_kg_m2

    @property
    def cycle(self) -> MachineCycle:
        """The steady cycle with the flywheel."""
        return MachineCycle(self.details.cycle)

    @property
    def scene(self) -> Scene:
        """The scene with the flywheel."""
        return with_flywheel(self.details.cycle.machine.scene, self.inertia_kg_m2)

    def frame(self) -> pd.DataFrame:
        """Table of the cycle, with the speed without the flywheel where there is one."""
        return cycle_rows.cycle_frame(self.details.cycle, self.details.bare)

    def show(self, console: Console) -> None:
        cycle_rows.show_flywheel(console, self.details)


@told_at_the_call
def cycle(scene: SceneLike) -> MachineCycle:
    """Find the cycle that a machine repeats under its loads: its speed and fluctuation.

    Parameters
    ----------
    scene : Scene, str or path
        A shipped name, the path of a scene file, or a scene. A driven scene has its constant speed
        as the mean, and a constant torque as the drive; in free motion its loads alone count.

    Raises
    ------
    CrankcheckError
        No steady cycle, with the reason.
    """
    return MachineCycle(cycle_of(TurningMachine.of(scene_of(scene))))


@told_at_the_call
def flywheel(scene: SceneLike, delta: float) -> MachineFlywheel:
    """Find the flywheel on the driver that gives a machine a coefficient of fluctuation.

    Parameters
    ----------
    scene : Scene, str or path
        As in `cycle`.
    delta : float
        The coefficient, (largest - smallest speed) / mean, such as 0.02.

    Raises
    ------
    CrankcheckError
        A coefficient that no flywheel gives, or that the machine keeps without; no steady cycle.
    """
    if isinstance(delta, bool) or not isinstance(delta, int | float):
        raise CrankcheckError(f"--delta: found {kind_of(delta)}; give a number, such as 0.02")
    return MachineFlywheel(wanted_flywheel(TurningMachine.of(scene_of(scene)), float(delta)))


PAGE, NUMBERS = ".html", ".json"


Output = Annotated[
    Path | None, output_option("Write .csv, .parquet, .xlsx or .json, or a page, .html.")
]
Figures = Annotated[Path | None, option("Draw the cycle, as SVG and PDF.", "DIR")]


@dataclass(frozen=True)
class CycleRequest(Layout):
    """Arguments of `cycle`, as given."""

    scene: SceneName
    output: Output = None
    figures: Figures = None

    @laid_out
    def run(self, console: Console, progress: Console) -> int:
        """Show or write a steady cycle. Raises CrankcheckError for a faulty request."""
        _check_outputs(self)
        cycle = cycle_of(TurningMachine.of(load_scene(self.scene)))
        _write(self, cycle, None, console)
        cycle_rows.show_cycle(console, cycle)
        return 0


def _check_outputs(request: CycleRequest | FlywheelRequest) -> None:
    """Refuse files that could not be written, before the calculation. Raises CrankcheckError."""
    inputs = [find_scene(request.scene)]
    check_file(request.output, "-o", (*ENDINGS, NUMBERS, PAGE), inputs=inputs)
    if request.figures is not None:
        from reports.lectures.machine.regulation_figures import REGULATION_FIGURES

        check_folder(request.figures, "--figures", REGULATION_FIGURES.files, inputs=inputs)


def _write(
    request: CycleRequest | FlywheelRequest,
    cycle: SteadyCycle,
    found: WantedFlywheel | None,
    console: Console,
) -> None:
    scene, output = cycle.machine.scene, request.output
    if request.figures is not None:
        from reports.lectures.machine.regulation_figures import REGULATION_FIGURES, Regulated

        figures = REGULATION_FIGURES.written(Regulated(cycle, found), request.figures)
        say_whole(console, figures)
    if output is None:
        return
    if output.suffix.lower() == PAGE:
        from reports.lectures.machine.regulation_figures import regulation_page

        write(output, regulation_page(cycle, found))
    elif output.suffix.lower() == NUMBERS:
        numbers = cycle_rows.flywheel_document(found) if found else cycle_rows.cycle_document(cycle)
        write(output, numbers)
    else:
        origin = {"scene": scene.name, "source": scene.source}
        if found is not None:
            origin["flywheel_kg_m2"] = repr(found.inertia_kg_m2)
        frame = cycle_rows.cycle_frame(cycle, found.bare if found else None)
        write_frame(output, frame, "cycle", origin)
    what, more = ("flywheel", ", and its cycle") if found else ("steady cycle", "")
    say_whole(console, f"{output}: the {what} of {scene.name}{more}")


@dataclass(frozen=True)
class FlywheelRequest(Layout):
    """Arguments of `flywheel`, as given. ``written`` is the file of the scene, which is in free
    motion there with ``free``."""

    scene: SceneName
    delta: Annotated[float, "Requested coefficient of fluctuation, such as 0.02."]
    output: Output = None
    figures: Figures = None
    written: Annotated[
        Path | None, option("Write the scene with the flywheel.", "--write FILE.toml")
    ] = None
    free: Annotated[
        bool,
        "With --write: a scene of free motion in its cycle, with the drive's torque as a load.",
    ] = False

    @laid_out
    def run(self, console: Console, progress: Console) -> int:
        """Show or write a flywheel. Raises CrankcheckError for a faulty request."""
        _check(self)
        machine = TurningMachine.of(load_scene(self.scene))
        try:
            found = wanted_flywheel(machine, self.delta)
        except CoefficientError as error:
            raise CrankcheckError(f"--{error}") from None  # of the option
        _write(self, found.cycle, found, console)
        if self.written is not None:
            scene = found.cycle.machine.scene
            if self.free:
                scene = cycle_scene(found.cycle, flywheel=False)
            write(self.written, scene_text(scene, {scene.driver.link: found.inertia_kg_m2}))
            told = ", free in its steady cycle" * self.free
            say_whole(console, f"{self.written}: {found.cycle.machine.scene.name} with it{told}")
        cycle_rows.show_flywheel(console, found)
        return 0


def _check(request: FlywheelRequest) -> None:
    """Refuse files that can not be written, and ``free`` without a file. Raises CrankcheckError."""
    _check_outputs(request)
    if request.free and request.written is None:
        raise CrankcheckError("--free: it changes the written scene; give --write FILE.toml")
    check_file(request.written, "--write", (".toml",))
    files = {"-o": request.output, "--write": request.written}
    Outputs(files).check([find_scene(request.scene)])
