"""Options of `verify`: of scenes, and of a model of the user's own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated, ClassVar

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
    argument,
    given,
    option,
    output_option,
)

PRESCRIBED = "prescribed"
of_model = partial(option, rich_help_panel="A model of your own")


@dataclass(frozen=True)
class VerifyOptions:
    """Options of `verify`, of scenes and of a model of the user's own; ``baseline`` is the folder
    of an earlier run, whose errors may grow by ``factor``."""

    answered_by: ClassVar[str] = "requests.verify:VerifyRequest"
    scenes: Annotated[
        Sequence[str], argument("SCENE", "Shipped names or scene files; all if none.")
    ] = ()
    engines: Engines = ()
    profiles: Annotated[
        Sequence[str],
        option("Profile, gated; default: tuned gated, as-shipped shown.", "--profile"),
    ] = ()
    dt_s: StepS = None
    steps_per_turn: StepsPerTurn = None
    turns: Annotated[float | None, "Turns (periods) of the driver (default 2)."] = None
    tolerance: Annotated[
        Sequence[str],
        option("Tolerance as a pure number, such as angle=1e-4.", "--tol NAME=NUMBER"),
    ] = ()
    drive: Annotated[str, "prescribed or servo; with --mjcf: the joint that is driven."] = (
        PRESCRIBED
    )
    converge: Annotated[
        bool,
        option(
            "Run at half and quarter step too, and say what the error does.",
            "--convergence/--no-convergence",
        ),
    ] = True
    jobs: Jobs = 0
    junit: Annotated[Path | None, "Write JUnit XML."] = None
    csv: Annotated[Path | None, "Write the cells as CSV."] = None
    json: Annotated[Path | None, "Write cells and findings as JSON."] = None
    folder: Annotated[Path | None, output_option("Write all of them into a folder.")] = None
    baseline: Annotated[
        Path | None, option("Folder of an earlier run; exit 1 when worse than it.", "DIR")
    ] = None
    factor: Annotated[float, "Growth over the baseline that is no fault yet."] = 1.1
    forces: Forces = False
    free: Annotated[bool, "Let scenes go; those of free motion if none is named."] = False
    duration_s: Duration = None
    segments: SegmentCount = None
    springs: SpringKind = None
    mjcf: Annotated[
        Path | None,
        of_model("A MuJoCo model, run as it is; needs --drive JOINT and --speed.", "FILE"),
    ] = None
    speed_rad_s: Annotated[
        float | None, of_model("Of the driven joint; below 0 the other way.", "--speed RAD/S")
    ] = None
    key: Annotated[
        str | None, of_model("Keyframe to start from; default: the pose as drawn.", "NAME")
    ] = None
    start_deg: Annotated[
        float | None, of_model("What the driven joint reads at the start.", "--start DEG")
    ] = None
    branch: Annotated[
        Sequence[str],
        of_model("Assembly, where the pose fits two; default: the nearest.", "NAME=1|-1"),
    ] = ()
    write_scene: Annotated[
        Path | None, of_model("Write the scene that it was read as, as TOML.", "FILE")
    ] = None
    limit_s: Annotated[float, of_model("Time limit of each line.", "SECONDS")] = 60.0
    memory_gb: Annotated[float, of_model("Memory limit of each line.", "GB")] = 2.0


OF_MODELS = ["speed_rad_s", "key", "start_deg", "branch", "write_scene", "limit_s", "memory_gb"]
"""Fields of a model of the user's own alone."""


def refuse_of_models(request: VerifyOptions) -> None:
    """Refuse what says nothing of scenes. Raises CrankcheckError."""
    for given_option in given(request, *OF_MODELS):
        raise CrankcheckError(
            f"{given_option}: it is of a model of your own; name that with --mjcf FILE, or leave "
            f"{given_option} out"
        )
