"""`crankcheck solve --family`: mechanisms that differ in one number, side by side."""

from __future__ import annotations

import math
from pathlib import Path

from rich.console import Console

from models.errors import CrankcheckError, harmless
from models.scene import Scene
from reports.lectures.drawing.workbook.family import FamilyCurves, family, family_curves
from reports.lectures.drawing.workbook.live_workbook import MOST_LIVE, formulas_of, live_workbook
from reports.lectures.drawing.workbook.scene_family import scene_curves, scene_family
from reports.lectures.drawing.workbook.scene_family_workbook import scene_family_workbook
from reports.output.write import write
from reports.requests.options import given
from reports.requests.solve_options import SolveOptions
from reports.requests.solving import (
    FAMILY_ENDINGS,
    PAGE,
    WORKBOOK,
    elastic_choice,
    instants_of,
    refuse_times,
)
from reports.way.way import way_of

LARGEST = 1e9
"""Of any number of a mechanism [SI]."""


def run_family(scene: Scene, request: SolveOptions, console: Console) -> None:
    """Write the family. Raises CrankcheckError for what can not be asked."""
    assert request.family is not None
    _check(scene, request)
    name, values = _values(request.family)
    if request.output is None:
        raise CrankcheckError(
            f"--family {request.family}: give a file for it, -o FILE{', FILE'.join(FAMILY_ENDINGS)}"
        )
    time_s = instants_of(scene, request)
    if time_s.size * len(values) > MOST_LIVE:
        raise CrankcheckError(
            f"--family {request.family}: {time_s.size} rows of {len(values)} members; at most "
            f"{MOST_LIVE} of all together: take fewer turns, or fewer steps in a turn"
        )
    origin = {"scene": scene.name, "source": scene.source, "family": request.family}
    is_workbook = request.output.suffix.lower() == WORKBOOK
    step_deg = math.degrees(float(time_s[1]) * scene.pace_rad_s)
    table = formulas_of(scene, time_s.size, step_deg)
    if table is not None and is_workbook:
        content: bytes | str = live_workbook(family(table, name, values), origin)
    elif table is not None:
        content = _drawn(scene, request.output, family_curves(table, name, values))
    else:
        members = scene_family(scene, name, values, time_s)
        content = (
            scene_family_workbook(members, origin)
            if is_workbook
            else _drawn(scene, request.output, scene_curves(members))
        )
    write(request.output, content)
    told = f"{request.output}: {len(values)} members of {scene.name}, {time_s.size} rows"
    console.print(harmless(told), highlight=False, markup=False, soft_wrap=True)


def _drawn(scene: Scene, path: Path, curves: FamilyCurves) -> bytes | str:
    """The page, or the drawing, of a family."""
    from reports.lectures.drawing.workbook.family_report import (  # slow to import
        family_drawing,
        family_page_of,
    )

    ending = path.suffix.lower()
    if ending == PAGE:
        return family_page_of(scene, curves)
    return family_drawing(scene, curves, ending[1:])


NO_FAMILY = {"elastic": "has elastic links", "let go": "is let go"}
"""Kinds of scenes that have no family, and why."""


def _check(scene: Scene, request: SolveOptions) -> None:
    """Refuse a family of what has none, or of a single position. Raises CrankcheckError."""
    if why := NO_FAMILY.get(way_of(scene).kinds[0]):
        raise CrankcheckError(
            f"--family {request.family}: {scene.name} {why}; members of a family have rigid "
            "links, and follow a law of motion"
        )
    for option in given(request, "at_deg", "at_m", "clockwise", "along", "forces", "figures"):
        raise CrankcheckError(
            f"--family with {option}: a family is position, velocity and acceleration over "
            f"whole turns; leave {option} out"
        )
    refuse_times(scene, request)
    elastic_choice(request).refuse_of_rigid(scene)


def _values(text: str) -> tuple[str, list[float]]:
    """A name and numbers, from text such as L=3.5,2.5."""
    name, equals, numbers = text.partition("=")
    try:
        values = [float(number) for number in numbers.split(",")] if equals else []
    except ValueError:
        values = []
    if not values or not all(abs(value) <= LARGEST for value in values):
        raise CrankcheckError(
            f"--family {text}: write a name and numbers up to {LARGEST:g}, such as L=3.5,2.5,2.2"
        )
    return name.strip(), values
