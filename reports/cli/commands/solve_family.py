"""`crankcheck solve --family`: mechanisms that differ in one length, side by side in a workbook."""

from __future__ import annotations

import math

from rich.console import Console

from models.errors import CrankcheckError, harmless
from models.scene import Scene
from reports.cli.commands.solve import instants_of
from reports.cli.showing import SolveRequest
from reports.output.write import write
from reports.workbook.family import family
from reports.workbook.live_workbook import formulas_of, live_workbook

WORKBOOK = ".xlsx"


def run_family(scene: Scene, request: SolveRequest, console: Console) -> None:
    """Write the family. Raises CrankcheckError for what can not be asked."""
    assert request.family is not None
    name, values = _values(request.family)
    if request.output is None or request.output.suffix.lower() != WORKBOOK:
        raise CrankcheckError(
            f"--family {request.family}: it is a workbook; give -o FILE{WORKBOOK}"
        )
    time_s = instants_of(scene, request)
    step_deg = math.degrees(float(time_s[1]) * scene.driver.law.peak_speed_rad_s)
    table = formulas_of(scene, time_s.size, step_deg)
    if table is None:
        raise CrankcheckError(
            f"--family: {scene.name} has no formulas of its own; a four-bar, a slider-crank or a "
            "slotted lever at constant speed has"
        )
    origin = {"scene": scene.name, "source": scene.source, "family": request.family}
    write(request.output, live_workbook(family(table, name, values), origin))
    told = f"{request.output}: {len(values)} members of {scene.name}, {time_s.size} rows"
    console.print(harmless(told), highlight=False, markup=False, soft_wrap=True)


def _values(text: str) -> tuple[str, list[float]]:
    """A name and numbers, from text such as L=3.5,2.5."""
    name, equals, numbers = text.partition("=")
    try:
        values = [float(number) for number in numbers.split(",")] if equals else []
    except ValueError:
        values = []
    if not values or not all(map(math.isfinite, values)):
        raise CrankcheckError(f"--family {text}: write a name and numbers, such as L=3.5,2.5,2.2")
    return name.strip(), values
