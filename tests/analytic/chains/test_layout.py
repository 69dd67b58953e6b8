"""What is drawn of chains can be looked at."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from analytic.chains.chain import Chain
from analytic.chains.layout import layout
from analytic.chains.number_synthesis import chains
from tests.worlds.tiers import slow

FEW = [*chains(4), *chains(6), *chains(8)[:1], *chains(8)[2:3]]


@pytest.mark.parametrize("chain", FEW)
def test_no_bar_crosses_another(chain: Chain) -> None:
    _check(chain)


@slow("fourteen more, drawn as the few are")
@pytest.mark.parametrize("chain", chains(8))
def test_no_bar_of_an_eight_bar_crosses_another(chain: Chain) -> None:
    _check(chain)


def _check(chain: Chain) -> None:
    drawn = layout(chain)
    assert drawn.crossings == 0
    apart = [np.hypot(*(a - b)) for a, b in itertools.combinations(drawn.at, 2)]
    assert min(apart) > 0.25


def test_it_is_the_same_every_time() -> None:
    chain = chains(6)[0]
    first = layout(chain).at
    layout.cache_clear()
    assert np.array_equal(layout(chain).at, first)
