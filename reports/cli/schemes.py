"""The commands about structure before dimensions: classes of joints, and mobility of schemes."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from reports.cli.application import command
from reports.output.console import terminal


@dataclass(frozen=True)
class JointRequest:
    """What `joint` was asked for, as given."""

    joint: Annotated[
        str | None,
        typer.Argument(metavar="NAME", help="A shipped name, or a file; all are listed if none."),
    ] = None


@command
def joint(request: JointRequest) -> int:
    """Say the class of a joint, whether it is a lower or a higher pair, and its freedoms by name,
    from how its two links touch."""
    from reports.cli.commands import joint as verb

    verb.run_joint(request, terminal())
    return 0


@dataclass(frozen=True)
class MobilityRequest:
    """What `mobility` was asked for, as given."""

    scheme: Annotated[
        str | None,
        typer.Argument(metavar="NAME", help="A shipped name, or a file; all are listed if none."),
    ] = None
    replace: Annotated[
        bool,
        typer.Option("--replace", help="Links with lower pairs in place of planar higher pairs."),
    ] = False
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", help="With --replace: write that scheme as .toml."),
    ] = None


@command
def mobility(request: MobilityRequest) -> int:
    """Count the motions of a planar or spatial scheme, and say by name which constraints are
    passive and which freedoms idle, from the rank of its equations."""
    from reports.cli.commands import mobility as verb

    verb.run_mobility(request, terminal())
    return 0
