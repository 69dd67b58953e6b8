"""The commands that measure speed against error, and show it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from reports.cli.base import app, guarded
from reports.output.console import terminal


@app.command()
def sweep(
    output: Annotated[Path, typer.Option("-o", "--output", help="Folder of the results.")],
    scenes: Annotated[
        list[str] | None,
        typer.Argument(metavar="SCENE", help="Shipped names or scene files; those of the study."),
    ] = None,
    study: Annotated[
        Path | None, typer.Option(help="Study file (.toml, .yaml); the shipped one if none.")
    ] = None,
    engine: Annotated[list[str] | None, typer.Option(help="Engine; may be repeated.")] = None,
    profile: Annotated[
        list[str] | None, typer.Option(help="Profile, in place of the study's variants.")
    ] = None,
    steps_per_turn: Annotated[
        str | None, typer.Option(metavar="N,N,...", help="Steps in a turn, with commas.")
    ] = None,
    turns: Annotated[float | None, typer.Option(help="Turns of the driver.")] = None,
    settings: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="ENGINE.SETTING=A,B", help="One variant per value."),
    ] = None,
    limit_s: Annotated[float, typer.Option(help="Longest time for a cell, in seconds.")] = 60.0,
    memory_gb: Annotated[float, typer.Option(help="Most memory for a cell, in GB.")] = 2.0,
    jobs: Annotated[int, typer.Option(min=0, help="Processes; 0: one per processor.")] = 0,
    dask: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="Run on the cluster of this scheduler.")
    ] = None,
    timing: Annotated[bool, typer.Option(help="Time the cells after the error runs.")] = True,
    keep_trajectories: Annotated[
        bool, typer.Option("--keep-trajectories", help="Keep the whole motion of every cell.")
    ] = False,
    again: Annotated[
        bool, typer.Option("--again", help="Run cells again that timed out or crashed.")
    ] = False,
) -> None:
    """Run a grid of scenes, engines, settings and steps; keep and time every cell."""
    with guarded():
        from reports.cli.commands import sweep as command

        request = command.Request(
            folder=output,
            study=study,
            scenes=scenes or (),
            engines=engine or (),
            profiles=profile or (),
            steps_per_turn=steps_per_turn,
            turns=turns,
            settings=settings or (),
            limit_s=limit_s,
            memory_gb=memory_gb,
            jobs=jobs,
            dask=dask,
            timing=timing,
            keep_trajectories=keep_trajectories,
            again=again,
        )
        code = command.sweep(request, terminal(), terminal(stderr=True))
    raise typer.Exit(code)


@app.command()
def tune(
    scenes: Annotated[
        list[str], typer.Argument(metavar="SCENE", help="Shipped names or scene files.")
    ],
    engine: Annotated[str, typer.Option(help="Engine whose settings are searched.")],
    target: Annotated[
        float, typer.Option(help="Error to reach, as a pure number: rad, lengths over L.")
    ],
    budget: Annotated[int, typer.Option(help="Trials in all, also of a resumed search.")] = 60,
    seed: Annotated[int, typer.Option(help="The same seed finds the same settings.")] = 0,
    turns: Annotated[float, typer.Option(help="Turns of the driver in a run.")] = 2.0,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="Keep the search (.db), to go on later.")
    ] = None,
    limit_s: Annotated[float, typer.Option(help="Longest time for a run, in seconds.")] = 20.0,
    timing: Annotated[bool, typer.Option(help="Time what was found beside the profile.")] = True,
) -> None:
    """Search an engine's settings for the cheapest that reach a target error."""
    with guarded():
        from reports.cli.commands import tune as command

        request = command.Request(
            scenes=scenes,
            engine=engine,
            target=target,
            budget=budget,
            seed=seed,
            turns=turns,
            output=output,
            limit_s=limit_s,
            timing=timing,
        )
        code = command.run_tune(request, terminal(), terminal(stderr=True))
    raise typer.Exit(code)


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


@app.command()
def stability(
    cases: Annotated[
        list[str] | None, typer.Argument(metavar="CASE", help="Hard cases; all if none.")
    ] = None,
    engine: Annotated[list[str] | None, typer.Option(help="Engine; may be repeated.")] = None,
    profile: Annotated[list[str] | None, typer.Option(help="Profile; may be repeated.")] = None,
    at: Annotated[
        float | None, typer.Option(help="Only this value of the one case that is named.")
    ] = None,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="Folder for matrix, table and page.")
    ] = None,
    limit_s: Annotated[float, typer.Option(help="Longest time for a run, in seconds.")] = 120.0,
    memory_gb: Annotated[float, typer.Option(help="Most memory for a run, in GB.")] = 4.0,
    jobs: Annotated[int, typer.Option(min=0, help="Processes; 0: one per processor.")] = 0,
) -> None:
    """Grade the engines on hard cases, and find how far each holds them.

    The exit code is 0; with --at it is 1 where the value is not held.
    """
    with guarded():
        from reports.cli.commands import stability as command

        request = command.Request(
            cases=cases or (),
            engines=engine or (),
            profiles=profile or (),
            at=at,
            folder=output,
            jobs=jobs,
            limit_s=limit_s,
            memory_gb=memory_gb,
        )
        code = command.stability(request, terminal(), terminal(stderr=True))
    raise typer.Exit(code)
