"""What stands under the tables of elastic links: their units, what engines were given, and where
the truth ends."""

from __future__ import annotations

from collections.abc import Sequence

from reports.compare.elastic.elastic_facts import BENT
from reports.judge.cell import Checked
from reports.judge.rules.reference import TruthEnds
from reports.verify.cell_table import LINK_UNITS
from reports.ways.driven.footer import STEPPED

CHAINS = "engine: against the exact chain of as many segments instead; chain: that against the beam"
BEAMS = (
    "a beam of the engine's own has no exact chain, and under chain stands what its elements lock "
    "by, estimated"
)
THEORIES = (
    "doubt: what the beam may be off by; linear: what the linear theory is, which is judged by "
    "nothing."
)


def words(bent: Sequence[Checked]) -> Sequence[str]:
    """What the numbers are."""
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
    return [f"{'; '.join([*parts, THEORIES])} Given as {'; '.join(given)}.", *ends]


BENT_WORDS = (LINK_UNITS, words)
FOOTER = (BENT_WORDS, STEPPED)
