"""`crankcheck positions`, `centres` and `chains`: sheets drawn to scale."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from rich.console import Console

from analytic.lectures.chains.assur_groups import Mechanism, inversions
from analytic.lectures.chains.chain import Chain, assortment_in_words, assortments
from analytic.lectures.chains.chain_synthesis import chain_names, chains, type_in_letters, types
from analytic.lectures.drawings.drawn_polygons import draw_polygons
from analytic.lectures.drawings.instant_centres import CentreCircle, CurvatureCircles
from analytic.lectures.drawings.polygon import DriverState
from analytic.structure.mobility import analyse, refuse_other_than_cranked
from models.array import Array
from models.errors import CrankcheckError
from models.files.reading import find_scene, load_scene
from reports.describe.facts import angle_at, driver_at
from reports.lectures.drawing.sheets.centre_sheet import (
    CentreSheet,
    body_numbers,
    centre_name,
    centres_of,
    draw_centres,
)
from reports.lectures.drawing.sheets.paper import Canvas, Paper, sheet_note
from reports.lectures.drawing.sheets.position_sheet import (
    DrawnChain,
    check_room,
    draw_chains,
    draw_positions,
    positions,
)
from reports.lectures.drawing.sheets.scheme import sense_of_law
from reports.output.console import grid, say, say_whole
from reports.output.numbers import count, roman
from reports.output.write import check_file, crankcheck_version, write
from reports.requests.options import PaperSize, SceneName, option, output_option

ENDINGS = (".svg", ".pdf")


SheetFile = Annotated[Path | None, output_option("Draw it: .svg in layers, or .pdf.")]
LogMap = Annotated[Path | None, option("TOML with the meaning of its columns.", "FILE")]


@dataclass(frozen=True)
class PositionsRequest:
    """Arguments of `positions`, as given."""

    scene: SceneName
    output: Annotated[Path, output_option("Draw it: .svg in layers, or .pdf.")]
    divisions: Annotated[int, option("Parts of the crank circle.", min=2, max=360)] = 12
    paper: PaperSize = "A4"

    def run(self, console: Console, progress: Console) -> int:
        """Draw positions. Raises CrankcheckError for a faulty request."""
        check_file(self.output, "-o", ENDINGS, inputs=[find_scene(self.scene)])
        paper = Paper.of(self.paper)
        scene = load_scene(self.scene)
        sheet = positions(scene, self.divisions, paper)
        told = f"{self.divisions} positions of {scene.name}, K_l = {sheet.scale:g} m/mm"
        save_sheet(console, draw_positions(sheet, sheet_note(scene)), self.output, told)
        return 0


def save_sheet(console: Console, canvas: Canvas, path: Path, told: str) -> None:
    """Write a sheet, and print its name and content."""
    write(path, canvas.saved(path.suffix.lower()[1:], told))
    say_whole(console, f"{path}: {told}")


@dataclass(frozen=True)
class CentresRequest:
    """Arguments of `centres`, as given."""

    scene: SceneName
    at_deg: Annotated[float, option("The driver's angle.", "DEG")] = 60.0
    link: Annotated[str, option("Also its poles, circles of curvature and centrodes.", "NAME")] = ""
    paper: PaperSize = "A4"
    output: SheetFile = None

    def run(self, console: Console, progress: Console) -> int:
        """Show or draw centres. Raises CrankcheckError for a faulty request."""
        paper = Paper.of(self.paper)
        check_file(self.output, "-o", ENDINGS, inputs=[find_scene(self.scene)])
        scene = load_scene(self.scene)
        refuse_other_than_cranked(scene, "a sheet of instant centres", analyse(scene))
        # Centres do not depend on the speed; circles need the acceleration at a constant one.
        angle = angle_at(self.at_deg) if scene.is_free else driver_at(scene, self.at_deg)[0]
        drawn = draw_polygons(scene, DriverState(angle, sense_of_law(scene)))
        sheet = centres_of(drawn, self.link, paper)
        if self.output is not None:
            told = f"instant centres of {scene.name} at {self.at_deg:g} deg"
            save_sheet(console, draw_centres(sheet, sheet_note(scene)), self.output, told)
            return 0
        _show(console, sheet)
        return 0


def _show(console: Console, sheet: CentreSheet) -> None:
    numbers = body_numbers(sheet.drawn)
    bodies = ", ".join(f"{k} {body}" for body, k in numbers.items())
    say(console, f"bodies: {bodies}")
    rows = []
    ranked = sorted(sheet.centres.items(), key=lambda each: sorted(numbers[b] for b in each[0]))
    for pair, centre in ranked:
        crossing = " and ".join(
            " ".join(centre_name(each, numbers) for each in pairs) for pairs in centre.by
        )
        found = f"where {crossing} cross" if crossing else "a joint"
        rows.append((centre_name(pair, numbers), *_place(centre.place), found))
    console.print(
        grid(("centre", "x m:", "y m:", "found"), rows, cut=("centre", "found"), wraps=True)
    )
    if sheet.circles is not None:
        _show_circles(console, sheet.link, sheet.circles)


def _place(place: Array | None) -> tuple[str, str]:
    return ("at infinity", "") if place is None else (f"{place[0]:.8g}", f"{place[1]:.8g}")


def _show_circles(console: Console, link: str, circles: CurvatureCircles) -> None:
    second = circles.still_speed
    rows = [
        ("velocity pole P", *_place(circles.pole), ""),
        ("acceleration pole Q", *_place(circles.acceleration_pole), ""),
        ("inflection circle, middle", *_circle(circles.inflection)),
        (
            "second circle of Bresse, middle",
            *(_circle(second) if second else ("a straight line, as its alpha is 0", "", "")),
        ),
    ]
    heads = (f"of {link}, driver steady", "x m:", "y m:", "radius m:")
    console.print("", grid(heads, rows, cut=heads, wraps=True), sep="\n")


def _circle(circle: CentreCircle) -> tuple[str, str, str]:
    return *_place(circle.middle), f"{circle.radius:.8g}"


MOST_TYPED = 8
"""Most links of chains whose types are listed."""


@dataclass(frozen=True)
class ChainsRequest:
    """Arguments of `chains`, as given."""

    links: Annotated[int, option("Number of links, with the ground.", "N")] = 6
    mobility: Annotated[int, option("Their mobility.", "W")] = 1
    inversions: Annotated[bool, "Also the mechanisms, with each link as the ground."] = False
    sliders: Annotated[
        int | None, option("Type synthesis: up to so many sliders in place of pins.", "K")
    ] = None
    paper: PaperSize = "A4"
    output: Annotated[Path | None, output_option("Draw them: .svg in layers, or .pdf.")] = None

    def run(self, console: Console, progress: Console) -> int:
        """List or draw chains. Raises CrankcheckError for a faulty request."""
        paper = Paper.of(self.paper)
        check_file(self.output, "-o", ENDINGS)
        named = list(_asked(self))
        rows = [row for name, chain in named for row in _rows(self, name, chain)]
        kind = "chains" if self.sliders is None else "types of chains"
        told = f"{len(named)} {kind} of {self.links} links with mobility {self.mobility}"
        if self.inversions:
            told += f", {len(rows)} mechanisms"
        if self.output is not None:
            check_room(len(rows), paper)
            note = f"crankcheck {crankcheck_version()}, W = 3 (n - 1) - 2 p"
            save_sheet(console, draw_chains(rows, told, note, paper), self.output, told)
            return 0
        say(console, told)
        _show_chains(console, self, rows)
        if self.sliders is None and not self.inversions:
            _show_assortments(console, self, [chain for _, chain in named])
        return 0


def _asked(request: ChainsRequest) -> Iterator[tuple[str, Chain]]:
    """The chains of pins with their names; with ``sliders`` their types instead."""
    if request.sliders is not None and request.sliders < 0:
        raise CrankcheckError(f"--sliders {request.sliders}: give 0 or more")
    if request.sliders is not None and request.links > MOST_TYPED:
        raise CrankcheckError(
            f"--sliders with {request.links} links: types are listed of chains of up to "
            f"{MOST_TYPED} links"
        )
    pinned = chains(request.links, request.mobility)
    for name, chain in zip(chain_names(pinned), pinned, strict=True):
        if request.sliders is None:
            yield name, chain
            continue
        for k, one in enumerate(types(chain, request.sliders), 1):
            number = "" if chain.loops == 1 else f"{name}-{k} "
            yield f"{number}{type_in_letters(one)}", one


def _rows(request: ChainsRequest, name: str, chain: Chain) -> Iterator[DrawnChain]:
    """The listed or drawn rows of a chain: itself, or its mechanisms."""
    if not request.inversions:
        counted = count(len(inversions(chain, name)), "mechanism")
        yield DrawnChain(chain, name, f"{assortment_in_words(chain.assortment)}; {counted}")
        return
    for mechanism in inversions(chain, name):
        yield DrawnChain(chain, mechanism.name, _words(mechanism), mechanism.ground)


def _words(mechanism: Mechanism) -> str:
    """The class by each driver, where one driver determines all positions."""
    if mechanism.chain.mobility != 1:
        return f"ground link {mechanism.ground + 1}"
    classes = sorted(set(mechanism.classes().values()))
    return "class " + " or ".join(map(roman, classes))


def _show_chains(console: Console, request: ChainsRequest, rows: list[DrawnChain]) -> None:
    heads = ["chain", "links"]
    if request.inversions:
        heads = ["mechanism", "ground", "by its drivers"]
    cells = []
    for row in rows:
        ground = [] if row.ground is None else [f"link {row.ground + 1}"]
        joints = " ".join(
            f"{a + 1}-{b + 1}{'*' * ((a, b) in row.chain.sliders)}" for a, b in row.chain.joints
        )
        cells.append((row.name, *ground, row.words, joints))
    console.print(grid((*heads, "joints of links, sliders with *"), cells))


def _show_assortments(console: Console, request: ChainsRequest, every: list[Chain]) -> None:
    rows = (
        (assortment_in_words(counts), str(sum(chain.assortment == counts for chain in every)))
        for counts in assortments(request.links, request.mobility)
    )
    heads = ("assortment of links", "chains:")
    console.print("", grid(heads, rows, cut=heads, wraps=True), sep="\n")
