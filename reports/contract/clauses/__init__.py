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

MODULES = (declared, start, sessions, rates, physics, reactions, felt, freed)
_ALL = [one for module in MODULES for one in vars(module).values() if isinstance(one, Clause)]
CLAUSES = {one.id: one for one in sorted(_ALL, key=lambda one: one.id)}
"""The clauses by their ids."""
