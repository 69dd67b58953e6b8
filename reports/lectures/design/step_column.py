"""The column of words beside a construction: steps, looks, elements off the paper."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from matplotlib.axes import Axes

from analytic.lectures.synthesis.design import Dot, Look
from reports.figures.style import INK, QUIET, SMALL, wrapped
from reports.lectures.design.construction_view import (
    LOOKS,
    OTHERS,
    OTHERS_WIDTH,
    ConstructionView,
    Stroke,
    curves_of,
)
from reports.lectures.drawing.sheets.paper import MM_PER_IN, Box, line, text

ROW_MM, GAP_MM = 3.1, 1.3
"""Height of a line of the column, and gap between its parts."""
INSET_MM, HANGING_MM, SAMPLE_MM = 2.0, 5.5, 7.0
"""Margins at both sides of the column, before the words of a step, and for a line's sample."""
SPARE = 0.95
"""Usable share of the width: a viewer of the file may have wider type."""
KEY: dict[Look, str] = {"given": "given", "auxiliary": "construction"}


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
    looks = {each.look for each in every if not isinstance(each, Dot)}
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
