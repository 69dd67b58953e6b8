"""The sheet of chains: each as a scheme in a field of its own, its name below."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from analytic.lectures.chains.chain import Chain
from analytic.lectures.chains.layout import joints_at
from models.errors import CrankcheckError
from reports.figures.style import QUIET, TINY, cut, width_in
from reports.lectures.drawing.sheets.canvas import Canvas, text
from reports.lectures.drawing.sheets.chain_scheme import draw_chain
from reports.lectures.drawing.sheets.paper import MM_PER_IN, SIZES, Box, Paper
from reports.lectures.drawing.sheets.sheet_frame import inner_box, write_head

LEAST_MM = (24.0, 24.0)
"""A field that can be read."""
WORDS_MM, LINE_MM, PAD_MM = 8.5, 2.7, 3.5
"""Height of the words below a scheme, of a line of them, and what is left blank around it."""
BAR_MM = 22.0
"""The longest that a bar of common length is drawn."""
NAME = 6.5
ASPECT = 1.25
"""Width over height of a field, about."""


@dataclass(frozen=True)
class DrawnChain:
    """A chain to draw: its name, a second line of words, and its ground if it has one."""

    chain: Chain
    name: str
    words: str
    ground: int | None = None


def check_room(many: int, paper: Paper) -> None:
    """Raise CrankcheckError for paper on which so many fields can not be read."""
    field = _fields(many, paper)[0]
    if field.width >= LEAST_MM[0] and field.height >= LEAST_MM[1]:
        return
    fit = [name for name, size in SIZES.items() if _is_enough(many, Paper(*size))]
    cure = f"--paper {fit[0]} would do" if fit else "ask for fewer, or give a larger WIDTHxHEIGHT"
    raise CrankcheckError(
        f"{many} schemes do not fit on {paper.width:g} x {paper.height:g} mm: a field would be "
        f"{field.width:.0f} x {field.height:.0f} mm, and one that can be read is "
        f"{LEAST_MM[0]:g} x {LEAST_MM[1]:g} mm; {cure}"
    )


def _is_enough(many: int, paper: Paper) -> bool:
    field = _fields(many, paper)[0]
    return field.width >= LEAST_MM[0] and field.height >= LEAST_MM[1]


def _fields(many: int, paper: Paper) -> list[Box]:
    """A field for each, row by row from the top."""
    inner = inner_box(paper)
    columns = max(1, math.ceil(math.sqrt(many * inner.width / (inner.height * ASPECT))))
    columns = min(columns, many)
    rows = math.ceil(many / columns)
    wide, tall = inner.width / columns, inner.height / rows
    top = inner.bottom + inner.height
    return [
        Box(inner.left + (k % columns) * wide, top - (k // columns + 1) * tall, wide, tall)
        for k in range(many)
    ]


def draw_chains(chains: Sequence[DrawnChain], title: str, note: str, paper: Paper) -> Canvas:
    """The sheet, in layers; all chains with bars of one length."""
    check_room(len(chains), paper)
    canvas = Canvas(paper)
    write_head(canvas.layer("frame"), paper, title, note)
    schemes, letters = canvas.layer("chains"), canvas.layer("letters")
    fields = _fields(len(chains), paper)
    places = [joints_at(one.chain) for one in chains]
    room = np.array([fields[0].width, fields[0].height - WORDS_MM]) - 2 * PAD_MM
    sizes = [np.ptp(np.array(list(at.values())), axis=0) for at in places]
    bar = min(BAR_MM, *(float(np.min(room / np.maximum(size, 0.3))) for size in sizes))
    for one, field, at in zip(chains, fields, places, strict=True):
        middle = np.array(
            [field.middle[0], field.bottom + WORDS_MM + (field.height - WORDS_MM) / 2]
        )
        draw_chain(
            schemes, one.chain, {joint: middle + bar * way for joint, way in at.items()}, one.ground
        )
        low = field.bottom + WORDS_MM - LINE_MM
        for words, size, color, y in (
            (one.name, NAME, "black", low),
            (one.words, TINY, QUIET, low - LINE_MM),
        ):
            short = cut(words, (field.width - 2.0) / MM_PER_IN, size)
            left = field.middle[0] - MM_PER_IN * width_in(short, size) / 2
            text(letters, left, y, short, size, color=color)
    return canvas
