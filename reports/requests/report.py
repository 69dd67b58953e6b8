"""`crankcheck report`: a store as one page for people, or as text."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from models.errors import CrankcheckError
from reports.face.report_text import ENDINGS, Format, report_of
from reports.output.write import check_file, write


def format_of(text: str) -> Format:
    """A format by its name. Raises CrankcheckError for one that there is not."""
    for name in ENDINGS:
        if text.lower() == name:
            return name
    raise CrankcheckError(f"--format {text!r}: unknown; use {' or '.join(ENDINGS)}")


@dataclass(frozen=True)
class ReportRequest:
    """What `report` was asked for, as given."""

    folder: Annotated[
        Path, typer.Argument(metavar="DIR", help="Folder of a sweep, or of hard cases.")
    ]
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", help="File to write (default report.html; md: none)."),
    ] = None
    format: Annotated[
        str, typer.Option("--format", metavar="html|md", help="A page, or text in Markdown.")
    ] = "html"

    def run(self, console: Console, progress: Console) -> int:
        """Write the report of the store in ``folder``, or of the hard cases alone; returns the exit
        code, 0.

        Without ``output`` a page goes to ``report.html`` in the working folder, and text to the
        terminal. What is damaged in the store is told, and the rest is reported.

        Raises
        ------
        CrankcheckError
            No store there, none of which a cell can be read, or a file that can not be written.
        """
        output, format = self.output, format_of(self.format)
        if output is None and format == "html":
            output = Path("report.html")
        if output is not None:
            check_file(output, "-o", ENDINGS[format])
        made = report_of(self.folder, format)
        if output is None:
            console.file.write(made.text)
            return 0
        write(output, made.text)
        size = len(made.text.encode()) / 1e6
        console.print(f"{output}: {made.content}, {size:.1f} MB", markup=False, highlight=False)
        return 0
