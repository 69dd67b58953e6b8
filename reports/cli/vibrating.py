"""The command that tells how elastic links vibrate."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from reports.cli.application import command
from reports.cli.showing import SceneName
from reports.output.console import terminal


@dataclass(frozen=True)
class VibrationRequest:
    """What `vibration` was asked for, as given."""

    scene: SceneName
    speeds: Annotated[
        str | None,
        typer.Option(
            metavar="FROM:TO:COUNT", help="Over speeds of the driver [rad/s], such as 5:40:200."
        ),
    ] = None
    map_link: Annotated[
        str | None,
        typer.Option(
            "--map",
            metavar="LINK",
            help="Over speeds and over the inertia of a rigid link or of a slider's block.",
        ),
    ] = None
    factors: Annotated[
        str | None,
        typer.Option(
            metavar="FROM:TO:COUNT",
            help="With --map: how many times as heavy (default 0.1:10:9, in equal ratios).",
        ),
    ] = None
    modes: Annotated[
        int | None,
        typer.Option(min=1, max=40, help="Modes of each link (default 5, over speeds 3)."),
    ] = None
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="DIR", help="Write tables, JSON and figures."),
    ] = None


@command
def vibration(request: VibrationRequest) -> int:
    """Show how elastic links vibrate at the driver's speed, or over speeds: natural frequencies,
    deflection, stability, resonances.

    A resonance, where there is no periodic motion to tell, ends with exit code 2.
    """
    from reports.cli.commands import vibration as verb

    return verb.run_vibration(request, terminal())
