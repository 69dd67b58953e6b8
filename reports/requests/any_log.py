"""Logs of the user to be judged: a file, a frame, arrays by name, or a motion."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from typing import TYPE_CHECKING, Any, TypeAlias, cast

import numpy as np

from models.array import Array, numbers, samples
from models.errors import CrankcheckError, suggestion
from models.motion import Motion
from models.scene import Scene
from reports.logs.channel import OwnLog
from reports.logs.kinds import KINDS, Kind, plural, si
from reports.logs.map_file import ChannelTable, Map, TimeTable, map_of, read_map
from reports.protocol.way import way_of
from reports.requests.arguments import is_true, one_of, path_of, wrong_kind
from reports.requests.run import Simulation
from reports.requests.solution import Solution
from sim.engine import Run

if TYPE_CHECKING:
    import pandas as pd

    from reports.own_log.drives import LogDrive


LogLike: TypeAlias = "str | PathLike[str] | pd.DataFrame | Mapping[str, Sequence[float]] | Motion"
"""A log: a file, a frame, columns by name, or a motion."""
MapLike = str | PathLike[str] | Mapping[str, Any] | None
"""Meaning of columns: a file, or a mapping with its content."""
LOG_DRIVES = ("scene", "fitted", "logged")


@dataclass(frozen=True)
class LogOptions:
    """Options of `compare` and `judge` on a log; a run knows all except ``forces`` itself."""

    step_s: float | None = None
    drive: str = "scene"
    map: MapLike = None
    require: str | Iterable[str] = ()
    forces: bool = False
    free: bool = False
    segments: int | None = None
    springs: str | None = None


def _told(map_: MapLike) -> Map:
    """The user's meanings of columns. Raises CrankcheckError with every fault of them."""
    if map_ is None:
        return Map()
    if isinstance(map_, Mapping):
        return map_of(map_, "--map")
    if not isinstance(map_, str | PathLike):
        cure = "give the path of a TOML file, or a dict with its tables"
        raise wrong_kind("--map", map_, cure)
    return read_map(path_of(map_, "--map"))


def log_of(scene: Scene, log: object, map_: MapLike = None, *, forces: bool = False) -> OwnLog:
    """Read a log of any kind, with its ``forces`` where requested. Raises CrankcheckError."""
    told = _told(map_)
    if isinstance(log, Motion):
        if map_ is not None:
            raise CrankcheckError("--map: a motion has no columns; leave --map out")
        if isinstance(log, Solution) and log.scene != scene:
            raise CrankcheckError(
                f"the motion is of {log.scene.name}, the scene is {scene.name}; give one for both"
            )
        return log_of_motion(scene, log)
    from reports.logs.columns import columns_of
    from reports.logs.meanings import columns_worth, understood

    if isinstance(log, str | PathLike):
        path = path_of(log, "log")
        # No name for the columns, which take as much memory as all readings.
        took = {"forces": forces}
        return understood(columns_worth(path, scene, told, **took), scene, told, **took)
    frame, source = _frame_of(log)
    return understood(columns_of(frame, source), scene, told, forces=forces)


def drive_of(name: object, *, forces: object) -> LogDrive:
    """Return the drive of the reference of that name. Raises CrankcheckError for another, and for
    ``forces`` where the geometry alone is judged."""
    drive = one_of(name, "--drive", LOG_DRIVES)
    if is_true(forces, "forces") and drive == "logged":
        raise CrankcheckError(
            "--forces: --drive logged judges the geometry alone, and forces need rates; use "
            "--drive scene or fitted"
        )
    return cast("LogDrive", drive)


def refuse_run(scene: Scene, run: Run, options: LogOptions) -> None:
    """Refuse options of logs alone, a run that is not of the scene, and forces that it did not log.
    Raises CrankcheckError."""
    known = f"this option is for logs, and this is a run in {run.engine}"
    of_logs = {
        "--step": options.step_s is not None,
        "--drive": one_of(options.drive, "--drive", LOG_DRIVES) != "scene",
        "--map": options.map is not None,
        "--require": bool(options.require),
    }
    for option in [name for name, is_given in of_logs.items() if is_given]:
        raise CrankcheckError(
            f"{option}: {known}, which carries its own settings; leave the option out, or give "
            "frame() of the run"
        )
    for option, given in (("--segments", options.segments), ("--springs", options.springs)):
        if given is not None:
            raise CrankcheckError(f"{option}: {known}; leave it out")
    _refuse_other_scene(scene, run)
    if is_true(options.forces, "forces") and not run.with_forces:
        raise CrankcheckError(f"forces: the run in {run.engine} has none; run it with forces=True")


