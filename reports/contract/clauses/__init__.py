"""All clauses by subject; a new one is an entry in one of these files."""

from reports.contract.clauses import (
    declared,
    felt,
    freed,
    physics,
    rates,
    reactions,
    sessions,
    start,
)
from reports.contract.subject import Clause

CLAUSES: dict[str, Clause] = {
    clause.id: clause
    for clauses in (
        *(declared.CLAUSES, start.CLAUSES, sessions.CLAUSES, rates.CLAUSES, physics.CLAUSES),
        *(start.REFUSALS, reactions.CLAUSES, felt.CLAUSES, freed.CLAUSES),
    )
    for clause in clauses
}
"""The clauses by their ids."""
