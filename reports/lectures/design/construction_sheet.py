"""The sheet of a construction: a layer for each step, the mechanism found, its letters; and the
column of words beside it: steps, looks, elements off the paper.

Source of the way of drawing: lecture "Tong hop co cau" (synthesis), examples 2 to 6.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle as Round

from analytic.lectures.synthesis import design
from analytic.lectures.synthesis.examine import Examined
from models.array import Array
from models.errors import CrankcheckError
from reports.figures.style import INK, LARGE, QUIET, SMALL, cut, wrapped
from reports.lectures.design.construction_view import (
    GIVEN,
    LOOKS,
    OTHERS,
    OTHERS_WIDTH,
    ConstructionView,
    Stroke,
    curves_of,
    look_of,
    strokes,
    xy,
)
from reports.lectures.drawing.sheets.letters import NUMBER, Letter, write_letters
from reports.lectures.drawing.sheets.paper import (
    MARGIN,
    MM_PER_IN,
    Box,
    Canvas,
    Paper,
    ToScale,
    headed,
    inner_box,
    layer_words,
    line,
    sheet_note,
    text,
)
from reports.lectures.drawing.sheets.scheme import PIN_MM, draw_foot, draw_outline, draw_scheme

ROW_MM, GAP_MM = 3.1, 1.3
"""Height of a line of the column, and gap between its parts."""
INSET_MM, HANGING_MM, SAMPLE_MM = 2.0, 5.5, 7.0
"""Margins at both sides of the column, before the words of a step, and for a line's sample."""
SPARE = 0.95
"""Usable share of the width: a viewer of the file may have wider type."""
KEY: dict[design.Look, str] = {"given": "given", "auxiliary": "construction"}


@dataclass(frozen=True)
class ColumnPart:
    """A paragraph of the column, with a hanging number or the sample of a line before it."""

    words: str
    before: str | Stroke = ""
    colour: str = INK
    weight: str = "normal"

    @property
    def hanging(self) -> float:
        """Distance of its words from the left [mm]."""
        if isinstance(self.before, Stroke):
            return SAMPLE_MM + 1.5
        return HANGING_MM if self.before else 0.0

    def lines(self, width: float) -> list[str]:
        """Its words in a column of a width [mm]."""
        room = SPARE * (width - 2 * INSET_MM - self.hanging) / MM_PER_IN
        return wrapped(self.words, room, SMALL)


def parts_of(view: ConstructionView, far: Iterable[str]) -> list[list[ColumnPart]]:
    """The words on a construction, in groups."""
    proposal = view.examined.proposal
    steps = [ColumnPart(step.words, f"({k})") for k, step in enumerate(view.steps, 1)]
    chosen = [ColumnPart(f"{name}: {value}") for name, value in proposal.chosen.items()]
    doubts = [proposal.doubt] * bool(proposal.doubt) + view.examined.defects
    off = [ColumnPart(words) for words in far]
    groups = [
        steps,
        [_titled("Chosen"), *chosen] if chosen else [],
        [_titled("Doubts"), *map(ColumnPart, doubts)] if doubts else [],
        [_titled("Off the paper"), *off] if off else [],
        _key(view),
    ]
    return [group for group in groups if group]


def _key(view: ConstructionView) -> list[ColumnPart]:
    coloured = {id(curve) for curve in curves_of(view.steps)}  # by the numbers of their steps
    every = [each for step in view.steps for each in step.elements if id(each) not in coloured]
    looks = {each.look for each in every if not isinstance(each, design.Dot)}
    key = [(words, LOOKS[look]) for look, words in KEY.items() if look in looks]
    key.append(("mechanism in position 1", LOOKS["result"]))
    key += [("in the other positions", Stroke(OTHERS, OTHERS_WIDTH))] * bool(view.others)
    return [ColumnPart(words, look, QUIET) for words, look in key]


def _titled(words: str) -> ColumnPart:
    return ColumnPart(words, weight="bold")


def height_of(groups: Sequence[Sequence[ColumnPart]], width: float) -> float:
    """The height of groups in a column of a width [mm]."""
    rows = sum(len(part.lines(width)) for group in groups for part in group)
    parts = sum(len(group) for group in groups)
    return 2 * INSET_MM + ROW_MM * rows + GAP_MM * (0.5 * parts + len(groups))


def write_column(axes: Axes, groups: Sequence[Sequence[ColumnPart]], column: Box) -> None:
    """Write all groups from the top of a column that is high enough."""
    left, y = column.left + INSET_MM, column.top - INSET_MM
    for group in groups:
        for part in group:
            rows = part.lines(column.width)
            _hang(axes, part, left, y - 0.75 * ROW_MM)
            for row in rows:
                y -= ROW_MM
                base = y + 0.25 * ROW_MM
                look = {"color": part.colour, "weight": part.weight}
                text(axes, left + part.hanging, base, row, SMALL, **look)
            y -= 0.5 * GAP_MM
        y -= GAP_MM


