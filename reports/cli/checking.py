"""The commands that hold engines to the reference, and to how they did before."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from reports.cli.base import app, guarded
from reports.output.console import terminal


@app.command()
def verify(
    scenes: Annotated[
        list[str] | None,
        typer.Argument(metavar="SCENE", help="Shipped names or scene files; all if none."),
    ] = None,
    engine: Annotated[list[str] | None, typer.Option(help="Engine; may be repeated.")] = None,
    profile: Annotated[
        list[str] | None,
        typer.Option(help="Profile, gated; default: tuned gated, as-shipped shown."),
    ] = None,
    dt: Annotated[float | None, typer.Option(metavar="SECONDS", help="Time step.")] = None,
    steps_per_turn: Annotated[
        float | None, typer.Option(help="Steps in a turn, in place of --dt (default 720).")
    ] = None,
    turns: Annotated[float, typer.Option(help="Turns (periods) of the driver.")] = 2.0,
    tol: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME=NUMBER", help="Tolerance as a pure number, such as angle=1e-4."),
    ] = None,
    drive: Annotated[str, typer.Option(help="prescribed or servo.")] = "prescribed",
    convergence: Annotated[
        bool, typer.Option(help="Run at half and quarter step too, and say what the error does.")
    ] = True,
    jobs: Annotated[int, typer.Option(min=0, help="Processes; 0: one per processor.")] = 0,
    junit: Annotated[Path | None, typer.Option(help="Write JUnit XML.")] = None,
    csv: Annotated[Path | None, typer.Option(help="Write the cells as CSV.")] = None,
    json: Annotated[Path | None, typer.Option(help="Write cells and findings as JSON.")] = None,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="Write all of them into a folder.")
    ] = None,
    baseline: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Folder of an earlier run; exit 1 when worse than it."),
    ] = None,
    factor: Annotated[
        float, typer.Option(help="Growth over the baseline that is no fault yet.")
    ] = 1.1,
) -> None:
    """Run scenes in engines and hold them to the closed form; exit 1 when out of tolerance."""
    with guarded():
        from reports.cli.commands import verify as command

        request = command.Request(
            scenes=scenes or (),
            engines=engine or (),
            profiles=profile or (),
            dt_s=dt,
            steps_per_turn=steps_per_turn,
            turns=turns,
            tolerance=tol or (),
            drive=drive,
            converge=convergence,
            jobs=jobs,
            junit=junit,
            csv=csv,
            json=json,
            folder=output,
            baseline=baseline,
            factor=factor,
        )
        code = command.verify(request, terminal(), terminal(stderr=True))
    raise typer.Exit(code)


@app.command()
def diff(
    old: Annotated[Path, typer.Argument(metavar="OLD", help="Folder of sweep -o or verify -o.")],
    new: Annotated[Path, typer.Argument(metavar="NEW", help="Folder to compare with it.")],
    factor: Annotated[float, typer.Option(help="Growth of an error that is no fault yet.")] = 1.1,
    strict: Annotated[
        bool, typer.Option("--strict", help="Exit 1 for missing cells and changed scenes too.")
    ] = False,
    old_version: Annotated[
        str | None, typer.Option(help="Engine version to take of OLD, where it holds several.")
    ] = None,
    new_version: Annotated[str | None, typer.Option(help="The same of NEW.")] = None,
    format_: Annotated[
        str, typer.Option("--format", metavar="text|md", help="What is printed.")
    ] = "text",
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="Write Markdown, for a pull request.")
    ] = None,
    junit: Annotated[Path | None, typer.Option(help="Write JUnit XML, a case per cell.")] = None,
) -> None:
    """Compare two stored runs; exit 1 when an error grew past the factor."""
    with guarded():
        from reports.cli.commands import diff as command

        request = command.Request(
            old=old,
            new=new,
            factor=factor,
            strict=strict,
            old_version=old_version,
            new_version=new_version,
            format=format_,
            output=output,
            junit=junit,
        )
        code = command.run_diff(request, terminal())
    raise typer.Exit(code)


@app.command()
def history(
    engine: Annotated[str, typer.Argument(metavar="ENGINE", help="Engine, such as mujoco.")],
    versions: Annotated[
        list[str], typer.Argument(metavar="VERSION", help="Released versions of it.")
    ],
    scene: Annotated[
        list[str] | None, typer.Option(help="Shipped name or file; may be repeated; all if none.")
    ] = None,
    profile: Annotated[
        list[str] | None, typer.Option(help="Profile; default: tuned and as-shipped.")
    ] = None,
    dt: Annotated[float | None, typer.Option(metavar="SECONDS", help="Time step.")] = None,
    steps_per_turn: Annotated[
        float | None, typer.Option(help="Steps in a turn, in place of --dt (default 720).")
    ] = None,
    turns: Annotated[float, typer.Option(help="Turns (periods) of the driver.")] = 2.0,
    jobs: Annotated[int, typer.Option(min=0, help="Processes; 0: one per processor.")] = 0,
    cache: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Where environments and results are kept.")
    ] = None,
    again: Annotated[
        bool, typer.Option("--again", help="Verify again; environments are kept.")
    ] = False,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o", "--output", metavar="DIR", help="Write tables and each version's verification."
        ),
    ] = None,
) -> None:
    """Run the same verification with several versions of an engine, and show what changed."""
    with guarded():
        from reports.cli.commands import history as command

        request = command.Request(
            engine=engine,
            versions=versions,
            scenes=scene or (),
            profiles=profile or (),
            dt_s=dt,
            steps_per_turn=steps_per_turn,
            turns=turns,
            jobs=jobs,
            cache=cache,
            again=again,
            folder=output,
        )
        code = command.run_history(request, terminal(), terminal(stderr=True))
    raise typer.Exit(code)


@app.command()
def selftest(
    engine: Annotated[
        list[str] | None, typer.Option(help="Engine; may be repeated; all if none.")
    ] = None,
    fault: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="Fault of the table; may be repeated; all if none."),
    ] = None,
    jobs: Annotated[int, typer.Option(min=0, help="Processes; 0: one per processor.")] = 0,
    csv: Annotated[Path | None, typer.Option(help="Write a row per fault and place.")] = None,
    json: Annotated[Path | None, typer.Option(help="Write the same and more as JSON.")] = None,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="Write both into a folder.")
    ] = None,
) -> None:
    """Plant faults in healthy runs, and see that the right rule catches each; exit 1 if not."""
    with guarded():
        from reports.cli.commands import selftest as command

        request = command.Request(
            engines=engine or (),
            faults=fault or (),
            jobs=jobs,
            csv=csv,
            json=json,
            folder=output,
        )
        code = command.selftest(request, terminal(), terminal(stderr=True))
    raise typer.Exit(code)
