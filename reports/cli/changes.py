"""The commands that compare engines with how they did before."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from reports.cli.application import Duration, Jobs, StepS, StepsPerTurn, command
from reports.output.console import terminal


@dataclass(frozen=True)
class DiffRequest:
    """What `diff` was asked for, as given.

    ``old`` and ``new`` are folders of `sweep -o` or of `verify -o`, in any combination: a profile
    is the variant of its name. ``format`` is what is printed, or what goes to ``output``, which
    is Markdown in any case.
    """

    old: Annotated[Path, typer.Argument(metavar="OLD", help="Folder of sweep -o or verify -o.")]
    new: Annotated[Path, typer.Argument(metavar="NEW", help="Folder to compare with it.")]
    factor: Annotated[float, typer.Option(help="Growth of an error that is no fault yet.")] = 1.1
    strict: Annotated[
        bool, typer.Option("--strict", help="Exit 1 for missing cells and changed scenes too.")
    ] = False
    old_version: Annotated[
        str | None, typer.Option(help="Engine version to take of OLD, where it holds several.")
    ] = None
    new_version: Annotated[str | None, typer.Option(help="The same of NEW.")] = None
    format: Annotated[str, typer.Option(metavar="text|md", help="What is printed.")] = "text"
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="Write Markdown, for a pull request.")
    ] = None
    junit: Annotated[Path | None, typer.Option(help="Write JUnit XML, a case per cell.")] = None


@command
def diff(request: DiffRequest) -> int:
    """Compare two stored runs; exit 1 when an error grew past the factor."""
    from reports.cli.commands import diff as verb

    return verb.run_diff(request, terminal())


@dataclass(frozen=True)
class HistoryRequest:
    """What `history` was asked for, as given; as of `verify` where the names are the same."""

    engine: Annotated[str, typer.Argument(metavar="ENGINE", help="Engine, such as mujoco.")]
    versions: Annotated[
        Sequence[str], typer.Argument(metavar="VERSION", help="Released versions of it.")
    ]
    scenes: Annotated[
        Sequence[str],
        typer.Option("--scene", help="Shipped name or file; may be repeated; all if none."),
    ] = ()
    profiles: Annotated[
        Sequence[str], typer.Option("--profile", help="Profile; default: tuned and as-shipped.")
    ] = ()
    dt_s: StepS = None
    steps_per_turn: StepsPerTurn = None
    turns: Annotated[float | None, typer.Option(help="Turns of the driver (default 2).")] = None
    free: Annotated[
        bool, typer.Option("--free", help="Let scenes go; those of free motion if none is named.")
    ] = False
    duration_s: Duration = None
    jobs: Jobs = 0
    cache: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Where environments and results are kept.")
    ] = None
    again: Annotated[bool, typer.Option("--again", help="Verify again; environments are kept.")] = (
        False
    )
    folder: Annotated[
        Path | None,
        typer.Option(
            "-o", "--output", metavar="DIR", help="Write tables and each version's verification."
        ),
    ] = None


@command
def history(request: HistoryRequest) -> int:
    """Run the same verification with several versions of an engine, and show what changed."""
    from reports.cli.commands import history as verb

    return verb.run_history(request, terminal(), terminal(stderr=True))
