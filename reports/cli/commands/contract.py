"""`crankcheck engines check`: put an engine to the contract of engines, and say what it breaks."""

from __future__ import annotations

from rich.console import Console

from models.errors import CrankcheckError, suggestion
from reports.cli.showing import EngineCheckRequest
from reports.contract.clauses import CLAUSES
from reports.contract.ruling import SCENES, put_to_all
from reports.contract.table import show
from reports.workers.isolated import checked_limits
from reports.workers.progress import progress_bar
from sim.registry import engine

MEMORY_GB = 4.0
"""What a clause may take: far more than any session does."""


def run_check(request: EngineCheckRequest, console: Console, progress: Console) -> int:
    """Do it; returns the exit code: 0 where every clause that can be tried is held, 1 where one is
    broken or none can be tried. Raises CrankcheckError for an engine that is not there, or none,
    and for an unknown clause."""
    limits = checked_limits(request.limit_s, MEMORY_GB)
    for clause in request.clauses:
        if clause not in CLAUSES:
            hint = suggestion(clause, CLAUSES, "use")
            raise CrankcheckError(f"--clause {clause!r}: there is none of that name; {hint}")
    clauses = list(dict.fromkeys(request.clauses or CLAUSES))
    adapter = engine(request.name)
    version = adapter.version()
    with progress_bar(progress, "clauses", len(clauses)) as advance:
        rulings = put_to_all(adapter.name, clauses, request.jobs, limits, lambda _: advance())
    show(console, f"{adapter.name} {version}", rulings, SCENES)
    answers = {ruling.answer for ruling in rulings}
    return int("broken" in answers or "held" not in answers)
