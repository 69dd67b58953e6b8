"""Logs of the lecture's four-bar and of others, judged, for the tests of their page."""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from analytic.kinematics import solve
from models.array import Array
from models.files.reading import load_scene
from models.motion import Motion
from models.scene import Scene
from reports.logs.columns import columns_of
from reports.logs.map_file import Map
from reports.logs.meanings import understood
from reports.own_log.judged import JudgedLog, judge_log
from reports.own_log.log_limits import EVERY, LogRequest

SCENE = load_scene("fourbar-lecture-1")
FACTS = {"crankcheck": "0.0.0", "made": "2026-01-02T03:04:05+00:00"}
TURN_S = 0.2 * np.pi


def motion_of(scene: Scene = SCENE, turns: float = 1.0, samples: int = 361) -> Motion:
    return solve(scene, np.linspace(0.0, turns * scene.driver.law.period_s, samples))


def judged(
    time_s: Array,
    columns: Mapping[str, object],
    scene: Scene = SCENE,
    mapped: Map | None = None,
    **asked: object,
) -> JudgedLog:
    """A log of some columns, held to 1e-3 where nothing else is asked."""
    frame = columns_of(pd.DataFrame({"time_s": time_s, **columns}), "made/log.csv")
    request = LogRequest(**{"target": {EVERY: 1e-3}, **asked})  # type: ignore[arg-type]
    return judge_log(understood(frame, scene, mapped), request)


def angles(motion: Motion, **off: object) -> dict[str, Array]:
    """The angles of all links as columns [deg], each ``off`` by as much [deg]."""
    return {
        f"{name}_deg": np.degrees(link.theta) + off.get(name, 0.0)
        for name, link in motion.links.items()
    }


def points(motion: Motion, *names: str) -> dict[str, Array]:
    return {
        f"{name}.{axis}_mm": 1e3 * motion.points[name].position[:, at]
        for name in names
        for at, axis in enumerate("xy")
    }
