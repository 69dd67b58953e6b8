"""`report`: the page of a sweep, or its Markdown."""

from __future__ import annotations

from os import PathLike
from pathlib import Path

from reports.face.arguments import path_of
from reports.face.sweep import Sweep
from reports.face.told import told_at_the_call


@told_at_the_call
def report(
    folder: str | PathLike[str] | Sweep, output: str | PathLike[str] = "report.html"
) -> Path:
    """Write a sweep as a page that works offline (.html), or as Markdown (.md).

    Parameters
    ----------
    folder : str, path or Sweep
        The folder of a sweep, or of hard cases, or what `sweep` gave.
    output : str or path
        The file, whose ending says which of the two.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    CrankcheckError
        No store there, or a file that can not be written.
    """
    from reports.face.report_text import ENDINGS, report_of
    from reports.output.write import check_file, write

    where = folder.folder if isinstance(folder, Sweep) else path_of(folder, "folder")
    path = path_of(output, "-o")
    check_file(path, "-o", tuple(ending for endings in ENDINGS.values() for ending in endings))
    is_page = path.suffix.lower() in ENDINGS["html"]
    write(path, report_of(where, "html" if is_page else "md").text)
    return path
