"""`crankcheck graph`: graphs differentiated and integrated with ruler and pole."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, TypeVar

from rich.console import Console

from analytic.lectures.drawings.graphical import METHODS, Method
from models.errors import CrankcheckError, shown
from models.files.reading import find_scene, load_scene
from reports.lectures.drawing.sheet_requests import ENDINGS, LogMap, SheetFile, save_sheet
from reports.lectures.drawing.sheets import graph_drawing, graph_orders, graph_words
from reports.lectures.drawing.sheets.graph_page import draw_graphs, laid_out
from reports.lectures.drawing.sheets.graph_span import OVERS, over_period
from reports.lectures.drawing.sheets.paper import Paper, of_elastic, sheet_note
from reports.output.console import say_whole
from reports.output.write import check_file
from reports.requests.options import Duration, PaperSize, SceneName, option

LEAST_PARTS, MOST_PARTS, MOST_COUNTS = 4, 1440, 12
Name = TypeVar("Name", bound=str)
MOST_DIGITS = 9
"""Most digits of a number; longer ones are not parsed."""


@dataclass(frozen=True)
class GraphRequest:
    """Arguments of `graph`, as given."""

    scene: SceneName
    of: Annotated[str, option("A link, a slider, or a coordinate: C.x.", "NAME")]
    divisions: Annotated[
        str, option("Parts of the period; for several numbers: their errors.", "N[,N...]")
    ] = "24"
    by: Annotated[str, "chords, tangents, or integration (of the acceleration)."] = "chords"
    over: Annotated[str, "time, or angle of the driver."] = "time"
    log: Annotated[
        Path | None, option("A log of an engine, drawn beside it in the same way.", "FILE")
    ] = None
    map: LogMap = None
    duration_s: Duration = None
    paper: PaperSize = "A4"
    output: SheetFile = None

    def run(self, console: Console, progress: Console) -> int:
        """Show or draw graphs. Raises CrankcheckError for a faulty request."""
        paper = Paper.of(self.paper)
        divisions = counts(self.divisions)
        by = _chosen("--by", self.by, METHODS, ", ")
        over = _chosen("--over", self.over, OVERS, " or ")
        if self.map is not None and self.log is None:
            raise CrankcheckError(f"--map {self.map}: belongs to a log; give --log as well")
        read = [find_scene(self.scene), self.log, self.map]
        check_file(self.output, "-o", ENDINGS, inputs=read)
        scene = load_scene(self.scene)
        of = over_period(scene, self.of, over, self.duration_s)
        log = None
        if self.log is not None:
            log = graph_drawing.graph_log(self.log, self.map, of)
            of = log.span
        if len(divisions) > 1:
            _tell_errors(self, console, graph_orders.graph_errors(of, by, divisions, log), paper)
        else:
            _tell_graphs(
                self, console, graph_drawing.drawn_graphs(of, by, divisions[0], log), paper
            )
        return 0


def _tell_graphs(
    request: GraphRequest, console: Console, drawn: graph_drawing.DrawnGraphs, paper: Paper
) -> None:
    of = drawn.span
    told = (
        f"{of.quantity.name} of {of.scene.name} in {drawn.parts} parts{_by(drawn.by)}"
        f"{of_elastic(of.scene, ', its elastic links taken as rigid')}; "
        f"{graph_words.told_errors(drawn, drawn.reference)}"
    )
    if request.output is None:
        graph_words.show_graphs(console, drawn)
        say_whole(console, told)
    else:
        canvas = draw_graphs(laid_out(drawn, paper), sheet_note(of.scene))
        save_sheet(console, canvas, request.output, told)
    if drawn.logged is not None:
        say_whole(console, *graph_words.told_log(drawn))


def _tell_errors(
    request: GraphRequest, console: Console, errors: graph_orders.GraphErrors, paper: Paper
) -> None:
    of = errors.span
    if request.output is not None:
        told = f"errors of {of.quantity.name} of {of.scene.name} over divisions{_by(errors.by)}"
        canvas = graph_orders.draw_errors(errors, paper, sheet_note(of.scene))
        save_sheet(console, canvas, request.output, told)
    graph_orders.show_errors(console, errors)
    if errors.log is not None:
        say_whole(console, graph_orders.told_floor(errors))


def _by(method: Method) -> str:
    return "" if method == "chords" else f" by {method}"


def counts(text: str) -> Sequence[int]:
    """Parse numbers of divisions, rising. Raises CrankcheckError."""
    words = text.split(",")
    if not all(word.strip().isdecimal() for word in words):
        raise CrankcheckError(
            f"--divisions {shown(text)}: give whole numbers, such as 24, or 12,24,48"
        )
    # Zeros in front count as digits, too: a number too long is out of bounds either way.
    found = [int(word) if len(word.strip()) <= MOST_DIGITS else MOST_PARTS + 1 for word in words]
    if not all(LEAST_PARTS <= each <= MOST_PARTS for each in found):
        raise CrankcheckError(
            f"--divisions {shown(text)}: a period has {LEAST_PARTS} to {MOST_PARTS} parts"
        )
    if len(found) > MOST_COUNTS or found != sorted(set(found)):
        raise CrankcheckError(
            f"--divisions {shown(text)}: give up to {MOST_COUNTS} numbers, each above the one "
            "before"
        )
    return found


def _chosen(option: str, text: str, names: Sequence[Name], between: str) -> Name:
    """The name that a text is. Raises CrankcheckError for none of them."""
    for name in names:
        if text == name:
            return name
    raise CrankcheckError(f"{option} {shown(text)}: unknown; use {between.join(names)}")
