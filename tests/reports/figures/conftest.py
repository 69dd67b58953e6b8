"""Widths at which words of figures have room."""

from collections.abc import Iterator

import pytest

from reports.figures.layout import LAYOUT, LEAST_MM, Layout
from tests.worlds.tiers import slowly

NARROW = "the same figures in a narrower column"


@pytest.fixture(params=[None, slowly(85.0, reason=NARROW), slowly(LEAST_MM, reason=NARROW)])
def any_width(request: pytest.FixtureRequest) -> Iterator[None]:
    token = LAYOUT.set(Layout(width_mm=request.param))
    yield
    LAYOUT.reset(token)
