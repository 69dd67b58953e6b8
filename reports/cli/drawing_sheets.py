"""The commands that draw sheets to scale, as the lectures do."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from reports.cli.application import command
from reports.cli.showing import SceneName
from reports.output.console import terminal

PaperSize = Annotated[
    str, typer.Option(metavar="SIZE", help="A5, A4, A3, A2, or WIDTHxHEIGHT in mm.")
]


@dataclass(frozen=True)
class PolygonRequest:
    """What `polygon` was asked for, as given."""

    scene: SceneName
    at_deg: Annotated[float, typer.Option(metavar="DEG", help="The driver's angle.")] = 90.0
    omega: Annotated[
        float | None,
        typer.Option(metavar="RAD_S", help="The driver's speed, in place of its law's."),
    ] = None
    k: Annotated[
        float | None,
        typer.Option(
            "--k", help="Vectors of the crank so many times as long as it is drawn, p b = k AB."
        ),
    ] = None
    paper: PaperSize = "A4"
    output: Annotated[
        Path | None,
        typer.Option(
            "-o", "--output", help="Draw the sheet: .svg in layers, .pdf, or .gif, step by step."
        ),
    ] = None
    turn: Annotated[
        bool,
        typer.Option("--turn", help="With -o FILE.gif: over a turn, in place of step by step."),
    ] = False


@command
def polygon(request: PolygonRequest) -> int:
    """Draw the velocity and the acceleration polygon of a position, group by group, to scale.

    Without -o the table of the vectors is shown.
    """
    from reports.cli.commands import polygon as verb

    return verb.run_polygon(request, terminal())
