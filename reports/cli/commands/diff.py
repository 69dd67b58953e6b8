"""`crankcheck diff`: two stored runs, and what became of every cell."""

from __future__ import annotations

from rich.console import Console

from models.errors import CrankcheckError
from reports.cli.changes import DiffRequest
from reports.cli.commands.stored_files import stored_files
from reports.diff.junit import suite
from reports.diff.markdown import markdown
from reports.diff.terminal import show
from reports.output.console import tell
from reports.output.junit import junit
from reports.output.write import check_outputs, write
from reports.results.changes.changes import compare
from reports.results.changes.reading import read_run

FORMATS = ("text", "md")


def run_diff(request: DiffRequest, console: Console) -> int:
    """Do it; returns the exit code.

    0: nothing is worse. 1: some error grew past the factor, or a cell that ended well does not
    any more; with ``strict`` also where a cell of the old run is missing, or its scene changed.
    Without it those are told and are no fault: a run that failed is a row with its status, so a
    cell is missing only where it was not asked for. Times of steps are shown and never count.

    Raises
    ------
    CrankcheckError
        A folder that holds no run, two runs with nothing in common, an option that makes no sense;
        a damaged run that may have lost a cell which the other one has.
    """
    if request.format not in FORMATS:
        raise CrankcheckError(f"--format {request.format!r}: unknown; use {' or '.join(FORMATS)}")
    read = stored_files(request.old, request.new)
    check_outputs({"-o": request.output, "--junit": request.junit}, inputs=read)
    old = read_run(request.old, request.old_version, "--old-version")
    new = read_run(request.new, request.new_version, "--new-version")
    for run in (old, new) if request.old != request.new else (old,):
        tell(run.notice)
    diff = compare(old, new, request.factor)
    page = markdown(diff, request.strict)
    try:
        if request.output:
            write(request.output, page)
        if request.junit:
            write(request.junit, junit(suite(diff, request.strict)))
    finally:  # a full disk costs the file, and not the verdict with it
        if request.format == "md" and not request.output:
            console.print(page, end="", markup=False, highlight=False, soft_wrap=True)
        else:
            show(console, diff, request.strict)
    return diff.code(request.strict)
