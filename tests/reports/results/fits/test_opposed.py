"""A floor and a part of the step that work against each other."""

from __future__ import annotations

import numpy as np
import pytest

from reports.results.fits.floor_fit import ALIGNMENTS, added, opposed, within
from tests.reports.results.fits.measured import MUJOCO_AS_SHIPPED, ORDERS, STEPS, THIRD_THEN_SECOND

DTS = 1e-2 / 2.0 ** np.arange(6)[::-1]
FLOOR = 1e-3


def errors(alignment: float, order: float) -> np.ndarray:
    step = 10.0 * (DTS / DTS[-1]) ** order * FLOOR
    return np.sqrt(FLOOR**2 + 2.0 * alignment * FLOOR * step + step**2)


@pytest.mark.parametrize("alignment", [-0.95, -0.5, 0.3])
@pytest.mark.parametrize("order", [1.0, 2.0])
def test_floor_order_and_alignment_are_found(alignment: float, order: float) -> None:
    curve = opposed(DTS, errors(alignment, order))
    assert curve is not None
    assert (curve.floor, curve.order) == (pytest.approx(FLOOR), pytest.approx(order))
    assert curve.alignment == pytest.approx(alignment)
    assert [curve.at(dt) for dt in DTS] == pytest.approx(errors(alignment, order))
    slope = np.log(curve.at(1.001 * DTS[0]) / curve.at(DTS[0])) / np.log(1.001)
    assert curve.slope == pytest.approx(slope, rel=0.01)


def test_parts_that_point_the_same_way_add_up() -> None:
    """Full alignment is floor + C dt^p, for which there is `added`."""
    curve = added(DTS, errors(1.0, 2.0))
    assert (curve.floor, curve.order) == (
        pytest.approx(FLOOR, rel=1e-3),
        pytest.approx(2.0, abs=1e-3),
    )
    assert curve.misfit < 1e-6


LINES = [
    *(line for line, _ in MUJOCO_AS_SHIPPED.values()),
    *(line for line, _ in ORDERS.values()),
    THIRD_THEN_SECOND,
]


@pytest.mark.parametrize("line", LINES)
def test_no_parts_are_more_than_fully_aligned(line: tuple[float, ...]) -> None:
    dts = 1.0 / np.array(STEPS[::-1])
    curve = opposed(dts, np.array(line[::-1]))
    assert curve is None or abs(curve.alignment) <= 1.0


def test_a_larger_misfit_allows_more_orders_and_floors() -> None:
    exact = errors(-0.5, 1.0)
    curve = opposed(DTS, exact)
    assert curve is not None
    narrow, wide = within(DTS, exact, curve, [0.02**2, 0.06**2], ALIGNMENTS)
    assert wide.floor[0] < narrow.floor[0] < FLOOR < narrow.floor[1] < wide.floor[1]
    assert wide.order[0] < narrow.order[0] <= 1.0 <= narrow.order[1] < wide.order[1]
