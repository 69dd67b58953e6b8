"""CC134: whether the engine, the segments or the truth is what an elastic link is off by."""

from __future__ import annotations

from reports.compare.elastic.elastic_facts import ElasticFacts
from reports.compare.errors import Errors
from reports.judge.rules.rule import Evidence, Finding, Level

UNSURE = 0.05
"""A doubt of the beam, of the largest deflection, that is told as advice: next to a resonance."""


class TruthEnds:
    id = "CC134"
    title = "where the truth ends"
    explanation = (
        "What the deflection is off by is of three parts: the engine beside the exact chain of "
        "segments, that chain beside the beam, and what the beam itself may be off by. Where one "
        "of the last two is the largest, no engine and no step tells more."
    )
    cure = (
        "More segments (--segments), or --springs corrected; a shorter step does not help. Where "
        "the beam itself is in doubt, keep away from whole numbers of its frequency over the "
        "speed, or give it damping_s."
    )

    def check(self, evidence: Evidence) -> Finding | None:
        errors = evidence.errors
        links = ElasticFacts.of(errors)
        if errors is None or links is None or evidence.status != "ok":
            return None
        own = engine_share(errors, links)
        parts = (
            f"of the largest deflection the engine leaves {own:.1e}, {links.pieces} "
            f"{links.chain:.1e}{' (estimated)' if links.estimated else ''}, the beam's own "
            f"doubt is {links.doubt:.1e}, and the linear theory is off by {links.linear:.1e}"
        )
        if own > max(links.chain, links.doubt):
            return Finding(self.id, "pass", f"the engine is what is off: {parts}", own)
        ends = f"the {links.pieces.split()[1]} end"
        ends = ends if links.chain > links.doubt else "the truth ends"
        level: Level = "advice" if links.doubt > UNSURE else "pass"
        return Finding(self.id, level, f"{ends} before the engine does: {parts}", own)


def engine_share(errors: Errors, links: ElasticFacts) -> float:
    """What the engine itself is off by, of the largest deflection: beside the exact chain, or what
    is left of its error beside the beam."""
    exact, beam = errors.worst("segments"), errors.worst("deflection")
    if exact is not None:
        return exact.pure
    return max((beam.pure if beam else 0.0) - links.chain, 0.0)
