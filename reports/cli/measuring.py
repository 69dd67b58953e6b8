"""The commands that measure speed against error, and show it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from reports.cli.application import (
    Duration,
    Engines,
    Forces,
    Jobs,
    SpringKind,
    app,
    command,
    guarded,
    seconds,
)
from reports.output.console import terminal


@dataclass(frozen=True)
class SweepRequest:
    """What `sweep` was asked for, as given."""

    folder: Annotated[Path, typer.Option("-o", "--output", help="Folder of the results.")]
    scenes: Annotated[
        Sequence[str],
        typer.Argument(metavar="SCENE", help="Shipped names or scene files; those of the study."),
    ] = ()
    study: Annotated[
        Path | None, typer.Option(help="Study file (.toml, .yaml); the shipped one if none.")
    ] = None
    engines: Engines = ()
    profiles: Annotated[
        Sequence[str], typer.Option("--profile", help="Profile, in place of the study's variants.")
    ] = ()
    steps_per_turn: Annotated[
        str | None, typer.Option(metavar="N,N,...", help="Steps in a turn, with commas.")
    ] = None
    turns: Annotated[float | None, typer.Option(help="Turns of the driver.")] = None
    settings: Annotated[
        Sequence[str],
        typer.Option("--set", metavar="ENGINE.SETTING=A,B", help="One variant per value."),
    ] = ()
    limit_s: Annotated[float, typer.Option(help="Longest time for a cell, in seconds.")] = 60.0
    memory_gb: Annotated[float, typer.Option(help="Most memory for a cell, in GB.")] = 2.0
    jobs: Jobs = 0
    dask: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="Run on the cluster of this scheduler.")
    ] = None
    timing: Annotated[bool, typer.Option(help="Time the cells after the error runs.")] = True
    keep_trajectories: Annotated[
        bool, typer.Option("--keep-trajectories", help="Keep the whole motion of every cell.")
    ] = False
    again: Annotated[
        bool, typer.Option("--again", help="Run cells again that timed out or crashed.")
    ] = False
    forces: Forces = False
    free: Annotated[
        bool, typer.Option("--free", help="Let scenes go; those of free motion if none is named.")
    ] = False
    dt_s: Annotated[
        str | None, typer.Option("--dt", metavar="S,S,...", help="Steps of free motion, seconds.")
    ] = None
    duration_s: Duration = None
    segments: Annotated[
        str | None,
        typer.Option(metavar="N,N,...", help="Of each elastic link, with commas (default 16)."),
    ] = None
    springs: SpringKind = None


@command
def sweep(request: SweepRequest) -> int:
    """Run a grid of scenes, engines, settings and steps; keep and time every cell."""
    from reports.cli.commands import sweep as verb

    return verb.sweep(request, terminal(), terminal(stderr=True))


@dataclass(frozen=True)
class TuneRequest:
    """What `tune` was asked for, as given."""

    scenes: Annotated[
        Sequence[str], typer.Argument(metavar="SCENE", help="Shipped names or scene files.")
    ]
    engine: Annotated[str, typer.Option(help="Engine whose settings are searched.")]
    target: Annotated[
        float, typer.Option(help="Error to reach, as a pure number: rad, lengths over L.")
    ]
    budget: Annotated[int, typer.Option(help="Trials in all, also of a resumed search.")] = 60
    seed: Annotated[int, typer.Option(help="The same seed finds the same settings.")] = 0
    turns: Annotated[float, typer.Option(help="Turns of the driver in a run.")] = 2.0
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="Keep the search (.db), to go on later.")
    ] = None
    limit_s: Annotated[float, typer.Option(help="Longest time for a run, in seconds.")] = 20.0
    timing: Annotated[bool, typer.Option(help="Time what was found beside the profile.")] = True


@command
def tune(request: TuneRequest) -> int:
    """Search an engine's settings for the cheapest that reach a target error."""
    from reports.cli.commands import tune as verb

    return verb.run_tune(request, terminal(), terminal(stderr=True))


