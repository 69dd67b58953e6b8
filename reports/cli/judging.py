"""The command that judges a user's own log."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from reports.cli.application import SegmentCount, SpringKind, command, seconds
from reports.cli.showing import SceneName
from reports.output.console import terminal


@dataclass(frozen=True)
class JudgeRequest:
    """What `judge` was asked for, as given."""

    scene: SceneName
    log: Annotated[
        Path, typer.Argument(metavar="LOG", help="Your log: .csv, .tsv, .txt, .parquet or .xlsx.")
    ]
    map: Annotated[
        Path | None, typer.Option(metavar="FILE", help="TOML that says what columns mean.")
    ] = None
    write_map: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Write the map of what was understood, and end."),
    ] = None
    drive: Annotated[
        str,
        typer.Option(help="scene, fitted (speed and start), or logged (geometry at its angle)."),
    ] = "scene"
    step_s: Annotated[
        float | None,
        typer.Option("--step", metavar="SECONDS", parser=seconds, help="Step of the solver."),
    ] = None
    target: Annotated[
        Sequence[str],
        typer.Option(
            metavar="NUMBER", help="Largest pure error, such as 1e-3 or angle=1e-4; repeatable."
        ),
    ] = ()
    require: Annotated[
        Sequence[str],
        typer.Option(metavar="NAME", help="Quantity or body that has to be in the log."),
    ] = ()
    format: Annotated[str, typer.Option(metavar="text|md", help="What is printed.")] = "text"
    json: Annotated[Path | None, typer.Option(help="Write errors and findings as JSON.")] = None
    junit: Annotated[Path | None, typer.Option(help="Write JUnit XML, a case per error.")] = None
    output: Annotated[Path | None, typer.Option("-o", "--output", help="Write a page, .html.")] = (
        None
    )
    free: Annotated[
        bool, typer.Option("--free", help="It is of the driven scene, let go at time 0.")
    ] = False
    forces: Annotated[
        bool, typer.Option("--forces", help="Judge its columns of forces and torque as well.")
    ] = False
    segments: SegmentCount = None
    springs: SpringKind = None


@command
def judge(request: JudgeRequest) -> int:
    """Hold a log of your own to the closed form; exit 1 when out of tolerance."""
    from reports.cli.commands import judge as verb

    return verb.run_judge(request, terminal())
