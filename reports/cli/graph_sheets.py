"""The command that draws graphs with ruler and pole."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from reports.cli.application import Duration, command
from reports.cli.drawing_sheets import PaperSize
from reports.cli.showing import SceneName
from reports.output.console import terminal


@dataclass(frozen=True)
class GraphRequest:
    """What `graph` was asked for, as given."""

    scene: SceneName
    of: Annotated[
        str, typer.Option("--of", metavar="NAME", help="A link, a slider, or a coordinate: C.x.")
    ]
    divisions: Annotated[
        str,
        typer.Option(metavar="N[,N...]", help="Parts of the period; of several, the errors."),
    ] = "24"
    by: Annotated[
        str, typer.Option(help="chords, tangents, or integration (of the acceleration).")
    ] = "chords"
    over: Annotated[str, typer.Option(help="time, or angle of the driver.")] = "time"
    log: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="A log of an engine, drawn the same way beside it."),
    ] = None
    map: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="TOML that says what its columns mean."),
    ] = None
    duration_s: Duration = None
    paper: PaperSize = "A4"
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="Draw it: .svg in layers, or .pdf.")
    ] = None


@command
def graph(request: GraphRequest) -> int:
    """Draw an angle, a displacement or a coordinate over a period with its rates, each from the
    other with ruler and pole, beside the exact curves.

    Without -o the table is shown that is drawn first, and what is drawn from it.
    """
    from reports.cli.commands import graph as verb

    return verb.run_graph(request, terminal())
