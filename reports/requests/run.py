"""`run`: a scene in an engine, logged and not judged."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, cast

from rich.console import Console

from models.errors import CrankcheckError
from models.files.reading import find_scene
from models.scene import Scene
from reports.compare.free_truth import released_state
from reports.output import formats, write
from reports.output.console import print_each, say, say_each, say_whole
from reports.plan.requirements import by_contact, given_of, under_control
from reports.protocol.length import SEGMENTS, GivenAs, Length, Planned, Springs
from reports.protocol.way import way, way_of
from reports.requests import arguments, options, shown, solution
from sim import run as stepping
from sim.engine import Drive, Run, SettingValue
from sim.registry import FIRST

if TYPE_CHECKING:
    import pandas as pd

DRIVES = ("prescribed", "servo", "free")


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Simulation(shown.Shown, Run):
    """A run of a scene in an engine: its motion, ending and settings (`Run`).

    ``mechanism`` is the scene, in free motion where the run was, and ``scene`` its name. Elastic
    links were given to the engine as so many ``segments`` each, with ``springs`` between.
    """

    mechanism: Scene
    segments: int = SEGMENTS
    springs: Springs = "plain"

    def frame(self) -> pd.DataFrame:
        """The log: one row per sample, columns as in `Solution.frame`, with the gaps of pins
        (``C_gap_m``); series that the engine does not report are left out.

        Where velocities or accelerations belong to other instants than the places,
        ``velocity_time_s`` and ``acceleration_time_s`` have these.
        """
        from reports.describe.free_motion import run_frame

        return run_frame(self)

    def show(self, console: Console) -> None:
        from reports.describe.free_motion import motion_tables

        way = way_of(self.mechanism)
        per_turn = way.turn_s(self.mechanism) / self.dt_s
        length = way.clock.long(self.dt_s, self.steps, per_turn)
        logged = "" if self.every == 1 else f", logged every {self.every} steps"
        say(
            console,
            f"{self.scene}: {self.engine} {self.version}, profile {self.profile}, drive "
            f"{self.drive}\ndt {self.dt_s:.4g} s, {length}{logged}\n",
        )
        if self.motion is not None:
            few = solution.thinned(self.motion, solution.ROWS)
            print_each(console, motion_tables(self.mechanism, few, console.width))
            left = f"{few.time_s.size} of {self.motion.time_s.size} logged samples"
            say(console, left, "dim")
        style = "" if self.status == "ok" else "red"
        say(console, self.ending(), style)
        say_each(console, (f"warning: {warning}" for warning in self.warnings), "yellow")

    def ending(self) -> str:
        """The ending of the run, in a line."""
        reason = f": {self.reason}" if self.reason else ""
        widest = max((float(gap.max()) for gap in self.gaps.values() if gap.size), default=0.0)
        gaps = f"; pins open by at most {widest:.2g} m" if self.gaps else ""
        at = f" at t = {self.stopped_at_s:.6g} s" if self.motion is not None else ""
        return f"ended {self.status}{at}{reason}{gaps}"

    def _drawn(self) -> str:
        return solution.drawn(self.mechanism, self.motion)


@dataclass(frozen=True)
class RunRequest:
    """Arguments of `run`, as given; ``settings`` in Python alone."""

    scene: options.SceneName
    engine: Annotated[str | None, "Engine; default: the first of `crankcheck engines`."] = None
    profile: Annotated[str, "Profile of the engine."] = "tuned"
    dt_s: options.StepS = None
    steps_per_turn: options.StepsPerTurn = None
    turns: Annotated[float | None, "Turns of the driver (default 2)."] = None
    duration_s: options.Duration = None
    every: Annotated[int, options.option("Log every N-th step.", "N")] = 1
    drive: Annotated[
        str | None,
        "prescribed, servo, or free (no drive); default: free for a scene of free motion, else "
        "prescribed.",
    ] = None
    output: Annotated[Path | None, options.output_option("Write .csv, .parquet or .xlsx.")] = None
    forces: options.Forces = False
    segments: options.SegmentCount = None
    springs: options.SpringKind = None
    facets: options.Facets = None
    settings: Mapping[str, SettingValue] | None = None

    def answer(self) -> Simulation:
        """The run, logged. Raises CrankcheckError for a faulty request, before the run."""
        facets = [] if self.facets is None else [self.facets]
        (scene,) = by_contact([under_control(arguments.scene_of(self.scene))], facets)
        engine = FIRST if self.engine is None else self.engine
        name, profile = arguments.engine_of(engine, self.profile, self.settings)
        drive = _drive(scene, self.drive)
        every = arguments.whole_of(self.every, "--every")
        _refuse_other_length(scene, drive, self)
        bent = given_of([scene], self.segments, self.springs)
        length = Length(self.dt_s, self.steps_per_turn, self.turns, self.duration_s, every, 1)
        chosen, driven = way_of(scene, drive), scene
        scene = chosen.released(scene)
        if scene is not driven and [*options.given(self, "turns", "steps_per_turn")]:
            dt_s, steps = way("driven").counted(driven, length, bent)  # by the law that drove it
        else:
            dt_s, steps = chosen.counted(scene, length, bent)
        truth = chosen.launch(Planned(scene, dt_s, steps, bent))
        done = stepping.run(
            scene if truth is None else truth.given,
            released_state(scene) if truth is None else truth.start,
            name,
            profile,
            dt_s=dt_s,
            steps=steps,
            every=every,
            drive=drive,
            settings=arguments.settings_of(self.settings),
            with_forces=arguments.is_true(self.forces, "forces"),
        )
        if truth is not None:
            done = truth.logged(done)
        return Simulation(
            **vars(done), mechanism=scene, segments=bent.segments, springs=bent.springs
        )

    def run(self, console: Console, progress: Console) -> int:
        """Run the scene, and show or write the log; return the exit code: 0, or 1 for a run that
        did not end well, whose log ends there.

        Raises CrankcheckError for a faulty request, and for a scene that the engine can not hold.
        """
        write.check_file(self.output, "-o", formats.ENDINGS, inputs=[find_scene(self.scene)])
        done = self.answer()
        if done.motion is None:
            raise CrankcheckError(f"{done.scene}, {done.engine}: {done.status}: {done.reason}")
        if self.output is None:
            done.show(console)
            say(console, "All samples: -o log.csv, .parquet or .xlsx", "dim")
        else:
            formats.write_frame(self.output, done.frame(), "log", _origin(done))
            say_whole(console, _written(self, done))
        return int(done.status != "ok")


def _origin(done: Simulation) -> dict[str, str]:
    facts = {"scene": done.scene, "source": done.mechanism.source, "engine": done.engine}
    facts |= {"version": done.version, "profile": done.profile, "drive": done.drive}
    facts |= {"dt_s": repr(done.dt_s), "steps": str(done.steps), "every": str(done.every)}
    return facts | {f"setting {name}": str(value) for name, value in done.settings.items()}


def _written(request: RunRequest, done: Simulation) -> str:
    """The written file, the ending of the run, and the command to judge the log, if any."""
    assert done.motion is not None
    told = (
        f"{request.output}: {done.motion.time_s.size} samples of {done.scene} in {done.engine} "
        f"{done.version}, profile {done.profile}; {done.ending()}"
    )
    bent = GivenAs(done.segments, done.springs)
    options = way_of(done.mechanism).judged_by(bent)
    if options is None:
        return told
    judge = ["crankcheck", "judge", request.scene, str(request.output), "--step", repr(done.dt_s)]
    judge += ["--forces"] * request.forces + ["--free"] * (request.drive == "free")
    return f"{told}\nnext: {shlex.join([*judge, *options])}"


@arguments.told_at_the_call
def run(
    scene: arguments.SceneLike,
    engine: str = FIRST,
    profile: str = "tuned",
    *,
    steps_per_turn: float | None = None,
    dt_s: float | None = None,
    turns: float | None = None,
    duration_s: float | None = None,
    every: int = 1,
    drive: str | None = None,
    settings: Mapping[str, SettingValue] | None = None,
    forces: bool = False,
    segments: int | None = None,
    springs: str | None = None,
    facets: int | None = None,
) -> Simulation:
    """Run a scene in an engine and log it.

    Parameters
    ----------
    scene : Scene, str or path
        A shipped name, the path of a scene file, or a scene.
    engine, profile : str
        As `crankcheck engines` lists them.
    steps_per_turn, dt_s : float or None
        The step, by one of the two: steps in a turn of the driver (720), or seconds; in free motion
        in seconds alone (a millisecond, or a 5000th of the scene's duration).
    turns : float or None
        Turns (periods) of the driver (2), where the scene is driven.
    duration_s : float or None
        Duration of free motion (the scene's; 10 turns of the law of a driven scene; with elastic
        links five periods of the slowest vibration).
    every : int
        Log every so many steps.
    drive : str or None
        ``prescribed``: the driver follows its law exactly; ``servo``: a motor of limited gain
        drives it; ``free``: no drive after the start, as in `verify --free`. None: ``free`` for a
        scene of free motion, which has no other, and ``prescribed`` for a driven scene.
    settings : Mapping or None
        Settings of the engine in place of the profile's.
    forces : bool
        Log the reactions and the driving torque as well, in ``motion.forces``.
    segments, springs : int or None, str or None
        Engine's model of elastic links: so many rigid segments each (16), with springs between them
        that are ``plain``, or ``corrected`` for the sag of the beam; or, with ``beam``, as many
        elements of the engine's own beam.
    facets : int or None
        Cams by contact, with so many facets; None: as the scene says.

    Returns
    -------
    Simulation
        Also for a scene that the engine can not hold, and for a run that came apart, as ``status``
        and ``reason`` say.

    Raises
    ------
    CrankcheckError
        An invalid argument; an EngineError for an engine, profile or setting; a ReachError for a
        scene that can not be assembled at its start.
    """
    return RunRequest(**locals()).answer()


def _refuse_other_length(scene: Scene, drive: Drive, request: RunRequest) -> None:
    for name in options.given(request, "turns", "steps_per_turn"):
        if name not in way_of(scene).lengths_by:
            raise CrankcheckError(
                f"{name}: {scene.name} is in free motion, without turns; give --dt and "
                "--duration, in seconds"
            )
        if request.duration_s is not None:
            raise CrankcheckError(
                f"--duration and {name}: free motion lasts for seconds, or for turns of the law "
                "that drove it; give one of them"
            )
    if request.duration_s is not None and "--duration" not in way_of(scene, drive).lengths_by:
        raise CrankcheckError(
            f"--duration: for free motion, and {scene.name} is driven; give --turns, or --drive "
            "free"
        )


def _drive(scene: Scene, drive: str | None) -> Drive:
    """The drive of a run. Raises CrankcheckError for a drive of free motion, which has no law."""
    chosen = way_of(scene)
    if drive is None:
        return chosen.drive
    driven = cast(Drive, arguments.one_of(drive, "--drive", DRIVES))
    if driven not in chosen.drives:
        raise CrankcheckError(
            f"--drive {driven}: {scene.name} is in free motion, without a drive; leave --drive out"
        )
    return driven
