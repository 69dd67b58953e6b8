"""The command of synthesis."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from reports.cli.application import Engines, command
from reports.cli.drawing_sheets import PaperSize
from reports.output.console import terminal


@dataclass(frozen=True)
class SynthRequest:
    """What `synth` was asked for, as given."""

    kind: Annotated[
        str | None, typer.Argument(metavar="KIND", help="What kind of task; none lists them.")
    ] = None
    task: Annotated[
        str | None, typer.Argument(metavar="TASK", help="A shipped task, or a task file (.toml).")
    ] = None
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="DIR", help="Folder of scenes, tables, figures."),
    ] = None
    best: Annotated[
        int, typer.Option(min=1, max=1000, help="So many of the solutions are listed and written.")
    ] = 5
    prove: Annotated[
        bool, typer.Option("--prove", help="Run each in every engine, through what is asked.")
    ] = False
    engines: Engines = ()
    profiles: Annotated[
        Sequence[str], typer.Option("--profile", help="Profile of the engines; default: tuned.")
    ] = ()
    steps_per_turn: Annotated[
        float, typer.Option(min=24, max=1e5, help="Steps in a turn of the proof.")
    ] = 720.0
    vary_m: Annotated[
        float | None,
        typer.Option(
            "--vary",
            metavar="METRES",
            min=1e-9,
            max=1e6,
            help="What dimensions that are off by up to so much do, and clearances.",
        ),
    ] = None
    paper: PaperSize = "A4"


@command
def synth(request: SynthRequest) -> int:
    """Find the mechanisms that do a task: their scenes, defects, figure, and proof in engines.

    Exit code 1: no solution without a defect, or with --prove one that an engine does not lead
    through what is asked.
    """
    from reports.cli.commands import synth as verb

    return verb.run_synth(request, terminal())
