"""`crankcheck cam`: from the task of a cam to its profile, checks and drawings."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from rich.console import Console

from analytic.cams.cam_design import CamLimits, ExaminedCam, least_cam, refuse_undercut
from analytic.cams.contact_force import FollowerLoad
from models.errors import CrankcheckError
from models.files.assemble import scene_text
from models.lectures.shipped_tables import shipped_in
from models.lectures.tasks import TASKS
from models.lectures.tasks.cams import CamTask, load_cam_task
from models.scene.cam_laws import KINDS, CamLaw, peak_factors
from models.scene.cams import Cam
from reports.figures.layout import Layout, laid_out
from reports.lectures.cams.cam_scene import cam_scene
from reports.lectures.cams.profile_files import profile_files, unit_of
from reports.output.console import grid, say, say_whole, show_rows
from reports.output.write import check_folder, write
from reports.requests.options import PaperSize, argument, option

RATES = ("velocity", "acceleration", "jerk")
Rows = list[dict[str, object]]


@dataclass(frozen=True)
class CamRequest(Layout):
    """Arguments of `cam`, as given."""

    task: Annotated[
        str | None,
        argument("TASK", "A shipped task, or a task file (.toml); default: a list."),
    ] = None
    output: Annotated[
        Path | None, option("Folder of profile, drawings and JSON.", "-o --output DIR")
    ] = None
    points: Annotated[int, option("Points in the files of the profile.", min=36, max=100_000)] = (
        3600
    )
    json: Annotated[bool, "Print JSON, not tables."] = False
    paper: PaperSize = "A4"

    @laid_out
    def run(self, console: Console, progress: Console) -> int:
        """Design, check and write a cam. Raises CrankcheckError for a faulty request."""
        if self.task is None:
            console.print(grid(("task",), ((name,) for name in shipped_in(TASKS / "cam"))))
            return 0
        task, path = load_cam_task(self.task)
        if self.output is not None:
            check_folder(self.output, "-o", inputs=[path])
        found = designed(task)
        text = json.dumps(document(task.name, found), indent=1)
        if self.json:
            say_whole(console, text)
        else:
            say(console, f"{task.name}: {task.source}")
            show_cam(console, found)
        if self.output is not None:
            _write(self.output, task, found, self, f"{text}\n")
            if not self.json:
                say(
                    console,
                    f"\n{self.output}: profile as DXF, SVG and CSV, scene, drawings, cam.json",
                )
        return 1 if found.exceeded else 0


def designed(task: CamTask) -> ExaminedCam:
    """Return the cam of a task with its limits and its load. Raises CrankcheckError for one that
    undercuts, or where no base circle keeps the limits."""
    base, load, follower = task.base, task.load, task.follower.follower
    limits = CamLimits(
        math.radians(base.pressure_deg or math.inf),
        math.radians(base.return_pressure_deg or math.inf),
        base.least_radius_m or 0.0,
    )
    sense = 1 if task.sense == "counter-clockwise" else -1
    try:
        if base.radius_m is None:
            cam = least_cam(task.law, follower, sense, limits)
        else:
            cam = Cam(task.law, base.radius_m, follower, sense)
    except ValueError as error:
        raise CrankcheckError(f"{task.name}: {error}") from None
    refuse_undercut(cam)
    if load is None:
        return ExaminedCam(cam, limits, task.speed_rad_s)
    angle = math.radians(load.weight_angle_deg)
    closing = FollowerLoad(load.inertia, load.stiffness, load.preload, load.weight, angle)
    return ExaminedCam(cam, limits, task.speed_rad_s, closing)


def document(name: str, found: ExaminedCam) -> Mapping[str, object]:
    """Return all tables as one document for JSON."""
    return {
        "cam": name,
        "numbers": number_rows(found),
        "segments": segment_rows(found),
        "continuity": continuity(found.cam.law),
        "jumps": jump_rows(found.cam),
        "peak_factors": factor_rows(),
        "exceeded": found.exceeded,
    }


def show_cam(console: Console, found: ExaminedCam) -> None:
    """Print all tables of a cam."""
    for name, words in number_words(found).items():
        say(console, f"{name:<28}{words}")
    for title, rows in (
        (f"law, peaks at {found.speed_rad_s:g} rad/s", segment_rows(found)),
        (continuity(found.cam.law), jump_rows(found.cam)[:20]),
        ("peak factors of a rise of unit lift over unit span", factor_rows()),
    ):
        say(console, f"\n{title}")
        if rows:
            show_rows(console, rows, list(dict.fromkeys(key for row in rows for key in row)))
    say(console, "\n" + "\n".join(found.exceeded or ["within all limits that were given"]))


def number_rows(found: ExaminedCam) -> dict[str, float | str | None]:
    """Return the numbers of a cam by name with unit; None where there is none."""
    cam, unit = found.cam, unit_of(found.cam)
    rows: dict[str, float | str | None] = {
        "base_radius_m": cam.base_m,
        f"stroke_{unit}": cam.law.stroke,
        f"start_{unit}": cam.start,
    }
    (rise, rise_at), (back, back_at) = found.pressures
    extremes = [
        ("pressure_rise", "deg", math.degrees(rise), rise_at),
        ("pressure_return", "deg", math.degrees(back), back_at),
        ("convex_radius", "m", *found.radii[0]),
        ("concave_radius", "m", *found.radii[1]),
    ]
    if found.lift_off is not None:
        extremes.append(("lift_off", "rad_s", *found.lift_off))
    for name, own, size, at in extremes:
        rows[f"{name}_{own}"] = size if math.isfinite(size) else None
        rows[f"{name}_at_deg"] = math.degrees(at) if math.isfinite(size) else None
    if found.load is not None:
        rows["least_contact_force_n"], rows["largest_contact_force_n"] = found.force_range_n()
    return rows | {f"peak_{name}": x for name, x in _peaks(found, cam.law.peaks).items()}


def number_words(found: ExaminedCam) -> dict[str, str]:
    """Return the same by name in words, as they are printed."""
    return {
        name.replace("_", " "): "none" if x is None else f"{x:.8g}" if isinstance(x, float) else x
        for name, x in number_rows(found).items()
    }


def segment_rows(found: ExaminedCam) -> Rows:
    """Return the segments of the law, and the peaks of its rates by time at the cam's speed."""
    rows, start = Rows(), 0.0
    for one in found.cam.law.segments:
        row: dict[str, object] = {"from_deg": math.degrees(start), "motion": one.kind}
        row |= {"span_deg": math.degrees(one.span_rad), f"lift_{unit_of(found.cam)}": one.lift}
        start += one.span_rad
        if one.kind not in ("dwell", "table"):
            row |= _peaks(found, peak_factors(one.kind), abs(one.lift), one.span_rad)
        rows.append(row)
    return rows


