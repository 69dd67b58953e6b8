"""What largest errors are held to, in words: it stands under every table of them."""

from __future__ import annotations

LET_GO = (
    "Let go: largest errors at the same time over the sensitivity, by how much a small change of "
    "the start has grown; geometry at the log's own angle; L longest link, w driver's peak speed."
)
BENT = (
    "Elastic links: largest errors against the solved motion of the beam, segments against the "
    "exact chain of as many; D largest deflection, L longest link, w driver's peak speed."
)


def held_to(*, free: bool, elastic: bool, moved: str = "") -> str:
    """The truth of a scene's errors, and the letters of their shares; ``moved`` says what moves the
    closed form of one that is driven."""
    if free:
        return LET_GO
    if elastic:
        return BENT
    return f"Largest errors against the closed form{moved}; L longest link, w driver's peak speed."