def _hang(axes: Axes, part: ColumnPart, left: float, base: float) -> None:
    if isinstance(part.before, Stroke):
        start, end, stroke = (left, base + 0.8), (left + SAMPLE_MM, base + 0.8), part.before
        line(axes, start, end, color=stroke.colour, linewidth=stroke.width)
    elif part.before:
        text(axes, left, base, part.before, SMALL, color=QUIET)


NEAR_MM = 0.5
"""Distance of points [mm] below which their letters share a label."""
NUMBERED, NUMBER_PLACES = 2, 14
"""Number of lines of a step with its number, and of places for it along each."""


def dot_letters(
    steps: Sequence[design.DrawingStep],
    points: Mapping[str, Array],
    at: Callable[[Array], Array],
    box: Box,
) -> list[Letter]:
    """The letters of all dots in the box, and of those of the mechanism's ``points`` [m] without a
    letter: C1 is also the letter of a point C in the first position."""
    low, high = box.corners
    dots = [each for step in steps for each in step.elements if isinstance(each, design.Dot)]
    named = [(dot.letter, at(xy(dot.place)), dot.look) for dot in dots if dot.letter]
    named += [(name, at(place), "result") for name, place in points.items()]
    spots: list[tuple[list[str], Array, str]] = []
    for letter, place, look in named:
        if np.any((place < low) | (place > high)):
            continue
        spot = next((each for each in spots if np.hypot(*(each[1] - place)) < NEAR_MM), None)
        if spot is None:
            spots.append(([letter], place, look))
        elif letter not in spot[0] and f"{letter}1" not in spot[0]:
            spot[0].append(letter)
    return [
        Letter(", ".join(names), place, PIN_MM, color=GIVEN if look == "given" else INK)
        for names, place, look in spots
    ]


def step_numbers(
    steps: Sequence[design.DrawingStep], drawn: Mapping[int, Sequence[Array]]
) -> list[Letter]:
    """The number of each step at its longest lines [mm], links excepted; ``drawn`` are the lines of
    elements, by their identity."""
    letters = []
    for number, step in enumerate(steps, 1):
        every = [each for each in step.elements if not isinstance(each, design.Dot)]
        some = [each for each in every if each.look != "result"]
        longest = sorted(
            ((max(map(_length, lines)), each) for each in some if (lines := drawn[id(each)])),
            key=lambda pair: -pair[0],
        )
        for _, each in longest[:NUMBERED]:
            line = max(drawn[id(each)], key=_length)
            colour = look_of(each, steps).colour if isinstance(each, design.DrawnCurve) else QUIET
            letters.append(Letter(f"({number})", _along(line), 0.1, NUMBER, colour))
    return letters


def _length(line: Array) -> float:
    return float(np.sum(np.hypot(*np.diff(line, axis=0).T)))


def _along(line: Array) -> Array:
    """Places along a line, evenly spaced, off its ends."""
    way = np.append(0.0, np.cumsum(np.hypot(*np.diff(line, axis=0).T)))
    there = np.linspace(0.06, 0.94, NUMBER_PLACES) * way[-1]
    return np.stack([np.interp(there, way, line[:, k]) for k in (0, 1)], axis=1)


PADDING, GAP = 11.0, 3.0
COLUMNS_MM = (54.0, 64.0, 76.0, 90.0, 106.0)
"""Widths of the column of words [mm]; the least that suffices is taken."""
MOST_SHARE = 0.5
"""Largest share of the sheet for words."""
DOT_MM = {"given": 0.7, "auxiliary": 0.6, "result": PIN_MM}
LAYER_WORDS = 40
"""Number of letters of a step's words in the name of its layer."""
FRONT = 6
"""Drawing order of dots, over lines."""


@dataclass(frozen=True)
class ConstructionSheet(ToScale):
    """A construction on paper, and the words of the column beside or below it."""

    view: ConstructionView
    column: Box
    words: list[list[ColumnPart]]
    paper: Paper

    @property
    def cut(self) -> tuple[Array, Array]:
        """The corners of the drawn region [m]."""
        half = self.scale * np.array([self.box.width, self.box.height]) / 2
        return self.middle - half, self.middle + half


def laid_out(proposed: Examined | design.Proposal, paper: Paper) -> ConstructionSheet:
    """The construction of a mechanism on paper, with the words of its steps on the right, or below
    on paper that is higher than wide.

    Raises CrankcheckError for a proposal that can not be assembled in its first position, and for
    paper too small for its words.
    """
    view = ConstructionView.of(proposed)
    inner = inner_box(paper)
    tried = _below(view, inner) if paper.height > paper.width else _beside(view, inner)
    for box, column in tried:
        sheet = _in(view, box, column, paper)
        if height_of(sheet.words, column.width) <= column.height:
            return sheet
    larger = "A3" if paper.width < 420.0 else "A2"
    raise CrankcheckError(
        f"--paper {paper.width:g}x{paper.height:g}: the words of {len(view.steps)} steps do not "
        f"fit beside their figure; take a larger one, such as {larger}"
    )


def _in(view: ConstructionView, box: Box, column: Box, paper: Paper) -> ConstructionSheet:
    scale, middle = box.fitted(view.shown, PADDING)
    half = scale * np.array([box.width, box.height]) / 2
    words = parts_of(view, [words for _, words in view.far(middle - half, middle + half)])
    return ConstructionSheet(box, scale, middle, view, column, words, paper)


