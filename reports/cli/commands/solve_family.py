"""`crankcheck solve --family`: mechanisms that differ in one number, side by side."""

from __future__ import annotations

import math

from rich.console import Console

from models.errors import CrankcheckError, harmless
from models.scene import Scene
from reports.cli.commands.solve import (
    FAMILY_ENDINGS,
    PAGE,
    WORKBOOK,
    elastic_choice,
    instants_of,
    refuse_times,
)
from reports.cli.showing import SolveRequest
from reports.output.write import write
from reports.workbook.beside_values import MOST_LIVE
from reports.workbook.family import family
from reports.workbook.family_curves import family_curves
from reports.workbook.formula_table import FormulaTable
from reports.workbook.live_workbook import formulas_of, live_workbook


def run_family(scene: Scene, request: SolveRequest, console: Console) -> None:
    """Write the family. Raises CrankcheckError for what can not be asked."""
    assert request.family is not None
    _check(scene, request)
    name, values = _values(request.family)
    if request.output is None:
        raise CrankcheckError(
            f"--family {request.family}: give a file for it, -o FILE{', FILE'.join(FAMILY_ENDINGS)}"
        )
    content = _content(scene, request, _table(scene, request), name, values)
    write(request.output, content)
    rows = instants_of(scene, request).size
    told = f"{request.output}: {len(values)} members of {scene.name}, {rows} rows"
    console.print(harmless(told), highlight=False, markup=False, soft_wrap=True)


def _table(scene: Scene, request: SolveRequest) -> FormulaTable:
    """The formulas of a scene over the instants that are asked for. Raises CrankcheckError."""
    time_s = instants_of(scene, request)
    if time_s.size > MOST_LIVE:
        raise CrankcheckError(
            f"--family {request.family}: {time_s.size} rows of formulas; a spreadsheet takes up to "
            f"{MOST_LIVE} while one looks on: take fewer turns, or fewer steps in a turn"
        )
    step_deg = math.degrees(float(time_s[1]) * scene.driver.law.peak_speed_rad_s)
    table = formulas_of(scene, time_s.size, step_deg)
    if table is None:
        raise CrankcheckError(
            f"--family: {scene.name} has no formulas of its own; a four-bar, a slider-crank or a "
            "slotted lever at constant speed has"
        )
    return table


def _content(
    scene: Scene, request: SolveRequest, table: FormulaTable, name: str, values: list[float]
) -> bytes | str:
    """The file of the family, of the kind that its ending says."""
    assert request.output is not None
    ending = request.output.suffix.lower()
    if ending == WORKBOOK:
        origin = {"scene": scene.name, "source": scene.source, "family": str(request.family)}
        return live_workbook(family(table, name, values), origin)
    from reports.face.family_report import family_drawing, family_page_of  # slow to import

    curves = family_curves(table, name, values)
    if ending == PAGE:
        return family_page_of(scene, curves)
    return family_drawing(scene, curves, ending[1:])


def _check(scene: Scene, request: SolveRequest) -> None:
    """Refuse a family of what has none, or of a single position. Raises CrankcheckError."""
    if scene.elastic or scene.is_free:
        bends = "has elastic links" if scene.elastic else "is let go"
        raise CrankcheckError(
            f"--family {request.family}: {scene.name} {bends}; formulas are those of rigid links "
            "and a crank at constant speed"
        )
    for option, given in (
        ("--at-deg", request.at_deg is not None),
        ("--clockwise", request.clockwise),
        ("--along", bool(request.along)),
        ("--forces", request.forces),
        ("--figures", request.figures is not None),
    ):
        if given:
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
    if not values or not all(map(math.isfinite, values)):
        raise CrankcheckError(f"--family {text}: write a name and numbers, such as L=3.5,2.5,2.2")
    return name.strip(), values
