"""What largest errors are held to, in words: it stands under every table of them."""

from __future__ import annotations

from reports.compare.elastic.elastic_facts import ElasticFacts

LET_GO = (
    "Let go: largest errors at the same time over the sensitivity, by how much a small change of "
    "the start has grown; geometry at the logged angle of the driver; L longest link, w driver's "
    "peak speed."
)
BENT = (
    "Elastic links: largest errors against the solved motion of the beam with foreshortening at "
    "the same time"
)
OVER_G = (
    "let go, angles, places and rates are over G, by how much a small change of the start has grown"
)


def held_to(*, free: bool, elastic: ElasticFacts | None, moved: str = "") -> str:
    """The truth of a scene's errors, and the letters of their shares; ``moved`` says what moves the
    closed form of one that is driven."""
    if elastic is not None:
        parts = [BENT + ", segments against the exact chain of as many" * (not elastic.of_beam)]
        parts += [OVER_G] * free
        return "; ".join([*parts, "D largest deflection, L longest link, w driver's peak speed."])
    if free:
        return LET_GO
    return f"Largest errors against the closed form{moved}; L longest link, w driver's peak speed."
