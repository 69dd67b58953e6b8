"""`crankcheck solve`: the reference alone, at one driver angle or over time."""

from __future__ import annotations

import io
import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd
from rich.console import Console

from analytic.kinematics import solve, solve_driven
from analytic.mechanism.cycle import Along
from analytic.structure.mobility import Structure, analyse
from models.errors import CrankcheckError, harmless, suggestion
from models.files import load_scene
from models.motion import Motion
from models.passing import passing
from models.scene import Scene
from reports.cli.showing import SolveRequest
from reports.describe.facts import facts, speed_facts
from reports.describe.frame import cleaned, motion_frame
from reports.describe.law import describe_law
from reports.describe.tables import certainty, motion_tables, position_tables, speed_table
from reports.output.provenance import crankcheck_version
from reports.output.write import check_file, clean, write
from reports.plan.singular import continued_note, singular_note

ENDINGS = (".csv", ".parquet", ".xlsx")
ON_SCREEN = 12
IN_A_FILE = 360
MOST_SAMPLES = 1_000_000
MOST_DEG = 1e6
"""As in a scene file: an angle that is larger has lost the digits that are within a turn."""
ENDLESS = 10**15
"""Steps beyond which a float does not count them."""
SHEET_ROWS = 1_048_575


def run_solve(request: SolveRequest, console: Console) -> None:
    """Show or write the reference. Raises CrankcheckError for what can not be asked."""
    if request.at_deg is not None and (request.turns or request.steps_per_turn):
        raise CrankcheckError(
            "--at-deg with --turns or --steps-per-turn: one is a single position, the others a "
            "motion; give one of them"
        )
    if request.clockwise and request.at_deg is None:
        raise CrankcheckError("--clockwise: it is of one position; give --at-deg, such as 90")
    if request.output is not None:
        check_file(request.output, "-o", ENDINGS)
    scene = load_scene(request.scene)
    along = [_along(scene, text) for text in request.along]
    structure = analyse(scene)
    motion = (
        _over(scene, request)
        if request.at_deg is None
        else _at(scene, request.at_deg, clockwise=request.clockwise)
    )
    if request.output is not None:
        _write(request.output, scene, motion)
        told = harmless(f"{request.output}: {motion.time_s.size} samples of {scene.name}")
        console.print(told, highlight=False, markup=False)
        return
    console.print(heading(scene, structure, along), highlight=False, markup=False)
    if (speeds := speed_facts(scene, along, clockwise=request.clockwise)) and speeds.rows:
        console.print(speed_table(speeds), "")
    if request.at_deg is not None:
        for table in position_tables(scene, cleaned(motion)):
            console.print(table, "")
        console.print(certainty(motion), style="dim", highlight=False)
    else:
        for table in motion_tables(scene, cleaned(motion), console.width):
            console.print(table, "")
        console.print(
            "Points, and more digits: -o out.csv, .parquet or .xlsx", style="dim", highlight=False
        )
    for note in filter(None, (continued_note(motion), singular_note(scene, motion))):
        console.print(note, style="yellow", highlight=False, markup=False)


def heading(scene: Scene, structure: Structure, along: Sequence[Along] = ()) -> str:
    """What the mechanism is, and what the theory says of it as a whole."""
    groups = ", ".join(f"{g.kind} ({g.first}, {g.second})" for g in structure.groups)
    lines = [
        f"{scene.name}: {scene.source}",
        f"{structure.words}; driver {scene.driver.link}, {describe_law(scene)}; "
        f"groups in solving order: {groups}",
        *facts(scene, structure, along),
    ]
    return "\n".join(lines) + "\n"


def _along(scene: Scene, text: str) -> Along:
    """A point and a direction, from text such as C:30."""
    point, colon, degrees = text.partition(":")
    try:
        direction_deg = float(degrees)
    except ValueError:
        direction_deg = math.nan
    if not (colon and abs(direction_deg) <= MOST_DEG):
        raise CrankcheckError(
            f"--along {text}: write a point and a direction in degrees, such as C:30"
        )
    points = dict.fromkeys([*scene.pins, *(slider.point for slider in scene.sliders.values())])
    if point not in points:
        raise CrankcheckError(f"--along {text}: {suggestion(point, points, 'the points are')}")
    return Along(point, math.radians(direction_deg))


def _at(scene: Scene, at_deg: float, *, clockwise: bool = False) -> Motion:
    """The mechanism with its driver at an angle, moving as its law moves it there."""
    if not abs(at_deg) <= MOST_DEG:
        raise CrankcheckError(
            f"--at-deg {at_deg:g}: give an angle in degrees, such as 90, up to {MOST_DEG:g}"
        )
    theta = math.radians(at_deg)
    try:
        omega, alpha = passing(scene.driver.law, theta, clockwise=clockwise)
    except ValueError as error:
        raise CrankcheckError(f"--at-deg {at_deg:g}: the driver of {scene.name} {error}") from None
    return solve_driven(scene, np.array([theta]), np.array([omega]), np.array([alpha]))


def _over(scene: Scene, request: SolveRequest) -> Motion:
    """The motion over whole turns, the last sample included."""
    turns = 1.0 if request.turns is None else request.turns
    steps = request.steps_per_turn
    if steps is None:
        steps = ON_SCREEN if request.output is None else IN_A_FILE
    if not (math.isfinite(turns) and turns > 0.0):
        raise CrankcheckError(f"--turns {turns:g}: give a number above 0; 1 is one period")
    if steps < 1:
        raise CrankcheckError(f"--steps-per-turn {steps}: give at least 1")
    most = MOST_SAMPLES
    if request.output is not None and request.output.suffix.lower() == ".xlsx":
        most = SHEET_ROWS
    steps = min(steps, ENDLESS)
    last = turns * steps * (1 - 1e-12)  # may be infinite
    if not last <= most - 1:
        raise CrankcheckError(
            f"--turns {turns:g} --steps-per-turn {steps}: {last + 1:.7g} samples; at most {most}: "
            "take fewer turns, or fewer steps in a turn"
        )
    samples = math.ceil(last) + 1
    step_s = scene.driver.law.period_s / steps
    return solve(scene, step_s * np.arange(samples, dtype=np.float64))


def _write(path: Path, scene: Scene, motion: Motion) -> None:
    """The motion as a file of the kind that the ending says."""
    frame = motion_frame(motion)
    ending = path.suffix.lower()
    if ending == ".csv":
        write(path, frame.to_csv(index=False, lineterminator="\n"))
    elif ending == ".parquet":
        # It brings the comparison, which nothing else here needs.
        from reports.output.frame_file import parquet

        write(path, parquet(frame))
    else:
        write(path, _workbook(frame, scene))


def _workbook(frame: pd.DataFrame, scene: Scene) -> bytes:
    """A workbook: the motion, and where it comes from."""
    facts = {"scene": scene.name, "source": scene.source, "crankcheck": crankcheck_version()}
    buffer = io.BytesIO()
    with pd.ExcelWriter(buffer, engine="openpyxl") as book:
        shown = frame.rename(columns=clean)
        shown.to_excel(book, sheet_name="motion", index=False, freeze_panes=(1, 1))
        origin = pd.DataFrame({"what": list(facts), "value": [clean(v) for v in facts.values()]})
        origin.to_excel(book, sheet_name="source", index=False)
        for row in book.sheets["source"].iter_rows():
            for cell in row:
                cell.data_type = "s"  # a text that begins with "=" is no formula
    return buffer.getvalue()
