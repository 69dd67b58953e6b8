"""Commands that show a scene as an engine has it: `export`, `recipe forces`, `view`; and
`scenes`, the list of them."""

from __future__ import annotations

import math
import os
import sys
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from rich.console import Console
from rich.text import Text

from analytic.cams.outline import outlined
from analytic.structure import groups, mobility
from models.errors import CrankcheckError, StructureError, harmless, shown
from models.files.reading import KINEMATICS, find_scene, kinds, load_scene, shipped
from models.mjcf.document import build
from models.mjcf.options import exact
from models.scene import Scene
from reports.describe.facts import describe_law
from reports.output.console import grid, put, say
from reports.output.numbers import duration
from reports.output.write import check_file, write
from reports.plan.requirements import under_control
from reports.plan.steps import MOST_STEPS, positive
from reports.protocol.way import way_of
from reports.requests.options import SceneName, given, option, output_option
from reports.requests.run import RunRequest
from sim.engine.settings import profile_of, resolved
from sim.registry import engine
from sim.registry.offers import force_recipe, viewer
from sim.run import check_steps

if TYPE_CHECKING:
    from reports.figures.gif import DrawnRun


@dataclass(frozen=True)
class ExportRequest:
    scene: SceneName
    output: Annotated[Path | None, output_option("Write an .xml file.")] = None
    close: Annotated[
        Sequence[str], option("Close a loop at this pin; may be repeated.", "PIN")
    ] = ()

    def run(self, console: Console, progress: Console) -> int:
        """Write the MJCF of a scene, assembled at its start, into a file or to the terminal; an
        elastic link is the chain of segments that the engine is given.

        Loops are closed at the pins of ``close``, the others where `models.mjcf.tree` says.
        """
        check_file(self.output, "-o", (".xml",), inputs=[find_scene(self.scene)])
        own = under_control(outlined(load_scene(self.scene)))
        if any(not pair.facets for pair in own.cams.values()):
            raise CrankcheckError(
                f"{own.name}: MJCF has no relation that follows the law of a cam; give the "
                "cam's table `facets`, for a cam by contact"
            )
        way = way_of(own)
        scene, start = way.opened(own)
        # Of segments the step is one that holds their fastest vibration.
        steps = way.held_steps(own)
        text = build(scene, start, replace(exact(scene, *steps), close=tuple(self.close)))
        put(console, self.output, text, f"MJCF of {scene.name}")
        return 0


@dataclass(frozen=True)
class ForceRecipeRequest:
    engine: Annotated[str, "Engine."]
    scene: Annotated[str, option("A shipped name, or a scene file.", "SCENE")] = "fourbar-lecture-1"
    profile: Annotated[str, "Profile of the engine."] = "tuned"
    steps_per_turn: Annotated[float, "Steps in a turn."] = 720.0
    output: Annotated[Path | None, output_option("Write a .py file.")] = None

    def run(self, console: Console, progress: Console) -> int:
        """Write the program into a file or to the terminal."""
        check_file(self.output, "-o", (".py",), inputs=[find_scene(self.scene)])
        if positive("--steps-per-turn", self.steps_per_turn, "steps") > MOST_STEPS:
            raise CrankcheckError(
                f"--steps-per-turn: found {self.steps_per_turn:g}; the program has a line for "
                f"each step, so give {MOST_STEPS} at most"
            )
        scene = outlined(load_scene(self.scene))
        settings = resolved(profile_of(engine(self.engine), self.profile), None)
        period = scene.driver.law.period_s
        check_steps(scene, period, period / self.steps_per_turn, 1, 1)
        scene, start = way_of(scene).opened(scene)
        text = force_recipe(self.engine, scene, start, settings, self.steps_per_turn)
        put(console, self.output, text, f"forces of {scene.name} in {self.engine}")
        return 0


PICTURES = (".gif", ".png")


