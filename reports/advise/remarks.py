"""What is to be said of choices beside their numbers: what ended, what was luck, what creeps."""

from __future__ import annotations

from collections.abc import Iterator

from models.errors import few
from reports.advise.advice import Advice, Offer
from reports.advise.search import SearchResult, Worst

SHOWN = 3
"""Numbers of sub-steps that a sentence names."""


def remarks(advice: Advice) -> Iterator[tuple[str, str]]:
    """The choices that something is said of, and what."""
    groups: dict[str, list[str]] = {}
    for offer in advice.offers:
        for text in filter(None, _of(advice, offer)):
            groups.setdefault(text, []).append(offer.reached.choice.label)
    for text, labels in groups.items():
        yield ", ".join(labels), text


def _of(advice: Advice, offer: Offer) -> Iterator[str]:
    """What is said of one; "" where there is nothing."""
    reached = offer.reached
    yield reached.ended.reason if reached.ended else ""
    yield _unsteady(reached)
    yield _growth(reached.promise or reached.at_frame)
    yield advice.caution(offer)


def _unsteady(reached: SearchResult) -> str:
    """That it was luck that some numbers reached the target."""
    if not reached.unsteady:
        return ""
    numbers = few((str(n) for n in reached.unsteady), SHOWN)
    return f"within with {numbers} sub-steps, and not with more: that is luck, and no promise"


def _growth(worst: Worst | None) -> str:
    """How an error grows."""
    if worst is None or not worst.seen.grows:
        return ""
    return (
        f"the error grows: with {worst.substeps} a frame it is {worst.seen.growth:.2g} times as "
        "large in the second half of the run"
    )
