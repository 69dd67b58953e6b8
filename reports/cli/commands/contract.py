"""`crankcheck engines check`: put an engine to the contract of engines, and say what it breaks."""

from __future__ import annotations

from rich.console import Console

from reports.contract.checking import SCENES, put_to_all
from reports.contract.clauses import CLAUSES
from reports.contract.table import show
from reports.workers.isolated import checked_limits
from reports.workers.progress import progress_bar
from sim.registry import engine

MEMORY_GB = 4.0
"""What a clause may take: far more than any session does."""


def run_check(name: str, limit_s: float, jobs: int, console: Console, progress: Console) -> int:
    """Do it; returns the exit code: 0 where every clause that can be tried is held, 1 where one is
    broken or none can be tried. Raises CrankcheckError for an engine that is not there, or none."""
    limits = checked_limits(limit_s, MEMORY_GB)
    adapter = engine(name)
    version = adapter.version()
    with progress_bar(progress, "clauses", len(CLAUSES)) as advance:
        rulings = put_to_all(adapter.name, jobs, limits, lambda _: advance())
    show(console, f"{adapter.name} {version}", rulings, SCENES)
    answers = {ruling.answer for ruling in rulings}
    return int("broken" in answers or "held" not in answers)
