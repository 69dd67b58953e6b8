"""Options of `solve`, and what they mean of a scene of each kind."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import numpy as np
import typer

from models.array import Array
from models.errors import CrankcheckError
from models.scene import Scene
from reports.output.frame_file import SHEET_ROWS
from reports.requests.elastic_choice import ElasticChoice
from reports.requests.options import SceneName

PAGE, WORKBOOK = ".html", ".xlsx"
FAMILY_ENDINGS = (WORKBOOK, PAGE, ".svg", ".pdf")
ON_SCREEN = 12
IN_A_FILE = 360
MOST_SAMPLES = 1_000_000
ENDLESS = 10**15
"""Steps beyond which a float does not count them."""


@dataclass(frozen=True)
class SolveOptions:
    """Options of `solve`, whatever the kind of the scene."""

    scene: SceneName
    at_deg: Annotated[
        float | None, typer.Option(metavar="DEG", help="One position: the driver's angle.")
    ] = None
    at_m: Annotated[
        float | None,
        typer.Option(metavar="M", help="One position: the displacement of a slider that drives."),
    ] = None
    turns: Annotated[
        float | None, typer.Option(help="A motion over so many turns (default 1).")
    ] = None
    steps_per_turn: Annotated[
        int | None, typer.Option(help="Samples in a turn (default 12, in a file 360).")
    ] = None
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", help="Write .csv, .parquet or .xlsx, or a page, .html."),
    ] = None
    duration: Annotated[
        float | None,
        typer.Option(metavar="S", help="Free motion: for how long (default the scene's own)."),
    ] = None
    steps: Annotated[
        int | None,
        typer.Option(metavar="N", help="Free motion: samples in it (default 12, in a file 1000)."),
    ] = None
    clockwise: Annotated[
        bool, typer.Option("--clockwise", help="With --at-deg: the driver turning clockwise there.")
    ] = False
    along: Annotated[
        Sequence[str],
        typer.Option(metavar="POINT:DEG", help="Stroke of a point along a direction; repeatable."),
    ] = ()
    forces: Annotated[
        bool, typer.Option("--forces", help="The reactions and the driving torque as well.")
    ] = False
    figures: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            help="With --forces: draw them over a turn; or a free motion, or elastic links; as SVG "
            "and PDF.",
        ),
    ] = None
    modes: Annotated[
        int | None,
        typer.Option(metavar="N", help="Elastic links: sines across each."),
    ] = None
    axial_modes: Annotated[
        int | None,
        typer.Option(metavar="N", help="Elastic links: sines along each."),
    ] = None
    elements: Annotated[
        int | None,
        typer.Option(metavar="N", help="Elastic links: beam elements of each."),
    ] = None
    shape: Annotated[
        str | None,
        typer.Option(
            help="Elastic links start periodic, quasi-static or straight (default the scene's own)."
        ),
    ] = None
    linear: Annotated[
        bool,
        typer.Option("--linear", help="Elastic links: leave out that a bent link is shorter."),
    ] = False
    family: Annotated[
        str | None,
        typer.Option(
            metavar="NAME=A,B,...",
            help="With -o FILE.xlsx, .html, .svg or .pdf: mechanisms that differ in a number, such "
            "as a length.",
        ),
    ] = None

    @property
    def at_place(self) -> str:
        """The option by which one position was asked for; "" where a motion was."""
        if self.at_deg is None and self.at_m is None:
            return ""
        return f"--at-m {self.at_m:g}" if self.at_deg is None else f"--at-deg {self.at_deg:g}"


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
