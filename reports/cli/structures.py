"""The commands of structure: chains, what a scene is made of, and what it can be brought to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from reports.cli.application import command
from reports.cli.drawing_sheets import PaperSize
from reports.cli.showing import SceneName
from reports.output.console import terminal


@dataclass(frozen=True)
class ChainsRequest:
    """What `chains` was asked for, as given."""

    links: Annotated[int, typer.Option(metavar="N", help="Links, the ground with them.")] = 6
    mobility: Annotated[int, typer.Option(metavar="W", help="Their mobility.")] = 1
    inversions: Annotated[
        bool, typer.Option("--inversions", help="The mechanisms: each link as the ground.")
    ] = False
    sliders: Annotated[
        int | None,
        typer.Option(metavar="K", help="Type synthesis: up to so many of the pins are sliders."),
    ] = None
    paper: PaperSize = "A4"
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="Draw them: .svg in layers, or .pdf.")
    ] = None


@command
def chains(request: ChainsRequest) -> int:
    """List and draw the distinct kinematic chains of so many links: number synthesis, their
    inversions with the class of each, and their types with sliders."""
    from reports.cli.commands import chains as verb

    return verb.run_chains(request, terminal())


@dataclass(frozen=True)
class StructureRequest:
    """What `structure` was asked for, as given."""

    scene: SceneName
    at_deg: Annotated[
        float | None,
        typer.Option(metavar="DEG", help="The driver's angle; default: where the scene starts."),
    ] = None
    at_m: Annotated[
        float | None, typer.Option(metavar="M", help="The place of a slider that drives.")
    ] = None
    paper: PaperSize = "A4"
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", help="Draw all assemblies: .svg in layers, or .pdf."),
    ] = None


@command
def structure(request: StructureRequest) -> int:
    """Show what a scene is made of: links and joints, mobility, Assur groups with class and order,
    the class with every other joint as the driver, and all its assemblies at one place."""
    from reports.cli.commands import structure as verb

    return verb.run_structure(request, terminal())


@dataclass(frozen=True)
class RotatabilityRequest:
    """What `rotatability` was asked for, as given."""

    scene: SceneName
    position: Annotated[
        Sequence[str],
        typer.Option(
            metavar="DEG[:SIGNS]",
            help="A position, such as 90 or 90:+-, signs by dyad in solving order; repeatable: "
            "whether the driver leads through all in this order.",
        ),
    ] = ()
    json: Annotated[bool, typer.Option("--json", help="As JSON, not as tables.")] = False


@command
def rotatability(request: RotatabilityRequest) -> int:
    """Show which links turn fully and how far others swing, the Grashof type, circuits and
    branches, dead points and transmission angles.

    Exit code 1: the driver does not lead through the positions asked for (a defect of branch,
    circuit or order).
    """
    from reports.cli.commands import rotatability as verb

    return verb.run_rotatability(request, terminal())
