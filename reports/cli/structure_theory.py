"""The command that tells which links turn fully, and what a mechanism can be brought to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

import typer

from reports.cli.application import command
from reports.cli.showing import SceneName
from reports.output.console import terminal


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
