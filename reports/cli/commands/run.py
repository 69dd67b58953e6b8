"""`crankcheck run`: one scene in one engine, logged."""

from __future__ import annotations

import shlex

from rich.console import Console

from models.errors import CrankcheckError, harmless
from models.files import find_scene
from reports.cli.showing import RunRequest
from reports.face.simulation import Simulation, simulated
from reports.output.frame_file import ENDINGS, write_frame
from reports.output.write import check_file
from sim.registry import FIRST


def run_run(request: RunRequest, console: Console) -> int:
    """Run it, and show or write the log; returns the exit code: 0, or 1 for a run that did not end
    well, whose log goes as far as it did.

    Raises CrankcheckError for what can be told before, and for a scene that the engine can not
    hold.
    """
    if request.output is not None:
        check_file(request.output, "-o", ENDINGS, inputs=[find_scene(request.scene)])
    done = simulated(
        request.scene,
        FIRST if request.engine is None else request.engine,
        request.profile,
        steps_per_turn=request.steps_per_turn,
        dt_s=request.dt_s,
        turns=request.turns,
        duration_s=request.duration_s,
        every=request.every,
        drive=request.drive,
        forces=request.forces,
        segments=request.segments,
        springs=request.springs,
    )
    if done.motion is None:
        raise CrankcheckError(f"{done.scene}, {done.engine}: {done.status}: {done.reason}")
    if request.output is None:
        done.show(console)
        console.print("All samples: -o log.csv, .parquet or .xlsx", style="dim", highlight=False)
    else:
        write_frame(request.output, done.frame(), "log", _origin(done))
        console.print(_written(request, done), highlight=False, markup=False, soft_wrap=True)
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
