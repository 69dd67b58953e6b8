"""The commands that show scenes, engines, the reference alone, and one run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from reports.cli.application import (
    Duration,
    Forces,
    Jobs,
    SegmentCount,
    SpringKind,
    StepS,
    StepsPerTurn,
    app,
    command,
    guarded,
)
from reports.output.console import terminal

SceneName = Annotated[str, typer.Argument(metavar="SCENE", help="A shipped name, or a scene file.")]


@dataclass(frozen=True)
class SolveRequest:
    """What `solve` was asked for, as given."""

    scene: SceneName
    at_deg: Annotated[
        float | None, typer.Option(metavar="DEG", help="One position: the driver's angle.")
    ] = None
    at_m: Annotated[
        float | None,
        typer.Option(metavar="M", help="One position: the displacement of a slider that drives."),
    ] = None
    turns: Annotated[
        float | None, typer.Option(help="A motion over so many turns (default 1).")
    ] = None
    steps_per_turn: Annotated[
        int | None, typer.Option(help="Samples in a turn (default 12, in a file 360).")
    ] = None
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", help="Write .csv, .parquet or .xlsx, or a page, .html."),
    ] = None
    duration: Annotated[
        float | None,
        typer.Option(metavar="S", help="Free motion: for how long (default the scene's own)."),
    ] = None
    steps: Annotated[
        int | None,
        typer.Option(metavar="N", help="Free motion: samples in it (default 12, in a file 1000)."),
    ] = None
    clockwise: Annotated[
        bool, typer.Option("--clockwise", help="With --at-deg: the driver turning clockwise there.")
    ] = False
    along: Annotated[
        Sequence[str],
        typer.Option(metavar="POINT:DEG", help="Stroke of a point along a direction; repeatable."),
    ] = ()
    forces: Annotated[
        bool, typer.Option("--forces", help="The reactions and the driving torque as well.")
    ] = False
    figures: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            help="With --forces: draw them over a turn; or a free motion, or elastic links; as SVG "
            "and PDF.",
        ),
    ] = None
    modes: Annotated[
        int | None,
        typer.Option(metavar="N", help="Elastic links: sines across each."),
    ] = None
    axial_modes: Annotated[
        int | None,
        typer.Option(metavar="N", help="Elastic links: sines along each."),
    ] = None
    elements: Annotated[
        int | None,
        typer.Option(metavar="N", help="Elastic links: beam elements of each."),
    ] = None
    shape: Annotated[
        str | None,
        typer.Option(
            help="Elastic links start periodic, quasi-static or straight (default the scene's own)."
        ),
    ] = None
    linear: Annotated[
        bool,
        typer.Option("--linear", help="Elastic links: leave out that a bent link is shorter."),
    ] = False
    family: Annotated[
        str | None,
        typer.Option(
            metavar="NAME=A,B,...",
            help="With -o FILE.xlsx, .html, .svg or .pdf: mechanisms that differ in a number, such "
            "as a length.",
        ),
    ] = None

    @property
    def at_place(self) -> str:
        """The option by which one position was asked for; "" where a motion was."""
        if self.at_deg is None and self.at_m is None:
            return ""
        return f"--at-m {self.at_m:g}" if self.at_deg is None else f"--at-deg {self.at_deg:g}"


@command
def solve(request: SolveRequest) -> int:
    """Show the reference alone: angles, points and sliders with all their rates, and the forces
    that these ask for; of a scene that is let go, its free motion and energy; of one with elastic
    links, how these bend, and what that changes."""
    from reports.cli.commands import solve as verb

    verb.run_solve(request, terminal())
    return 0


@dataclass(frozen=True)
class RunRequest:
    """What `run` was asked for, as given."""

    scene: SceneName
    engine: Annotated[
        str | None, typer.Option(help="Engine; the first of `crankcheck engines` if none.")
    ] = None
    profile: Annotated[str, typer.Option(help="Profile of the engine.")] = "tuned"
    dt_s: StepS = None
    steps_per_turn: StepsPerTurn = None
    turns: Annotated[float | None, typer.Option(help="Turns of the driver (default 2).")] = None
    duration_s: Duration = None
    every: Annotated[int, typer.Option(metavar="N", help="Log every N-th step.")] = 1
    drive: Annotated[
        str | None,
        typer.Option(
            help="prescribed, servo, or free (nothing drives it); default free for a scene that is "
            "let go, else prescribed."
        ),
    ] = None
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="Write .csv, .parquet or .xlsx.")
    ] = None
    forces: Forces = False
    segments: SegmentCount = None
    springs: SpringKind = None


@command
def run(request: RunRequest) -> int:
    """Run a scene in an engine and write its log; exit 1 when the run did not end well."""
    from reports.cli.commands import run as verb

    return verb.run_run(request, terminal())


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
        from reports.cli.commands import listing

        listing.export(scene, output, tuple(close or ()), terminal())


@app.command()
def scenes() -> None:
    """List the shipped scenes with their structure, driver and source."""
    with guarded():
        from reports.cli.commands import listing

        listing.scenes(terminal())


engines_app = typer.Typer(invoke_without_command=True)
app.add_typer(engines_app, name="engines")


@engines_app.callback()
def engines(
    context: typer.Context,
    settings: Annotated[
        bool, typer.Option("--settings", help="Show every setting with its reason.")
    ] = False,
) -> None:
    """List the engines with their version, or the command that installs them, and profiles."""
    if context.invoked_subcommand is None:
        with guarded():
            from reports.cli.commands import listing

            listing.engines(terminal(), settings)


@dataclass(frozen=True)
class EngineCheckRequest:
    """What `engines check` was asked for, as given."""

    name: Annotated[
        str,
        typer.Argument(metavar="ENGINE", help="A name, or one of your own, package.module:ENGINE."),
    ]
    clauses: Annotated[
        Sequence[str],
        typer.Option("--clause", metavar="ID", help="Clause; may be repeated; all if none."),
    ] = ()
    limit_s: Annotated[float, typer.Option(help="Longest time for a clause, in seconds.")] = 60.0
    jobs: Jobs = 0


@partial(command, of=engines_app)
def check(request: EngineCheckRequest) -> int:
    """Say what of the contract of engines one holds, and how to mend what it does not.

    The exit code is 0 where it holds all of it, 1 where it does not.
    """
    from reports.cli.commands import contract as verb

    return verb.run_check(request, terminal(), terminal(stderr=True))


@app.command()
def view(
    scene: SceneName,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", help="Draw into a .gif or .png in place of the viewer."),
    ] = None,
    forces: Annotated[
        bool, typer.Option("--forces", help="Draw the forces as arrows, into a file.")
    ] = False,
) -> None:
    """Open MuJoCo's viewer, or, without a screen or with -o, draw the motion into a file."""
    with guarded():
        from reports.cli.commands import view as command

        command.run_view(scene, output, terminal(), with_forces=forces)
