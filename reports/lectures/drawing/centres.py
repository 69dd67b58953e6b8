"""`crankcheck centres`: instant centres, and the circles of a link."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from analytic.lectures.drawings.drawn_polygons import draw_polygons
from analytic.lectures.drawings.placed_mechanism import DriverState
from analytic.structure.mobility import analyse, refuse_other_than_cranked
from models.array import Array
from models.files.reading import find_scene, load_scene
from models.scene import Scene
from reports.describe.facts import angle_at, driver_at
from reports.lectures.drawing.positions import ENDINGS, save_sheet
from reports.lectures.drawing.sheets.centre_sheet import (
    CentreSheet,
    body_numbers,
    centre_name,
    centres_of,
    draw_centres,
)
from reports.lectures.drawing.sheets.paper import Paper, sheet_note
from reports.lectures.drawing.sheets.scheme import sense_of_law
from reports.output.console import plain_table
from reports.output.write import check_file
from reports.requests.options import PaperSize, SceneName


@dataclass(frozen=True)
class CentresRequest:
    """What `centres` was asked for, as given."""

    scene: SceneName
    at_deg: Annotated[float, typer.Option(metavar="DEG", help="The driver's angle.")] = 60.0
    link: Annotated[
        str,
        typer.Option(metavar="NAME", help="Its poles, circles of curvature and centrodes as well."),
    ] = ""
    paper: PaperSize = "A4"
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="Draw it: .svg in layers, or .pdf.")
    ] = None

    def run(self, console: Console, progress: Console) -> int:
        """Show or draw centres. Raises CrankcheckError for what can not be asked."""
        paper = Paper.of(self.paper)
        if self.output is not None:
            check_file(self.output, "-o", ENDINGS, inputs=[find_scene(self.scene)])
        scene = load_scene(self.scene)
        refuse_other_than_cranked(scene, "a sheet of instant centres", analyse(scene))
        # Centres do not depend on the speed; circles ask for the acceleration at a constant one.
        drawn = draw_polygons(scene, DriverState(_angle(scene, self.at_deg), sense_of_law(scene)))
        sheet = centres_of(drawn, self.link, paper)
        if self.output is not None:
            told = f"instant centres of {scene.name} at {self.at_deg:g} deg"
            save_sheet(console, draw_centres(sheet, sheet_note(scene)), self.output, told)
            return 0
        _show(console, sheet)
        return 0


def _angle(scene: Scene, at_deg: float) -> float:
    """The driver's angle [rad]. Raises CrankcheckError for one that its law never comes to."""
    return angle_at(at_deg) if scene.is_free else driver_at(scene, at_deg)[0]


def _show(console: Console, sheet: CentreSheet) -> None:
    numbers = body_numbers(sheet.drawn)
    bodies = ", ".join(f"{k} {body}" for body, k in numbers.items())
    console.print(f"bodies: {bodies}", highlight=False, markup=False)
    table = plain_table(gap=2)
    for head in ("centre", "x m", "y m", "found"):
        table.add_column(head, justify="right" if head.endswith(" m") else "left")
    ranked = sorted(sheet.centres.items(), key=lambda each: sorted(numbers[b] for b in each[0]))
    for pair, centre in ranked:
        crossing = " and ".join(
            " ".join(centre_name(each, numbers) for each in pairs) for pairs in centre.by
        )
        found = f"where {crossing} cross" if crossing else "a joint"
        table.add_row(centre_name(pair, numbers), *_place(centre.place), found)
    console.print(table)
    if sheet.circles is not None:
        _show_circles(console, sheet)


def _place(place: Array | None) -> tuple[str, str]:
    return ("at infinity", "") if place is None else (f"{place[0]:.8g}", f"{place[1]:.8g}")


def _show_circles(console: Console, sheet: CentreSheet) -> None:
    """The poles and circles of the link that was named."""
    circles = sheet.circles
    assert circles is not None
    table = plain_table(gap=2)
    for head in (f"of {sheet.link}, driver steady", "x m", "y m", "radius m"):
        table.add_column(head, justify="right" if head.endswith(" m") else "left")
    table.add_row("velocity pole P", *_place(circles.pole), "")
    table.add_row("acceleration pole Q", *_place(circles.acceleration_pole), "")
    for name, circle in (
        ("inflection circle, middle", circles.inflection),
        ("second circle of Bresse, middle", circles.still_speed),
    ):
        if circle is None:
            table.add_row(name, "a straight line, as its alpha is 0", "", "")
        else:
            table.add_row(name, *_place(circle.middle), f"{circle.radius:.8g}")
    console.print("", table, sep="\n")
