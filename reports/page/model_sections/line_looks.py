"""How the lines of a model look in all diagrams of its page."""

from __future__ import annotations

from collections.abc import Mapping

from reports.own_model.judged import JudgedModel
from reports.results.looks import DASHES, Look

COLOURS = (4, 6, 2)
"""As written, contacts off, recommended: colours of the style sheet."""
SYMBOLS = ("circle", "square", "diamond")
SIZES = (11.0, 9.0, 7.0)


def line_looks(judged: JudgedModel) -> Mapping[str, Look]:
    """A look for each of the three lines that are told, by the name of the line."""
    return {
        one.cell.profile: Look(
            number=number,
            engine="",
            variant=one.cell.profile,
            version=one.version,
            colour=COLOURS[number],
            symbol=SYMBOLS[number],
            dash=DASHES[number],
            size=SIZES[number],
        )
        for number, one in enumerate(judged.three)
    }
