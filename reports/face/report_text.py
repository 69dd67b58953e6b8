"""The text of a report: the page of a store, or its Markdown."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from models.errors import CrankcheckError
from reports.output.console import tell
from reports.stability.matrix import FILE as MATRIX
from reports.stability.matrix import Matrix, read_matrix
from reports.store.reader import read_store
from reports.store.schema import TABLES

Format = Literal["html", "md"]
ENDINGS: Mapping[Format, tuple[str, ...]] = {
    "html": (".html", ".htm"),
    "md": (".md", ".markdown", ".txt"),
}


@dataclass(frozen=True)
class Made:
    """A report, and what it is of, in words."""

    text: str
    content: str


def report_of(folder: Path, format: Format) -> Made:
    """The report of the store in ``folder``, or of the hard cases alone.

    What is damaged in the store is told, and the rest is reported. Raises CrankcheckError for no
    store there, or none of which a cell can be read.
    """
    try:
        swept = any((folder / table).exists() for table in TABLES)
        hard = (folder / MATRIX).is_file()
    except OSError as error:  # a name too long for the system
        raise CrankcheckError(
            f"{folder}: can not be read: {error.strerror or error}; name the folder of a sweep"
        ) from None
    if hard and not swept:
        if format == "md":
            raise CrankcheckError(
                f"{folder}: hard cases alone, which have a page and no Markdown; leave out --format"
            )
        from reports.page.build import stability_page

        matrix = read_matrix(folder)
        return Made(stability_page(matrix), f"{len(matrix.runs)} runs of hard cases")
    stored = read_store(folder)
    tell(stored.notice)
    content = f"{len(stored.cells)} cells"
    if format == "md":
        from reports.page.comment import summary

        return Made(summary(stored), content)
    from reports.page.build import page

    return Made(page(stored, _beside(folder) if hard else None), content)


def _beside(folder: Path) -> Matrix | None:
    """The hard cases that were run into the folder of a sweep; told, where they are damaged."""
    try:
        return read_matrix(folder)
    except CrankcheckError as error:
        tell([str(error)])
        return None
