"""Truths of elastic links, with the chains beside them, are found once."""

from collections.abc import Iterator
from functools import cache

import pytest

from models.scene import as_bytes
from reports.compare import elastic_truth
from reports.compare.beam_theory import BeamTheory, ExactChain
from tests.worlds.kept_elastic import kept_motions

THEORY = cache(elastic_truth.kept_theory.__wrapped__)
FIND_CHAIN = BeamTheory.chain
_chains: dict[tuple[object, ...], ExactChain] = {}


def chain(own: BeamTheory, count: int, *, corrected: bool = False) -> ExactChain:
    """`BeamTheory.chain`, the same of one scene."""
    key = as_bytes(own.scene), own.until_s, count, corrected
    if key not in _chains:
        _chains[key] = FIND_CHAIN(own, count, corrected=corrected)
    return _chains[key]


@pytest.fixture(scope="module", autouse=True)
def kept() -> Iterator[None]:
    with kept_motions(), pytest.MonkeyPatch.context() as patch:
        patch.setattr(BeamTheory, "chain", chain)
        patch.setattr(elastic_truth, "kept_theory", THEORY)
        yield
