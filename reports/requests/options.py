"""Options that several requests have."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

import typer

from models.errors import shown


def seconds(text: str) -> float:
    """A number of seconds, such as 0.02 or 1/60. Raises typer.BadParameter for what is none."""
    number, slash, parts = text.partition("/")
    try:
        return float(number) / float(parts) if slash else float(number)
    except (ValueError, ZeroDivisionError):
        raise typer.BadParameter(
            f"{shown(text)} is no number of seconds; write it like 0.02, or 1/60"
        ) from None


SceneName = Annotated[str, typer.Argument(metavar="SCENE", help="A shipped name, or a scene file.")]
Engines = Annotated[Sequence[str], typer.Option("--engine", help="Engine; may be repeated.")]
StepS = Annotated[
    float | None,
    typer.Option("--dt", metavar="SECONDS", parser=seconds, help="Time step, such as 1/60."),
]
StepsPerTurn = Annotated[
    float | None, typer.Option(help="Steps in a turn, in place of --dt (default 720).")
]
Duration = Annotated[
    float | None,
    typer.Option("--duration", metavar="SECONDS", help="Of free motion; default: the scene's."),
]
Forces = Annotated[
    bool, typer.Option("--forces", help="Reactions, moments and driving torque as well.")
]
SegmentCount = Annotated[
    int | None,
    typer.Option("--segments", metavar="N", help="Of each elastic link in an engine (default 16)."),
]
SpringKind = Annotated[
    str | None,
    typer.Option(
        "--springs",
        help="Between segments: plain (default), corrected for the sag; beam: an engine's own.",
    ),
]
Jobs = Annotated[int, typer.Option(min=0, max=1024, help="Processes; 0: one per processor.")]
PaperSize = Annotated[
    str, typer.Option(metavar="SIZE", help="A5, A4, A3, A2, or WIDTHxHEIGHT in mm.")
]
