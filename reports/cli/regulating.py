"""The commands that tell how evenly a machine runs."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from reports.cli.application import command
from reports.cli.showing import SceneName
from reports.output.console import terminal

Output = Annotated[
    Path | None,
    typer.Option("-o", "--output", help="Write .csv, .parquet, .xlsx or .json, or a page, .html."),
]
Figures = Annotated[
    Path | None, typer.Option(metavar="DIR", help="Draw the cycle, as SVG and PDF.")
]


@dataclass(frozen=True)
class CycleRequest:
    """What `cycle` was asked for, as given."""

    scene: SceneName
    output: Output = None
    figures: Figures = None


@command
def cycle(request: CycleRequest) -> int:
    """Show the cycle that a machine repeats under its loads: extreme speeds, the coefficient of
    fluctuation, surplus of work, reduced inertia, power.

    A scene that is driven keeps its mean speed by a constant torque; one that is let go has its
    loads alone.
    """
    from reports.cli.commands import cycle as verb

    return verb.run_cycle(request, terminal())


@dataclass(frozen=True)
class FlywheelRequest:
    """What `flywheel` was asked for, as given. ``written`` is where the scene goes, ``free`` says
    that it is let go in it."""

    scene: SceneName
    delta: Annotated[
        float, typer.Option(help="Coefficient of fluctuation that is wanted, such as 0.02.")
    ]
    output: Output = None
    figures: Figures = None
    written: Annotated[
        Path | None,
        typer.Option("--write", metavar="FILE.toml", help="Write the scene with the flywheel."),
    ] = None
    free: Annotated[
        bool,
        typer.Option(
            "--free", help="With --write: let go in its cycle, the drive's torque as a load."
        ),
    ] = False


@command
def flywheel(request: FlywheelRequest) -> int:
    """Work out the flywheel on the driver for a coefficient of fluctuation, exact and as the
    textbooks approximate it, and the speed over the cycle with it and without."""
    from reports.cli.commands import flywheel as verb

    return verb.run_flywheel(request, terminal())
