"""`crankcheck recipe`: how something is read out of an engine."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from rich.console import Console

from models.errors import CrankcheckError
from models.files import find_scene, load_scene
from reports.output.console import put
from reports.output.write import check_file
from reports.plan.steps import MOST_STEPS
from reports.requests.options import option, output_option
from reports.way.way import way_of
from sim.force_recipes import force_recipe
from sim.registry import engine
from sim.run import check_steps
from sim.settings import profile_of, resolved


@dataclass(frozen=True)
class ForceRecipeRequest:
    """What `recipe forces` was asked for, as given."""

    engine: Annotated[str, "Engine."]
    scene: Annotated[str, option("A shipped name, or a scene file.", "SCENE")] = "fourbar-lecture-1"
    profile: Annotated[str, "Profile of the engine."] = "tuned"
    steps_per_turn: Annotated[float, "Steps in a turn."] = 720.0
    output: Annotated[Path | None, output_option("Write a .py file.")] = None

    def run(self, console: Console, progress: Console) -> int:
        """The program, into a file or to the terminal."""
        if self.output is not None:
            check_file(self.output, "-o", (".py",), inputs=[find_scene(self.scene)])
        if not (math.isfinite(self.steps_per_turn) and self.steps_per_turn > 0.0):
            raise CrankcheckError(
                f"--steps-per-turn: found {self.steps_per_turn:g}; give a number above 0"
            )
        if self.steps_per_turn > MOST_STEPS:
            raise CrankcheckError(
                f"--steps-per-turn: found {self.steps_per_turn:g}; the program keeps a line for "
                f"each step, so give {MOST_STEPS} at most"
            )
        scene = load_scene(self.scene)
        settings = resolved(profile_of(engine(self.engine), self.profile), None)
        period = scene.driver.law.period_s
        check_steps(scene, period, period / self.steps_per_turn, 1, 1)
        scene, start = way_of(scene).opened(scene)
        text = force_recipe(self.engine, scene, start, settings, self.steps_per_turn)
        put(console, self.output, text, f"forces of {scene.name} in {self.engine}")
        return 0
