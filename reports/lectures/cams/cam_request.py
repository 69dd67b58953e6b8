"""`crankcheck cam`: from the task of a cam to its profile, checks and drawings."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from rich.console import Console

from analytic.cams.base_circle import refuse_undercut
from analytic.cams.cam_design import CamLimits, ExaminedCam, smallest_cam
from analytic.cams.contact_force import FollowerLoad
from models.errors import CrankcheckError
from models.files.assemble import scene_text
from models.lectures.shipped_tables import shipped_in
from models.lectures.tasks import TASKS
from models.lectures.tasks.cams import CamTask, load_cam_task
from models.scene.cams import Cam
from reports.lectures.cams.cam_scene import cam_scene
from reports.lectures.cams.cam_tables import document, show_cam
from reports.lectures.cams.profile_files import ProfileFiles
from reports.output.console import grid, say, say_whole
from reports.output.write import check_folder, write
from reports.requests.options import PaperSize, argument, option


@dataclass(frozen=True)
class CamRequest:
    """Arguments of `cam`, as given."""

    task: Annotated[
        str | None, argument("TASK", "A shipped task, or a task file (.toml); none lists them.")
    ] = None
    output: Annotated[
        Path | None, option("Folder of profile, drawings and JSON.", "-o --output DIR")
    ] = None
    points: Annotated[int, option("Points of the profile's files.", min=36, max=100_000)] = 3600
    json: Annotated[bool, "As JSON, not as tables."] = False
    paper: PaperSize = "A4"

    def run(self, console: Console, progress: Console) -> int:
        """Design, check and write a cam. Raises CrankcheckError for a faulty request."""
        if self.task is None:
            console.print(grid(("task",), ((name,) for name in shipped_in(TASKS / "cam"))))
            return 0
        task, path = load_cam_task(self.task)
        if self.output is not None:
            check_folder(self.output, "-o", inputs=[path])
        limits = limits_of(task)
        cam = cam_of(task, limits)
        refuse_undercut(cam)
        found = ExaminedCam(cam, task.speed_rad_s, load_of(task))
        faults = found.exceeded(limits)
        text = json.dumps(document(task.name, found, faults), indent=1)
        if self.json:
            say_whole(console, text)
        else:
            say(console, f"{task.name}: {task.source}")
            show_cam(console, found, faults)
        if self.output is not None:
            _write(self.output, task, found, self, f"{text}\n")
            if not self.json:
                say(
                    console,
                    f"\n{self.output}: profile as DXF, SVG and CSV, scene, drawings, cam.json",
                )
        return 1 if faults else 0


def limits_of(task: CamTask) -> CamLimits:
    """Return the limits of a task."""
    base = task.base
    rise, back = (
        None if angle is None else math.radians(angle)
        for angle in (base.pressure_deg, base.return_pressure_deg)
    )
    return CamLimits(rise, back, base.least_radius_m or 0.0)


def cam_of(task: CamTask, limits: CamLimits) -> Cam:
    """Return the cam of a task. Raises CrankcheckError where no base circle keeps its limits."""
    follower, sense = task.follower.follower, 1 if task.sense == "counter-clockwise" else -1
    try:
        if task.base.radius_m is None:
            return smallest_cam(task.law, follower, sense, limits)
        return Cam(task.law, task.base.radius_m, follower, sense)
    except ValueError as error:
        raise CrankcheckError(f"{task.name}: {error}") from None


def load_of(task: CamTask) -> FollowerLoad | None:
    """Return the load of a task."""
    load = task.load
    if load is None:
        return None
    angle = math.radians(load.weight_angle_deg)
    return FollowerLoad(load.inertia, load.stiffness, load.preload, load.weight, angle)


def _write(folder: Path, task: CamTask, found: ExaminedCam, request: CamRequest, text: str) -> None:
    """Write all files of a cam into a folder."""
    from reports.lectures.cams.cam_drawings import drawings  # matplotlib takes a second

    scene = cam_scene(task.name, task.source, found.cam, found.load, task.speed_rad_s)
    texts: dict[str, str | bytes] = {"cam.json": text, f"{task.name}.toml": scene_text(scene)}
    texts |= ProfileFiles(task.name, found.cam, request.points).written()
    texts |= drawings(task.name, task.source, found, request.paper)
    check_folder(folder, "-o", list(texts))
    for name, content in texts.items():
        write(folder / name, content)
