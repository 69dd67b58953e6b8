"""`crankcheck run`: one scene in one engine, logged."""

from __future__ import annotations

import shlex
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from models.errors import CrankcheckError, harmless
from models.files import find_scene
from reports.face.simulation import Simulation, simulated
from reports.output.frame_file import ENDINGS, write_frame
from reports.output.write import check_file
from reports.requests.options import (
    Duration,
    Forces,
    SceneName,
    SegmentCount,
    SpringKind,
    StepS,
    StepsPerTurn,
)
from sim.registry import FIRST


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

    def run(self, console: Console, progress: Console) -> int:
        """Run it, and show or write the log; returns the exit code: 0, or 1 for a run that did not
        end well, whose log goes as far as it did.

        Raises CrankcheckError for what can be told before, and for a scene that the engine can not
        hold.
        """
        if self.output is not None:
            check_file(self.output, "-o", ENDINGS, inputs=[find_scene(self.scene)])
        done = simulated(
            self.scene,
            FIRST if self.engine is None else self.engine,
            self.profile,
            steps_per_turn=self.steps_per_turn,
            dt_s=self.dt_s,
            turns=self.turns,
            duration_s=self.duration_s,
            every=self.every,
            drive=self.drive,
            forces=self.forces,
            segments=self.segments,
            springs=self.springs,
        )
        if done.motion is None:
            raise CrankcheckError(f"{done.scene}, {done.engine}: {done.status}: {done.reason}")
        if self.output is None:
            done.show(console)
            console.print(
                "All samples: -o log.csv, .parquet or .xlsx", style="dim", highlight=False
            )
        else:
            write_frame(self.output, done.frame(), "log", _origin(done))
            console.print(_written(self, done), highlight=False, markup=False, soft_wrap=True)
        return int(done.status != "ok")


def _origin(done: Simulation) -> dict[str, str]:
    """Where a log comes from."""
    facts = {"scene": done.scene, "source": done.mechanism.source, "engine": done.engine}
    facts |= {"version": done.version, "profile": done.profile, "drive": done.drive}
    facts |= {"dt_s": repr(done.dt_s), "steps": str(done.steps), "every": str(done.every)}
    return facts | {f"setting {name}": str(value) for name, value in done.settings.items()}


def _written(request: RunRequest, done: Simulation) -> str:
    """What was written, what came of the run, and how the log is judged, where it is."""
    assert done.motion is not None
    told = (
        f"{request.output}: {done.motion.time_s.size} samples of {done.scene} in {done.engine} "
        f"{done.version}, profile {done.profile}; {done.ending()}"
    )
    if done.mechanism.elastic and done.drive == "free":
        return harmless(told)
    judge = ["crankcheck", "judge", request.scene, str(request.output), "--step", repr(done.dt_s)]
    judge += ["--forces"] * request.forces + ["--free"] * (request.drive == "free")
    if done.mechanism.elastic:
        judge += ["--segments", str(done.segments)]
        judge += ["--springs", done.springs] * (done.springs != "plain")
    return harmless(f"{told}\nnext: {shlex.join(judge)}")
