"""What a user hands in to be judged, as a log: a file, a frame, arrays by name, or a motion."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any, TypeAlias

from models.errors import CrankcheckError
from models.motion import Motion
from models.scene import Scene
from reports.logs.channel import OwnLog
from reports.logs.map_file import Map, map_of, read_map
from reports.requests.arguments import kind_of, path_of
from reports.requests.run import Simulation
from reports.requests.solution import Solution
from reports.way.way import way_of
from sim.engine import Run

if TYPE_CHECKING:
    import pandas as pd

LogLike: TypeAlias = "str | PathLike[str] | pd.DataFrame | Mapping[str, Sequence[float]] | Motion"
"""A log: a file, a frame, columns by name, or a motion."""
MapLike = str | PathLike[str] | Mapping[str, Any] | None
"""What columns mean: a file, or what would stand in it."""


def _told(map_: MapLike) -> Map:
    """What a user says of columns. Raises CrankcheckError with every fault of it."""
    if map_ is None:
        return Map()
    if isinstance(map_, Mapping):
        return map_of(map_, "--map")
    if not isinstance(map_, str | PathLike):
        raise CrankcheckError(
            f"--map: found {kind_of(map_)}; give the path of a TOML file, or a dict of what would "
            "stand in it"
        )
    return read_map(path_of(map_, "--map"))


def log_of(scene: Scene, log: object, map_: MapLike = None, *, forces: bool = False) -> OwnLog:
    """A log of a scene, of whatever kind, its ``forces`` as well where that is asked. Raises
    CrankcheckError."""
    told = _told(map_)
    if isinstance(log, Motion):
        _refuse_map(map_, "a motion")
        _refuse_other(scene, log)
        from reports.logs.of_motion import log_of_motion

        return log_of_motion(scene, log)
    from reports.logs.columns import columns_of, read_columns
    from reports.logs.meanings import understood, wanted

    if isinstance(log, str | PathLike):
        path, worth = path_of(log, "log"), wanted(scene, told, forces=forces)
        # No name for the columns, which take as much memory as all readings.
        return understood(read_columns(path, told.layout, worth), scene, told, forces=forces)
    frame, source = _frame_of(log)
    return understood(columns_of(frame, source), scene, told, forces=forces)


def refuse_other_scene(scene: Scene, run: Run) -> None:
    """Refuse a run that is not of the scene. Raises CrankcheckError."""
    mechanism = run.mechanism if isinstance(run, Simulation) else None
    if run.scene != scene.name or mechanism not in (None, scene_of_run(scene, run)):
        other = f"another {run.scene}" if run.scene == scene.name else run.scene
        raise CrankcheckError(f"the run is of {other}, not of {scene.name}; give the scene of both")
    if run.drive not in way_of(scene).drives:
        raise CrankcheckError(
            f"the run of {run.scene} is of drive {run.drive}, and the scene is let go; run it with "
            "drive free"
        )


def scene_of_run(scene: Scene, run: Run) -> Scene:
    """The scene as the run has it: let go where that was, with the torque of its controller if it
    has elastic links and one."""
    return way_of(scene, run.drive).released(scene)


def _refuse_other(scene: Scene, motion: Motion) -> None:
    """Refuse the solution of another scene. Raises CrankcheckError."""
    if isinstance(motion, Solution) and motion.scene != scene:
        raise CrankcheckError(
            f"the motion is of {motion.scene.name}, not of {scene.name}; give the scene of both"
        )


def _refuse_map(map_: MapLike, what: str) -> None:
    if map_ is not None:
        raise CrankcheckError(f"--map: {what} has no columns to be told of; leave it out")


def _refuse_empty(columns: Collection[object], source: str) -> None:
    """Refuse a table without columns. Raises CrankcheckError."""
    if not len(columns):
        raise CrankcheckError(
            f"{source}: found no columns; give times and readings, such as time_s and rocker_rad"
        )


def _frame_of(log: object) -> tuple[pd.DataFrame, str]:
    """A frame, its times among its columns, and what it is called. Raises CrankcheckError."""
    import pandas as pd

    from reports.logs.time_columns import time_of

    if isinstance(log, pd.DataFrame):
        levels = [each for each in log.index.names if each is not None]
        if any(time_of(str(each)) for each in levels) and not {*levels} & {*log.columns}:
            log = log.reset_index()
        _refuse_empty(log.columns, "the frame")
        return log, "the frame"
    if isinstance(log, Mapping):
        _refuse_empty(log, "the log")
        try:
            return pd.DataFrame(
                {str(name): list(column) for name, column in log.items()}
            ), "the log"
        except (TypeError, ValueError) as error:
            raise CrankcheckError(
                f"the log: found columns that make no table ({error}); give each as many numbers"
            ) from None
    raise CrankcheckError(
        f"log: found {kind_of(log)}; give the path of a file, a pandas frame, a dict of columns, a "
        "motion or a run"
    )
