"""Options of `verify`: of scenes, and of a model of the user's own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, ClassVar

import typer

from models.errors import CrankcheckError
from reports.requests.options import (
    Duration,
    Engines,
    Forces,
    Jobs,
    SegmentCount,
    SpringKind,
    StepS,
    StepsPerTurn,
    given,
)

PRESCRIBED = "prescribed"
OWN_MODEL = "A model of your own"


@dataclass(frozen=True)
class VerifyOptions:
    """Options of `verify`, of scenes and of a model of the user's own; ``baseline`` is the folder
    of an earlier run, whose errors may grow by ``factor``."""

    answered_by: ClassVar[str] = "requests.verify:VerifyRequest"
    scenes: Annotated[
        Sequence[str],
        typer.Argument(metavar="SCENE", help="Shipped names or scene files; all if none."),
    ] = ()
    engines: Engines = ()
    profiles: Annotated[
        Sequence[str],
        typer.Option("--profile", help="Profile, gated; default: tuned gated, as-shipped shown."),
    ] = ()
    dt_s: StepS = None
    steps_per_turn: StepsPerTurn = None
    turns: Annotated[
        float | None, typer.Option(help="Turns (periods) of the driver (default 2).")
    ] = None
    tolerance: Annotated[
        Sequence[str],
        typer.Option(
            "--tol", metavar="NAME=NUMBER", help="Tolerance as a pure number, such as angle=1e-4."
        ),
    ] = ()
    drive: Annotated[
        str, typer.Option(help="prescribed or servo; with --mjcf: the joint that is driven.")
    ] = PRESCRIBED
    converge: Annotated[
        bool,
        typer.Option(
            "--convergence/--no-convergence",
            help="Run at half and quarter step too, and say what the error does.",
        ),
    ] = True
    jobs: Jobs = 0
    junit: Annotated[Path | None, typer.Option(help="Write JUnit XML.")] = None
    csv: Annotated[Path | None, typer.Option(help="Write the cells as CSV.")] = None
    json: Annotated[Path | None, typer.Option(help="Write cells and findings as JSON.")] = None
    folder: Annotated[
        Path | None, typer.Option("-o", "--output", help="Write all of them into a folder.")
    ] = None
    baseline: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Folder of an earlier run; exit 1 when worse than it."),
    ] = None
    factor: Annotated[
        float, typer.Option(help="Growth over the baseline that is no fault yet.")
    ] = 1.1
    forces: Forces = False
    free: Annotated[
        bool, typer.Option("--free", help="Let scenes go; those of free motion if none is named.")
    ] = False
    duration_s: Duration = None
    segments: SegmentCount = None
    springs: SpringKind = None
    mjcf: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="A MuJoCo model, run as it is; needs --drive JOINT and --speed.",
            rich_help_panel=OWN_MODEL,
        ),
    ] = None
    speed_rad_s: Annotated[
        float | None,
        typer.Option(
            "--speed",
            metavar="RAD/S",
            help="Of the driven joint; below 0 the other way.",
            rich_help_panel=OWN_MODEL,
        ),
    ] = None
    key: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="Keyframe to start from; default: the pose as drawn.",
            rich_help_panel=OWN_MODEL,
        ),
    ] = None
    start_deg: Annotated[
        float | None,
        typer.Option(
            "--start",
            metavar="DEG",
            help="What the driven joint reads at the start.",
            rich_help_panel=OWN_MODEL,
        ),
    ] = None
    branch: Annotated[
        Sequence[str],
        typer.Option(
            metavar="NAME=1|-1",
            help="Assembly, where the pose fits two; default: the nearest.",
            rich_help_panel=OWN_MODEL,
        ),
    ] = ()
    write_scene: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Write the scene that it was read as, as TOML.",
            rich_help_panel=OWN_MODEL,
        ),
    ] = None
    limit_s: Annotated[
        float,
        typer.Option(metavar="SECONDS", help="Time limit of each line.", rich_help_panel=OWN_MODEL),
    ] = 60.0
    memory_gb: Annotated[
        float,
        typer.Option(metavar="GB", help="Memory limit of each line.", rich_help_panel=OWN_MODEL),
    ] = 2.0


OF_MODELS = ["speed_rad_s", "key", "start_deg", "branch", "write_scene", "limit_s", "memory_gb"]
"""Fields of a model of the user's own alone."""


def refuse_of_models(request: VerifyOptions) -> None:
    """Refuse what says nothing of scenes. Raises CrankcheckError."""
    for option in given(request, *OF_MODELS):
        raise CrankcheckError(
            f"{option}: it is of a model of your own; name that with --mjcf FILE, or leave "
            f"{option} out"
        )
