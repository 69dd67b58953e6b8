"""The command that draws vector polygons."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from reports.cli.application import command, seconds
from reports.cli.drawing_sheets import PaperSize
from reports.cli.showing import SceneName
from reports.output.console import terminal


@dataclass(frozen=True)
class PolygonRequest:
    """What `polygon` was asked for, as given."""

    scene: SceneName
    at_deg: Annotated[
        float | None, typer.Option(metavar="DEG", help="The driver's angle (default 90).")
    ] = None
    at_s: Annotated[
        float | None,
        typer.Option(
            metavar="SECONDS",
            parser=seconds,
            help="The time, in place of an angle.",
        ),
    ] = None
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
    log: Annotated[
        Path | None,
        typer.Option(metavar="LOG", help="A log of the scene, yours or an engine's: drawn beside."),
    ] = None
    map: Annotated[
        Path | None, typer.Option(metavar="FILE", help="TOML that says what its columns mean.")
    ] = None
    paper: PaperSize = "A4"
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            help="Draw the sheet: .svg in layers, .pdf, .gif step by step, or .html over a turn.",
        ),
    ] = None
    turn: Annotated[
        bool,
        typer.Option("--turn", help="With -o FILE.gif: over a turn, in place of step by step."),
    ] = False


@command
def polygon(request: PolygonRequest) -> int:
    """Draw the velocity and the acceleration polygon of a position, group by group, to scale.

    Without -o the table of the vectors is shown. With --log the images of a log's points stand
    beside those of the reference.
    """
    from reports.cli.commands import polygon as verb

    return verb.run_polygon(request, terminal())
