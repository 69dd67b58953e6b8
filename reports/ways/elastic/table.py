"""The table of elastic links, with the sources of their errors; and its footer."""

from collections.abc import Sequence

from reports.compare.errors import BENT, ElasticFacts
from reports.judge.cell import Checked
from reports.judge.rules.reference import TruthEnds
from reports.quantities import QUANTITIES
from reports.verify.table import LINK_UNITS, CellTable
from reports.ways.driven.table import STEPPED

ELASTIC_NUMBERS = {
    QUANTITIES["segments"].head: ["segments"],
    QUANTITIES["deflection"].head: ["deflection"],
    QUANTITIES["angle"].head: ["angle", "phase"],
    QUANTITIES["gap"].head: ["gap"],
}
"""Shown errors of an engine: against the exact chain, against the beam, and of places; in free
motion of the driver's angle as well."""
THEORIES = ("chain\n/ D", "doubt\n/ D", "linear\n/ D")


def _theories(one: Checked) -> tuple[str, ...]:
    """Error of the segments against the beam, doubt of the beam, and error of the linear theory."""
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
CHAINS = "engine: against the exact chain of as many segments instead; chain: that against the beam"
BEAMS = (
    "a beam of the engine's own has no exact chain: its column shows the estimated locking of its "
    "elements"
)
THEORY_WORDS = "doubt: uncertainty of the beam; linear: error of the linear theory, not judged."


def words(bent: Sequence[Checked]) -> Sequence[str]:
    """The meaning of the numbers."""
    is_beam = {one.cell.springs == "beam" for one in bent}
    parts = [f"{BENT}, of deflections over the largest, D, of places over the longest link, L"]
    parts += [CHAINS] * (False in is_beam) + [BEAMS] * (True in is_beam)
    parts += dict.fromkeys(text for one in bent for text in one.cell.way.over_g)
    given = dict.fromkeys(
        f"{one.cell.segments} elements of a beam"
        if one.cell.springs == "beam"
        else f"{one.cell.segments} segments, {one.cell.springs} springs"
        for one in bent
    )
    ends = dict.fromkeys(
        f"{one.cell.scene.name}, {one.cell.engine}: {found.text}."
        for one in bent
        if one.cell.gated
        for found in one.findings
        if found.rule == TruthEnds.id
    )
    return [f"{'; '.join([*parts, THEORY_WORDS])} Given as {'; '.join(given)}.", *ends]


BENT_WORDS = (LINK_UNITS, words)
FOOTER = (BENT_WORDS, STEPPED)
