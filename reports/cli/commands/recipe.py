"""`crankcheck recipe`: how something is read out of an engine."""

from __future__ import annotations

import math

import numpy as np
from rich.console import Console

from analytic.kinematics import solve
from models.errors import CrankcheckError, harmless
from models.files import find_scene, load_scene
from reports.cli.recipes import ForceRecipeRequest
from reports.output.write import check_file, write
from reports.plan.elastic import refuse_bent
from reports.plan.steps import MOST_STEPS
from sim.force_recipes import force_recipe
from sim.registry import engine
from sim.run import check_steps
from sim.settings import profile_of, resolved


def run_force_recipe(request: ForceRecipeRequest, console: Console) -> int:
    """The program, into a file or to the terminal."""
    if request.output is not None:
        check_file(request.output, "-o", (".py",), inputs=[find_scene(request.scene)])
    if not (math.isfinite(request.steps_per_turn) and request.steps_per_turn > 0.0):
        raise CrankcheckError(
            f"--steps-per-turn: found {request.steps_per_turn:g}; give a number above 0"
        )
    if request.steps_per_turn > MOST_STEPS:
        raise CrankcheckError(
            f"--steps-per-turn: found {request.steps_per_turn:g}; the program keeps a line for "
            f"each step, so give {MOST_STEPS} at most"
        )
    scene = load_scene(request.scene)
    refuse_bent(scene, "recipe forces", "leave [elastic] out, or read them with run --forces")
    settings = resolved(profile_of(engine(request.engine), request.profile), None)
    period = scene.driver.law.period_s
    check_steps(scene, period, period / request.steps_per_turn, 1, 1)
    start = solve(scene, np.zeros(1)).state()
    text = force_recipe(request.engine, scene, start, settings, request.steps_per_turn)
    if request.output is None:
        console.file.write(text)
        return 0
    write(request.output, text)
    told = f"{request.output}: forces of {scene.name} in {request.engine}"
    console.print(harmless(told), highlight=False, markup=False)
    return 0
