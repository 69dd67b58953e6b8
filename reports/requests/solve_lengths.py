"""What the options of `solve` mean of a scene: how its links bend, and at which instants."""

from __future__ import annotations

import math

import numpy as np

from models.array import Array
from models.errors import CrankcheckError
from models.scene import Scene
from reports.output.frame_file import SHEET_ROWS
from reports.requests.elastic_choice import ElasticChoice
from reports.requests.solve_options import SolveOptions

PAGE, WORKBOOK = ".html", ".xlsx"
FAMILY_ENDINGS = (WORKBOOK, PAGE, ".svg", ".pdf")
ON_SCREEN = 12
IN_A_FILE = 360
MOST_SAMPLES = 1_000_000
ENDLESS = 10**15
"""Steps beyond which a float does not count them."""


def elastic_choice(request: SolveOptions) -> ElasticChoice:
    """What was asked for of elastic links."""
    return ElasticChoice(
        request.modes, request.axial_modes, request.elements, request.shape, request.linear
    )


def refuse_times(scene: Scene, request: SolveOptions) -> None:
    """Refuse what is asked of free motion alone, of a scene that is driven. Raises
    CrankcheckError."""
    for option, value in (("--duration", request.duration), ("--steps", request.steps)):
        if value is not None:
            raise CrankcheckError(
                f'{option} {value:g}: {scene.name} is driven, and not let go (law = "free"); give '
                "--turns and --steps-per-turn"
            )


def instants_of(scene: Scene, request: SolveOptions) -> Array:
    """Those of whole turns, the last sample included [s]. Raises CrankcheckError."""
    turns = 1.0 if request.turns is None else request.turns
    steps = request.steps_per_turn
    if steps is None:
        steps = ON_SCREEN if request.output is None else IN_A_FILE
    if not (math.isfinite(turns) and turns > 0.0):
        raise CrankcheckError(f"--turns {turns:g}: give a number above 0; 1 is one period")
    if steps < 1:
        raise CrankcheckError(f"--steps-per-turn {steps}: give at least 1")
    most = MOST_SAMPLES
    if request.output is not None and request.output.suffix.lower() == WORKBOOK:
        most = SHEET_ROWS
    steps = min(steps, ENDLESS)
    last = turns * steps * (1 - 1e-12)  # may be infinite
    if not last <= most - 1:
        raise CrankcheckError(
            f"--turns {turns:g} --steps-per-turn {steps}: {last + 1:.7g} samples; at most {most}: "
            "take fewer turns, or fewer steps in a turn"
        )
    samples = math.ceil(last) + 1
    step_s = scene.driver.law.period_s / steps
    return step_s * np.arange(samples, dtype=np.float64)
