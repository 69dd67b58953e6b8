"""`crankcheck diff`: two stored runs, and the change of every cell."""

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated

from rich.console import Console

from reports.diff.document import markdown, show_diff, suite
from reports.output.console import tell
from reports.output.formats import junit
from reports.output.printed import present
from reports.output.write import Outputs
from reports.requests.options import TextFormat, argument, output_option
from reports.results.changes import compare
from reports.results.stored_runs import CELLS, FACTS, read_run
from reports.store.folder import paths_of
from reports.store.manifest import MANIFEST, TABLES


def stored_files(*folders: Path | None) -> list[Path]:
    """The files read from folders of sweeps and verifications; some of them may not exist."""
    return [
        path
        for folder in filter(None, folders)
        for path in (
            *(folder / name for name in (MANIFEST, CELLS, FACTS)),
            *(part for table in TABLES for part in paths_of(folder, table)),
        )
    ]


@dataclass(frozen=True)
class DiffRequest:
    """Arguments of `diff`, as given.

    ``old`` and ``new`` are folders of `sweep -o` or of `verify -o`, in any combination: a profile
    is the variant of its name. ``format`` is that of the printed text; ``output`` is Markdown in
    any case.
    """

    old: Annotated[Path, argument("OLD", "Folder written by sweep -o or verify -o.")]
    new: Annotated[Path, argument("NEW", "Folder to compare with it.")]
    factor: Annotated[float, "Largest growth of an error that passes, as a factor."] = 1.1
    strict: Annotated[bool, "Exit 1 for missing cells and changed scenes too."] = False
    old_version: Annotated[str | None, "Engine version in OLD, if it holds several."] = None
    new_version: Annotated[str | None, "Engine version in NEW, if it holds several."] = None
    format: TextFormat = "text"
    output: Annotated[Path | None, output_option("Write Markdown, for a pull request.")] = None
    junit: Annotated[Path | None, "Write JUnit XML, one case per cell."] = None

    def run(self, console: Console, progress: Console) -> int:
        """Answer, and return the exit code.

        0: nothing is worse. 1: some error grew past the factor, or a cell that ended well does not
        any more; with ``strict`` also where a cell of the old run is missing, or its scene changed.
        Without it these are reported and are no fault: a run that failed is a row with its status,
        so a cell is missing only where it was not requested. Step times are shown and never count.

        Raises CrankcheckError for a folder that holds no run, two runs with nothing in common, an
        option that makes no sense; a damaged run that may have lost a cell of the other.
        """
        read = stored_files(self.old, self.new)
        outputs = Outputs({"-o": self.output, "--junit": self.junit})
        outputs.check(read)
        old = read_run(self.old, self.old_version, "--old-version")
        new = read_run(self.new, self.new_version, "--new-version")
        for run in (old, new) if self.old != self.new else (old,):
            tell(run.notice)
        diff = compare(old, new, self.factor)
        page = partial(markdown, diff, self.strict)
        with outputs.written({"-o": page, "--junit": lambda: junit(suite(diff, self.strict))}):
            format = "text" if self.output else self.format
            present(console, format, "", lambda to: show_diff(to, diff, self.strict), page=page)
        return diff.code(self.strict)
