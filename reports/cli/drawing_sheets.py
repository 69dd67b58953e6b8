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
class CentresRequest:
    """What `centres` was asked for, as given."""

    scene: SceneName
    at_deg: Annotated[float, typer.Option(metavar="DEG", help="The driver's angle.")] = 60.0
    link: Annotated[
        str,
        typer.Option(metavar="NAME", help="Its poles, circles of curvature and centrodes as well."),
    ] = ""
    paper: PaperSize = "A4"
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="Draw it: .svg in layers, or .pdf.")
    ] = None


@command
def centres(request: CentresRequest) -> int:
    """Show the instant centres of a position by the theorem of Aronhold and Kennedy, with the
    inflection circle, Bresse's circles and the centrodes of a link."""
    from reports.cli.commands import centres as verb

    return verb.run_centres(request, terminal())


Output = Annotated[Path, typer.Option("-o", "--output", help="Draw it: .svg in layers, or .pdf.")]


@dataclass(frozen=True)
class PositionsRequest:
    """What `positions` was asked for, as given."""

    scene: SceneName
    output: Output
    divisions: Annotated[int, typer.Option(min=2, max=360, help="Parts of the crank circle.")] = 12
    paper: PaperSize = "A4"


@command
def positions(request: PositionsRequest) -> int:
    """Draw the positions of a mechanism over a turn, with arcs and loci, to scale."""
    from reports.cli.commands import sheets as verb

    return verb.run_positions(request, terminal())
