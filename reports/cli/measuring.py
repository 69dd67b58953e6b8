"""The commands that measure speed against error, and show it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from reports.cli.base import app, guarded
from reports.terminal import terminal


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
) -> None:
    """Run a grid of scenes, engines, settings and steps; keep and time every cell."""
    with guarded():
        from reports.commands import sweep as command

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
        )
        code = command.sweep(request, terminal(), terminal(stderr=True))
    raise typer.Exit(code)