def _refuse_other_scene(scene: Scene, run: Run) -> None:
    mechanism = run.mechanism if isinstance(run, Simulation) else None
    if run.scene != scene.name or mechanism not in (None, scene_of_run(scene, run)):
        other = f"another {run.scene}" if run.scene == scene.name else run.scene
        raise CrankcheckError(
            f"the run is of {other}, the scene is {scene.name}; give one for both"
        )
    if run.drive not in way_of(scene).drives:
        raise CrankcheckError(
            f"the run of {run.scene} has drive {run.drive}, and the scene is in free motion; run "
            "it with drive free"
        )


def scene_of_run(scene: Scene, run: Run) -> Scene:
    """The scene as the run has it: in free motion where the run was, with the torque of its
    controller if it has elastic links and one."""
    return way_of(scene, run.drive).released(scene)


def _refuse_empty(columns: Collection[object], source: str) -> None:
    if not len(columns):
        raise CrankcheckError(
            f"{source}: found no columns; give times and readings, such as time_s and rocker_rad"
        )


def _frame_of(log: object) -> tuple[pd.DataFrame, str]:
    """A frame, its times among its columns, and its name in messages. Raises CrankcheckError."""
    import pandas as pd

    if isinstance(log, pd.DataFrame):
        levels = [each for each in log.index.names if each is not None]
        if levels and not {*levels} & {*log.columns}:  # the times, or the driver's angle
            log = log.reset_index()
        _refuse_empty(log.columns, "the frame")
        return log, "the frame"
    if isinstance(log, Mapping):
        _refuse_empty(log, "the log")
        try:
            columns = {str(name): list(column) for name, column in log.items()}
            return pd.DataFrame(columns), "the log"
        except (TypeError, ValueError) as error:
            raise CrankcheckError(
                f"the log: its columns make no table ({error}); give every column as many numbers"
            ) from None
    cure = "give the path of a file, a pandas frame, a dict of columns, a motion or a run"
    raise wrong_kind("log", log, cure)


TIME = "time_s"


def log_of_motion(scene: Scene, motion: Motion, source: str = "the motion") -> OwnLog:
    """The log of a motion; a series that is NaN throughout, as of an engine that does not report
    it, is left out.

    Raises CrankcheckError for times that do not increase; bodies that the scene has not; series of
    another shape than the times, or with samples that are not finite; nothing that moves.
    """
    raw = {TIME: samples(motion.time_s, f"{source}: time_s")}
    channels = []
    for kind, body, series in _series(scene, motion, source):
        values = _fitting(series, kind, raw[TIME], f"{source}: {body}, {kind.field}")
        if np.all(np.isnan(values)):
            continue
        column = f"{body}_{kind.column}"
        raw[column] = values
        channels.append(
            ChannelTable(column=column, of=body, kind=kind.name, unit=si(kind.dimension))
        )
    if not channels:
        raise CrankcheckError(f"{source}: nothing in it moves; give links, points or sliders")
    from reports.logs.columns import Columns
    from reports.logs.meanings import understood

    columns = Columns(source, raw)
    return understood(columns, scene, Map(time=TimeTable(column=TIME), channel=channels))


def _series(scene: Scene, motion: Motion, source: str) -> Iterator[tuple[Kind, str, object]]:
    """The series of the moving bodies. Raises CrankcheckError for a body that the scene has not."""
    points = [*scene.pins, *(slider.point for slider in scene.sliders.values())]
    there = {"link": [*scene.links], "point": points, "slider": [*scene.sliders]}
    there |= {"elastic": [*scene.elastic]} if scene.elastic else {}
    for body_kind, names in there.items():
        own = getattr(motion, plural(body_kind))
        for body, moved in own.items():
            if body not in names:
                hint = suggestion(str(body), names, "it has") if names else "it has none"
                raise CrankcheckError(
                    f"{source}: {body_kind} {body!r} is not in {scene.name}; {hint}"
                )
            if body_kind == "point" and body in scene.ground:
                continue
            for kind in KINDS.values():
                if kind.body_kind == body_kind and not kind.is_size:
                    yield kind, body, getattr(moved, kind.field)


def _fitting(series: object, kind: Kind, time_s: Array, what: str) -> Array:
    """A series (T,) of a body. Raises CrankcheckError for another shape."""
    found = numbers(series, what)  # type: ignore[arg-type]  # whatever it is, it is looked at there
    shape = time_s.shape if kind.axis is None else (*time_s.shape, 2)
    if found.shape != shape:
        raise CrankcheckError(
            f"{what} of shape {found.shape}, time_s of {time_s.shape}; give {shape}"
        )
    return found if kind.axis is None else found[:, kind.axis]
