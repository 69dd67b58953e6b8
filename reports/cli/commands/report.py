"""`crankcheck report`: a store as one page for people, or as text."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from rich.console import Console

from models.errors import CrankcheckError
from reports.output.console import tell
from reports.output.write import check_file, write
from reports.stability.matrix import FILE as MATRIX
from reports.stability.matrix import Matrix, read_matrix
from reports.store.reader import read_store
from reports.store.schema import TABLES

Format = Literal["html", "md"]
ENDINGS: dict[Format, tuple[str, ...]] = {
    "html": (".html", ".htm"),
    "md": (".md", ".markdown", ".txt"),
}


def format_of(text: str) -> Format:
    """A format by its name. Raises CrankcheckError for one that there is not."""
    for name in ENDINGS:
        if text.lower() == name:
            return name
    raise CrankcheckError(f"--format {text!r}: unknown; use {' or '.join(ENDINGS)}")


def run_report(folder: Path, output: Path | None, format: Format, console: Console) -> int:
    """Write the report of the store in ``folder``, or of the hard cases alone; returns the exit
    code, 0.

    Without ``output`` a page goes to ``report.html`` in the working folder, and text to the
    terminal. What is damaged in the store is told, and the rest is reported.

    Raises
    ------
    CrankcheckError
        No store there, none of which a cell can be read, or a file that can not be written.
    """
    if output is None and format == "html":
        output = Path("report.html")
    if output is not None:
        check_file(output, "-o", ENDINGS[format])
    swept = any((folder / table).exists() for table in TABLES)
    if (folder / MATRIX).is_file() and not swept:
        if format == "md":
            raise CrankcheckError(
                f"{folder}: hard cases alone, which have a page and no Markdown; leave out --format"
            )
        from reports.page.build import stability_page

        matrix = read_matrix(folder)
        text, content = stability_page(matrix), f"{len(matrix.runs)} runs of hard cases"
    else:
        stored = read_store(folder)
        tell(stored.notice)
        content = f"{len(stored.cells)} cells"
        if format == "md":
            from reports.page.comment import summary

            text = summary(stored)
        else:
            from reports.page.build import page

            text = page(stored, _beside(folder))
    if output is None:
        console.file.write(text)
        return 0
    write(output, text)
    size = len(text.encode()) / 1e6
    console.print(f"{output}: {content}, {size:.1f} MB", markup=False, highlight=False)
    return 0


def _beside(folder: Path) -> Matrix | None:
    """The hard cases that were run into the folder of a sweep; told, where they are damaged."""
    if not (folder / MATRIX).is_file():
        return None
    try:
        return read_matrix(folder)
    except CrankcheckError as error:
        tell([str(error)])
        return None
