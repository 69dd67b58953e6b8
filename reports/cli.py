"""The command line. What a command needs is imported inside it: `--help` loads no engine."""

from __future__ import annotations

import contextlib
import os
import sys
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, NoReturn

import typer

from models.errors import CrankcheckError
from reports.stopping import Stopped, broken_pipe_ends, install, seen
from reports.terminal import UNWRITABLE, give_up_output, readable_everywhere, terminal

app = typer.Typer(
    name="crankcheck",
    help="Hold physics engines to the closed form of planar closed-loop mechanisms.",
    epilog="Exit codes: 0 all within tolerance, 1 out of tolerance, 2 bad input or usage, 70 a "
    "fault of crankcheck itself, 130 interrupted, 141 nobody reads the output, 143 terminated.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
BAD_INPUT, INTERNAL, INTERRUPTED, BROKEN_PIPE = 2, 70, 130, 141
TRACEBACK = "CRANKCHECK_TRACEBACK"

SceneName = Annotated[str, typer.Argument(metavar="SCENE", help="A shipped name, or a scene file.")]


def main() -> None:
    """The entry of the command `crankcheck`."""
    with guarded():
        install()
        broken_pipe_ends(at_once=True)
        if sys.stdout is None:
            raise CrankcheckError("standard output is closed; send it to a file, or to /dev/null")
        readable_everywhere()
        try:
            app()
        finally:
            sys.stdout.flush()


@contextmanager
def guarded() -> Iterator[None]:
    """Every end but a verdict: one line, and an exit code that tells whose fault it is."""
    try:
        yield
    except CrankcheckError as error:
        _end(BAD_INPUT, str(error))
    except Stopped as stopped:
        _end(stopped.code, stopped.word)
    except KeyboardInterrupt:
        _end(INTERRUPTED, "interrupted")
    except BrokenPipeError:
        give_up_output()
        raise SystemExit(BROKEN_PIPE) from None
    except Exception as error:
        if isinstance(error, OSError) and error.errno in UNWRITABLE and error.filename is None:
            give_up_output()
            _end(
                BAD_INPUT, f"standard output can not be written: {error.strerror}; free some space"
            )
        if os.environ.get(TRACEBACK):
            traceback.print_exc()
        first = str(error).partition("\n")[0][:300]
        _end(
            INTERNAL,
            f"internal error: {type(error).__name__}: {first}; please report it; "
            f"--traceback or {TRACEBACK}=1 shows where it is",
        )


def _end(code: int, text: str) -> NoReturn:
    """The last line, where it can be written, and the exit code; a signal goes before all else."""
    if stopped := seen():
        code, text = stopped.code, stopped.word
    with contextlib.suppress(OSError):
        typer.echo(f"crankcheck: {text}", err=True)
    raise SystemExit(code) from None


def _version(wanted: bool) -> None:
    if wanted:
        from reports.provenance import crankcheck_version

        typer.echo(f"crankcheck {crankcheck_version()}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version.")
    ] = False,
    show_traceback: Annotated[
        bool, typer.Option("--traceback", help="Show where an internal error is.")
    ] = False,
) -> None:
    """Options of the command itself."""
    broken_pipe_ends(at_once=False)
    if show_traceback:
        os.environ[TRACEBACK] = "1"


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
) -> None:
    """Run scenes in engines and hold them to the closed form; exit 1 when out of tolerance."""
    with guarded():
        from reports.commands import verify as command

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
        )
        code = command.verify(request, terminal(), terminal(stderr=True))
    raise typer.Exit(code)


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


@app.command()
def solve(
    scene: SceneName,
    at_deg: Annotated[
        float | None, typer.Option(metavar="DEG", help="One position: the driver's angle.")
    ] = None,
    turns: Annotated[
        float | None, typer.Option(help="A motion over so many turns (default 1).")
    ] = None,
    steps_per_turn: Annotated[
        int | None, typer.Option(help="Samples in a turn (default 12, in a file 360).")
    ] = None,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="Write .csv, .parquet or .xlsx.")
    ] = None,
) -> None:
    """Show the closed-form reference alone: angles, points and sliders with all their rates."""
    with guarded():
        from reports.commands import solve as command

        request = command.Request(scene, at_deg, turns, steps_per_turn, output)
        command.run_solve(request, terminal())


@app.command()
def export(
    scene: SceneName,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="Write an .xml file.")
    ] = None,
    close: Annotated[
        list[str] | None,
        typer.Option(metavar="PIN", help="Close a loop at this pin; may be repeated."),
    ] = None,
) -> None:
    """Write the scene as MJCF, assembled, with its state as the keyframe."""
    with guarded():
        from reports.commands import listing

        listing.export(scene, output, tuple(close or ()), terminal())


@app.command()
def scenes() -> None:
    """List the shipped scenes with their structure, driver and source."""
    with guarded():
        from reports.commands import listing

        listing.scenes(terminal())


@app.command()
def engines(
    settings: Annotated[
        bool, typer.Option("--settings", help="Show every setting with its reason.")
    ] = False,
) -> None:
    """List the engines with their version, or the command that installs them, and profiles."""
    with guarded():
        from reports.commands import listing

        listing.engines(terminal(), settings)


@app.command()
def view(
    scene: SceneName,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", help="Draw into a .gif or .png in place of the viewer."),
    ] = None,
) -> None:
    """Open MuJoCo's viewer, or, without a screen or with -o, draw the motion into a file."""
    with guarded():
        from reports.commands import view as command

        command.run_view(scene, output, terminal())


if __name__ == "__main__":
    main()
