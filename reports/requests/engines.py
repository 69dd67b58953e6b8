"""`crankcheck engines` and `engines check`: the engines, and one put to the contract of engines."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

from rich.console import Console
from rich.table import Table
from rich.text import Text

from models.errors import CrankcheckError, suggestion
from reports.requests.options import Jobs, argument, option
from reports.workers.isolated import checked_limits
from reports.workers.progress import progress_bar
from sim.registry import available, brought, engine


@dataclass(frozen=True)
class EnginesRequest:
    settings: bool = False

    def run(self, console: Console, progress: Console) -> int:
        """List engines: version, or the command to install; profiles, also with settings."""
        for entry in (*available(), *brought()):
            state = entry.version or entry.broken or f"not installed: {entry.install}"
            console.print(Text(f"{entry.name}  {state}", "bold" if entry.version else "yellow"))
            if entry.version is None:
                continue
            for profile in engine(entry.name).profiles.values():
                grid = Table.grid(padding=(0, 2, 0, 0))
                grid.add_column(no_wrap=True, min_width=12)
                grid.add_column(overflow="fold")
                grid.add_row(f"  {profile.name}", Text(profile.summary))
                if self.settings:
                    for name, setting in profile.settings.items():
                        grid.add_row("", Text(f"{name} = {setting.value}: {setting.reason}", "dim"))
                console.print(grid)
        return 0


MEMORY_GB = 4.0
"""Memory limit of a clause: far more than any session needs."""


@dataclass(frozen=True)
class EngineCheckRequest:
    name: Annotated[
        str, argument("ENGINE", "A name; of an engine of your own: package.module:ENGINE.")
    ]
    clauses: Annotated[
        Sequence[str], option("Clause; may be repeated; default: all.", "--clause ID")
    ] = ()
    limit_s: Annotated[float, "Longest time for a clause, in seconds."] = 60.0
    jobs: Jobs = 0

    def run(self, console: Console, progress: Console) -> int:
        """Answer, and return the exit code: 0 where every clause that can be tried is held, 1 where
        one is broken, 2 where none can be tried. Raises CrankcheckError for an engine that does not
        exist or is no engine, and for an unknown clause."""
        from reports.contract.clauses import CLAUSES  # with the solvers: not for a list of engines
        from reports.contract.ruling import SCENES, named, put_to_all, refuses_all, show

        limits = checked_limits(self.limit_s, MEMORY_GB)
        for clause in self.clauses:
            if clause not in CLAUSES:
                hint = suggestion(clause, CLAUSES, "use")
                raise CrankcheckError(f"--clause {clause!r}: unknown; {hint}")
        clauses = list(dict.fromkeys(self.clauses or CLAUSES))
        called, version = named(self.name, limits)
        with progress_bar(progress, "clauses", len(clauses)) as advance:
            rulings = put_to_all(self.name, clauses, self.jobs, limits, lambda _: advance())
        show(console, f"{called} {version}", rulings, SCENES)
        if any(ruling.answer == "broken" for ruling in rulings):
            return 1
        return 2 if refuses_all(rulings) else 0