@dataclass(frozen=True)
class AdviseRequest:
    """What `advise` was asked for, as given."""

    dt_s: Annotated[
        float,
        typer.Option(
            "--dt", metavar="SECONDS", parser=seconds, help="Frame time of your program, as 1/60."
        ),
    ]
    speed: Annotated[
        float, typer.Option(metavar="RAD_S", help="Speed of the driver; clockwise is negative.")
    ]
    target: Annotated[
        float, typer.Option(help="Error to reach, as a pure number: rad, lengths over L.")
    ]
    scenes: Annotated[
        Sequence[str],
        typer.Argument(
            metavar="SCENE", help="Shipped names or scene files; two usual ones if none."
        ),
    ] = ()
    engines: Engines = ()
    study: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Folder of sweep -o: what it covers is read from it."),
    ] = None
    turns: Annotated[float, typer.Option(help="Turns of the driver in a run.")] = 10.0
    jobs: Jobs = 0
    json: Annotated[Path | None, typer.Option(help="Write all of it as JSON.")] = None


@command
def advise(request: AdviseRequest) -> int:
    """Say what engines reach at your frame time, and how few sub-steps reach a target.

    The exit code is 0 where some settings reach it, 1 where none do.
    """
    from reports.cli.commands import advise as verb

    return verb.run_advise(request, terminal(), terminal(stderr=True))


@app.command()
def report(
    folder: Annotated[
        Path, typer.Argument(metavar="DIR", help="Folder of a sweep, or of hard cases.")
    ],
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", help="File to write (default report.html; md: none)."),
    ] = None,
    format_: Annotated[
        str, typer.Option("--format", metavar="html|md", help="A page, or text in Markdown.")
    ] = "html",
) -> None:
    """Write a sweep as one page that works offline, or as Markdown for a pull request."""
    with guarded():
        from reports.cli.commands import report as command

        code = command.run_report(folder, output, command.format_of(format_), terminal())
    raise typer.Exit(code)


@app.command()
def figures(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Folder of a sweep.")],
    output: Annotated[Path, typer.Option("-o", "--output", help="Folder for the figures.")],
    scene: Annotated[
        list[str] | None, typer.Option(help="Scene to draw; may be repeated; all if none.")
    ] = None,
    only: Annotated[
        list[str] | None, typer.Option(metavar="FIGURE", help="Figure to draw; may be repeated.")
    ] = None,
) -> None:
    """Draw the diagrams of a sweep as SVG and PDF, for a paper."""
    with guarded():
        from reports.cli.commands import figures as command

        code = command.run_figures(folder, output, terminal(), scene or (), only or ())
    raise typer.Exit(code)


@dataclass(frozen=True)
class StabilityRequest:
    """What the user asked for; ``at`` is one value of one case."""

    cases: Annotated[
        Sequence[str], typer.Argument(metavar="CASE", help="Hard cases; all if none.")
    ] = ()
    engines: Engines = ()
    profiles: Annotated[
        Sequence[str], typer.Option("--profile", help="Profile; may be repeated.")
    ] = ()
    at: Annotated[
        float | None, typer.Option(help="Only this value of the one case that is named.")
    ] = None
    folder: Annotated[
        Path | None, typer.Option("-o", "--output", help="Folder for matrix, table and page.")
    ] = None
    limit_s: Annotated[float, typer.Option(help="Longest time for a run, in seconds.")] = 120.0
    memory_gb: Annotated[float, typer.Option(help="Most memory for a run, in GB.")] = 4.0
    jobs: Jobs = 0
    forces: Forces = False
    free: Annotated[
        bool, typer.Option("--free", help="The cases of free motion, which are not among all.")
    ] = False
    elastic: Annotated[
        bool, typer.Option("--elastic", help="Those of elastic links, which are not among all.")
    ] = False


@command
def stability(request: StabilityRequest) -> int:
    """Grade the engines on hard cases, and find how far each holds them.

    The exit code is 0; with --at it is 1 where the value is not held.
    """
    from reports.cli.commands import stability as verb

    return verb.stability(request, terminal(), terminal(stderr=True))