def _peaks(
    found: ExaminedCam, peaks: Iterable[float], lift: float = 1.0, span_rad: float = 1.0
) -> dict[str, float | str]:
    """Return the rates by time of a motion with peaks of unit lift over unit span."""
    rows = {}
    for order, (name, peak) in enumerate(zip(RATES, peaks, strict=True), 1):
        value = peak * lift * (found.speed_rad_s / span_rad) ** order
        rows[f"{name}_{unit_of(found.cam)}_s{order if order > 1 else ''}"] = _finite(value)
    return rows


def _finite(value: float) -> float | str:
    return value if math.isfinite(value) else "infinite"


def factor_rows() -> Rows:
    """Return the peak factors of all laws: rises of unit lift over unit span, between dwells."""
    kinds = [kind for kind in KINDS if kind not in ("dwell", "table")]
    heads = [f"c_{rate}" for rate in RATES]
    return [
        {"motion": kind} | dict(zip(heads, map(_finite, peak_factors(kind)), strict=True))
        for kind in kinds
    ]


def jump_rows(cam: Cam) -> Rows:
    """Return the knots where lift, velocity, acceleration or jerk by the cam's angle jump: the
    first of them that does."""
    rows = Rows()
    for angle, *steps in cam.law.jumps:
        order = next(k for k, step in enumerate(steps) if step)
        row = {"at_deg": math.degrees(angle), "jumps": ("lift", *RATES)[order]}
        rows.append(row | {f"by_{unit_of(cam)}_rad{order}": steps[order]})
    return rows


def continuity(law: CamLaw) -> str:
    """Return the continuity of a law in words."""
    if law.continuous == 3:
        return "lift, velocity, acceleration and jerk are continuous"
    return f"{('lift', *RATES)[law.continuous + 1]} jumps; lower orders are continuous"


def _write(folder: Path, task: CamTask, found: ExaminedCam, request: CamRequest, text: str) -> None:
    """Write all files of a cam into a folder."""
    from reports.lectures.cams.cam_drawings import drawings  # matplotlib takes a second

    scene = cam_scene(task.name, task.source, found)
    texts: dict[str, str | bytes] = {"cam.json": text, f"{task.name}.toml": scene_text(scene)}
    texts |= profile_files(task.name, found.cam, request.points)
    texts |= drawings(task.name, task.source, found, number_words(found), request.paper)
    check_folder(folder, "-o", list(texts))
    for name, content in texts.items():
        write(folder / name, content)
