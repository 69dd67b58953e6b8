"""Cells that a damaged run may have had: a comparison must not end well because they are lost."""

from __future__ import annotations

from models.errors import CrankcheckError
from reports.output.numbers import count
from reports.results.changes.runs import StoredRun
from reports.store.damage import BUSY


def refuse_gone(old: StoredRun, new: StoredRun) -> None:
    """Refuse to compare where a lost cell may be one that the other run has.

    What is damaged in a run is of no account where it has every cell that the other one has: what
    is lost then was not asked for. Otherwise there is no telling whether a cell was never there or
    is lost, and whether it would be worse; nor where both have lost some, which may be the same.

    Raises
    ------
    CrankcheckError
        Says which cells are missing, and what is damaged.
    """
    for run, other in ((old, new), (new, old)):
        if not run.gone:
            continue
        missing = [name for name in other.cells if name not in run.cells]
        if missing:
            which = f"{count(len(missing), 'cell')} of {other.label}, such as {missing[0].label},"
        elif run.lost and other.lost:
            which = f"cells that {other.label} has lost too"
        else:
            continue
        busy = any(BUSY in each for each in run.gone)
        raise CrankcheckError(
            f"{run.label}: {which} may be among what is missing there "
            f"({'; '.join(run.gone)}); {'let its sweep end' if busy else 'mend it'} first, or "
            "compare with a whole run"
        )
