"""The table of elastic links: what they are off by, and whose that is."""

from __future__ import annotations

from reports.compare.elastic.elastic_facts import ElasticFacts
from reports.judge.cell import Checked
from reports.quantities import QUANTITIES
from reports.verify.cell_table import CellTable

ELASTIC_NUMBERS = {
    QUANTITIES["segments"].head: ["segments"],
    QUANTITIES["deflection"].head: ["deflection"],
    QUANTITIES["angle"].head: ["angle", "phase"],
    QUANTITIES["gap"].head: ["gap"],
}
"""What of an engine's errors is shown: beside the exact chain, beside the beam, and of places; of
what is let go the driver's angle as well."""
THEORIES = ("chain\n/ D", "doubt\n/ D", "linear\n/ D")


def _theories(one: Checked) -> tuple[str, ...]:
    """What the segments leave of the beam, what the beam may be off by, and what the linear theory
    is off it by."""
    facts = ElasticFacts.of(one.errors)
    if facts is None:
        return ("-", "-", "-")
    about = "~" * facts.estimated
    return (f"{about}{facts.chain:.1e}", f"{facts.doubt:.1e}", f"{facts.linear:.1e}")


HEADS = tuple(ELASTIC_NUMBERS)
TABLE = CellTable(
    "elastic links, ",
    ELASTIC_NUMBERS,
    ((98, HEADS, THEORIES), (76, HEADS[:2], THEORIES[:1]), (0, HEADS[:1], THEORIES[:1])),
    before=_theories,
)
