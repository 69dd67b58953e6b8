"""`report`: the page of a sweep, or its Markdown."""

from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Annotated, Literal

from rich.console import Console

from models.errors import CrankcheckError
from reports.output.console import put, tell
from reports.output.write import check_file, write
from reports.requests.arguments import path_of, told_at_the_call
from reports.requests.options import argument, option, output_option
from reports.requests.sweep import Sweep
from reports.stability.matrix import FILE as MATRIX
from reports.stability.matrix import Matrix, read_matrix
from reports.store.manifest import TABLES

Format = Literal["html", "md"]
ENDINGS: Mapping[Format, tuple[str, ...]] = {
    "html": (".html", ".htm"),
    "md": (".md", ".markdown", ".txt"),
}


@dataclass(frozen=True)
class Made:
    """A report, with a description of its content."""

    text: str
    content: str


def report_of(folder: Path, format: Format) -> Made:
    """The report of the store in ``folder``, or of the hard cases alone.

    Damage to the store is reported beside its sound cells. Raises CrankcheckError for no store
    there, or a store without a readable cell.
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
                f"{folder}: hard cases have a page, and no Markdown; leave out --format"
            )
        from reports.page.build import stability_page

        matrix = read_matrix(folder)
        return Made(stability_page(matrix), f"{len(matrix.runs)} runs of hard cases")
    from reports.store.reader import read_store  # pandas, which takes a third of a second

    stored = read_store(folder)
    tell(stored.notice)
    content = f"{len(stored.cells)} cells"
    beside = _beside(folder) if hard else None
    if format == "md":
        from reports.page.comment import summary

        return Made(summary(stored, beside), content)
    from reports.page.build import page

    return Made(page(stored, beside), content)


def _beside(folder: Path) -> Matrix | None:
    """The hard cases in the folder of a sweep; None, with a message, where they are damaged."""
    try:
        return read_matrix(folder)
    except CrankcheckError as error:
        tell([str(error)])
        return None


def format_of(text: str) -> Format:
    """A format by its name. Raises CrankcheckError for an unknown name."""
    for name in ENDINGS:
        if text.lower() == name:
            return name
    raise CrankcheckError(f"--format {text!r}: unknown; use {' or '.join(ENDINGS)}")


@dataclass(frozen=True)
class ReportRequest:
    folder: Annotated[Path, argument("DIR", "Folder of a sweep, or of hard cases.")]
    output: Annotated[
        Path | None, output_option("File to write (default report.html; md: none).")
    ] = None
    format: Annotated[str, option("A page, or text in Markdown.", "html|md")] = "html"

    def run(self, console: Console, progress: Console) -> int:
        """Write the report of the store in ``folder``, or of the hard cases alone; return 0.

        Without ``output`` a page goes to ``report.html`` in the working folder, and text to the
        terminal. Damage to the store is reported beside its sound cells.

        Raises CrankcheckError for no store there, a store without a readable cell, or a file that
        can not be written.
        """
        output, format = self.output, format_of(self.format)
        if output is None and format == "html":
            output = Path("report.html")
        check_file(output, "-o", ENDINGS[format])
        made = report_of(self.folder, format)
        size = len(made.text.encode()) / 1e6
        put(console, output, made.text, f"{made.content}, {size:.1f} MB")
        return 0


@told_at_the_call
def report(
    folder: str | PathLike[str] | Sweep, output: str | PathLike[str] = "report.html"
) -> Path:
    """Write a sweep as a page that works offline (.html), or as Markdown (.md).

    Parameters
    ----------
    folder : str, path or Sweep
        The folder of a sweep or of hard cases, or a result of `sweep`.
    output : str or path
        The file, whose ending chooses the format.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    CrankcheckError
        No store there, or a file that can not be written.
    """
    where = folder.folder if isinstance(folder, Sweep) else path_of(folder, "folder")
    path = path_of(output, "-o")
    check_file(path, "-o", tuple(ending for endings in ENDINGS.values() for ending in endings))
    is_page = path.suffix.lower() in ENDINGS["html"]
    write(path, report_of(where, "html" if is_page else "md").text)
    return path
