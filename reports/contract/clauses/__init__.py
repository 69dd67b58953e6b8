"""All clauses, by what they are about; a new one is an entry in one of these files."""

from __future__ import annotations

from reports.contract.clause import Clause
from reports.contract.clauses import (
    declared,
    elsewhere,
    felt,
    freed,
    physics,
    rates,
    reactions,
    refusals,
    sessions,
    start,
)

CLAUSES: dict[str, Clause] = {
    clause.id: clause
    for room in (
        declared,
        start,
        sessions,
        rates,
        physics,
        elsewhere,
        refusals,
        reactions,
        felt,
        freed,
    )
    for clause in room.CLAUSES
}
"""The clauses by their ids."""