@dataclass(frozen=True)
class ViewRequest:
    scene: SceneName
    output: Annotated[
        Path | None, output_option("Draw into a .gif or .png in place of the viewer.")
    ] = None
    forces: Annotated[bool, "Draw the forces as arrows, into a file."] = False
    engine: Annotated[str | None, "Draw its run beside the reference, into a file."] = None
    profile: Annotated[str, "Profile of the engine."] = "as-shipped"
    magnify: Annotated[str, "Factor of its errors, or auto: as far as one sees them."] = "auto"

    def run(self, console: Console, progress: Console) -> int:
        """Show a scene; the viewer draws no forces of ours, so that these go into a file.

        Raises CrankcheckError for a scene or a file that can not be used, or for lack of forces.
        """
        scene, output = outlined(load_scene(self.scene)), self.output
        headless = output is None and (self.forces or self.engine or not has_screen())
        if headless:
            output = Path(f"{scene.name}.gif")
        option = "view" if headless else "-o"
        check_file(output, option, PICTURES, inputs=[find_scene(self.scene)])
        if self.forces and self.engine:
            raise CrankcheckError("--forces with --engine: a picture shows one of them; leave one")
        for of_run in given(self, "profile", "magnify") if self.engine is None else ():
            raise CrankcheckError(f"{of_run}: no run is drawn; give --engine as well")
        run = None if self.engine is None else self._run()
        if output is None:
            viewer()(*way_of(scene).opened(scene))
            return 0
        if headless:
            why = "" if self.forces or run else "no screen here, so "
            console.print(f"{why}drawn into a file:", style="dim")
        from reports.figures import gif as picture

        draw = picture.strip if output.suffix.lower() == ".png" else picture.animation
        content = draw(scene, run, with_forces=self.forces)
        write(output, content)
        say(console, harmless(f"{output}: {scene.name} {way_of(scene).over}"))
        return 0

    def _run(self) -> DrawnRun:
        """The run of the engine to draw. Raises CrankcheckError."""
        from reports.figures.gif import DrawnRun

        factor = None if self.magnify == "auto" else _factor(self.magnify)
        done = RunRequest(self.scene, self.engine, self.profile).answer()
        if done.motion is None:
            raise CrankcheckError(f"{done.scene}, {done.engine}: {done.status}: {done.reason}")
        name = f"{done.engine} {done.version} {done.profile}, step {duration(done.dt_s)}"
        return DrawnRun(done.motion, name, factor)


def _factor(text: str) -> float:
    """Parse a factor. Raises CrankcheckError for other text."""
    with suppress(ValueError):
        if 0.0 < (factor := float(text)) < math.inf:
            return factor
    raise CrankcheckError(f"--magnify: found {shown(text)}; give a number above 0, or auto")


def has_screen() -> bool:
    """True if a window can be opened here."""
    if sys.platform in ("darwin", "win32"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


@dataclass(frozen=True)
class ScenesRequest:
    """Request of `scenes`, which has no arguments."""

    def run(self, console: Console, progress: Console) -> int:
        """List the shipped scenes by kind: structure, driver and source."""
        for kind in kinds():
            console.print(Text(_heading(kind), "bold"))
            scenes = [load_scene(name) for name in shipped(kind)]
            rows = ((s.name, _groups(s), describe_law(s), Text(s.source)) for s in scenes)
            heads = ("scene", "groups", "driver", "source")
            console.print(grid(heads, rows, whole=("scene",)), highlight=False)
        return 0


def _groups(scene: Scene) -> str:
    """The Assur groups of a scene in solving order, a dash for groups other than dyads."""
    try:
        parts = mobility.analyse(scene).order
        return " + ".join(part.kind for part in parts if not isinstance(part, groups.Bridge))
    except StructureError:
        return "-"


def _heading(kind: str) -> str:
    by_name = f"all of them by `{kind}`, as in `crankcheck verify {kind}`"
    return f"{kind}: {'all of them by default' if kind == KINEMATICS else by_name}"
