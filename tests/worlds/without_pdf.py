"""Figures whose PDF is drawn by nobody, as that takes as long as all else of a figure."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import BinaryIO

import pytest
from matplotlib.figure import Figure

BEGINS = b"%PDF"


@contextmanager
def without_pdf() -> Iterator[None]:
    """Every PDF of a figure has its first bytes alone; what is in one is tested where figures are
    (tests/reports/figures)."""
    draw = Figure.savefig

    def save(figure: Figure, file: BinaryIO, *arguments: object, **options: object) -> None:
        if options.get("format") == "pdf":
            file.write(BEGINS)
        else:
            draw(figure, file, *arguments, **options)  # type: ignore[arg-type]  # handed on

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Figure, "savefig", save)
        yield