def _beside(view: ConstructionView, inner: Box) -> list[tuple[Box, Box]]:
    """Boxes of the figure with columns of several widths on its right."""
    fit = [width for width in COLUMNS_MM if width <= MOST_SHARE * inner.width]
    return [inner.side_by_side(width, GAP) for width in fit]


def _below(view: ConstructionView, inner: Box) -> list[tuple[Box, Box]]:
    """The box of the figure over the box of the words, which is as high as they need."""
    corners = view.shown.min(axis=0), view.shown.max(axis=0)
    tall = height_of(parts_of(view, [words for _, words in view.far(*corners)]), inner.width)
    boxes = []
    for spare in (1.0, 1.25, 1.6):
        high = spare * tall
        if high <= MOST_SHARE * inner.height:
            bottom = inner.bottom + high + GAP
            figure = Box(inner.left, bottom, inner.width, inner.height - high - GAP)
            boxes.append((figure, Box(inner.left, inner.bottom, inner.width, high)))
    return boxes


def construction_sheet(proposed: Examined | design.Proposal, paper: Paper) -> Canvas:
    """The sheet of a construction on paper. Raises CrankcheckError as `laid_out`."""
    sheet = laid_out(proposed, paper)
    return draw_construction(sheet, sheet_note(sheet.view.examined.scene))


def draw_construction(sheet: ConstructionSheet, note: str) -> Canvas:
    """The sheet, in layers: frame and words, other positions, the steps, the mechanism, letters."""
    told = f": construction, position 1 of {len(sheet.view.placements)}, K_l = {sheet.scale:g} m/mm"
    room = (sheet.paper.width - 2 * MARGIN) / MM_PER_IN / 1.15  # bold is so much wider
    name = cut(sheet.view.examined.scene.name, room / 2, LARGE)
    title = cut(name + told, room, LARGE)
    canvas, frame = headed(sheet.paper, title, note, sheet.box, sheet.column)
    write_column(frame, sheet.words, sheet.column)
    others = canvas.layer("positions")
    for placed in sheet.view.others:
        places = {name: sheet.at(place) for name, place in placed.points.items()}
        draw_outline(others, placed.scene.links.values(), places, OTHERS, OTHERS_WIDTH)
    drawn: dict[int, list[Array]] = {}
    for number, step in enumerate(sheet.view.steps, 1):
        name = layer_words(f"step-{number}-{step.words[:LAYER_WORDS]}")
        axes = canvas.layer(name)
        for k, element in enumerate(step.elements, 1):
            drawn[id(element)] = _draw(axes, sheet, element, f"step-{number}.{k}")
    draw_scheme(canvas.layer("mechanism"), sheet.view.first, sheet.at, plate="none")
    letters = dot_letters(sheet.view.steps, sheet.view.first.points, sheet.at, sheet.box)
    letters += step_numbers(sheet.view.steps, drawn)
    write_letters(canvas, canvas.layer("letters"), letters, sheet.box)
    return canvas


def _draw(axes: Axes, sheet: ConstructionSheet, element: design.Element, gid: str) -> list[Array]:
    """Draw an element of a step; return its lines on the sheet [mm]."""
    if isinstance(element, design.Dot):
        _draw_dot(axes, sheet, element, gid)
        return []
    look = look_of(element, sheet.view.steps)
    lines = [sheet.at(part) for part in strokes(element, *sheet.cut)]
    if (
        isinstance(element, design.DrawnCircle)
        and element.arc is None
        and _is_whole(sheet, element)
    ):
        # a drawing program is to have it as a circle
        middle, radius = sheet.at(xy(element.centre)), element.radius / sheet.scale
        axes.add_patch(
            Round(tuple(middle), radius, fill=False, ec=look.colour, lw=look.width, gid=gid)
        )
        return lines
    for part in lines:
        axes.plot(*part.T, color=look.colour, lw=look.width, solid_capstyle="butt", gid=gid)
    return lines


def _is_whole(sheet: ConstructionSheet, circle: design.DrawnCircle) -> bool:
    low, high = sheet.cut
    middle = xy(circle.centre)
    return circle.arc is None and bool(
        np.all((middle - circle.radius > low) & (middle + circle.radius < high))
    )


def _draw_dot(axes: Axes, sheet: ConstructionSheet, dot: design.Dot, gid: str) -> None:
    """Draw a point as a small circle, a pivot of the ground on its foot; nothing off the paper."""
    low, high = sheet.cut
    place = xy(dot.place)
    if np.any((place < low) | (place > high)):
        return
    spot = sheet.at(place)
    if dot.fixed:
        draw_foot(axes, spot)
    colour = GIVEN if dot.look == "given" else INK
    radius = PIN_MM if dot.fixed else DOT_MM[dot.look]
    face = colour if dot.look == "given" and not dot.fixed else "white"
    axes.add_patch(Round(tuple(spot), radius, fc=face, ec=colour, lw=0.7, zorder=FRONT, gid=gid))
