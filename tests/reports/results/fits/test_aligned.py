"""Floors that curves of any alignment allow."""

from __future__ import annotations

import numpy as np
import pytest

from reports.results.fits.curves import Allowed, Curve
from reports.results.fits.floor_fit import ALIGNMENTS, added, within

DTS = 1e-2 / 2.0 ** np.arange(6)[::-1]
FLOOR = 1e-3


def errors(alignment: float, order: float) -> np.ndarray:
    step = 0.3 * (DTS / DTS[0]) ** order * FLOOR
    return np.sqrt(FLOOR**2 + 2.0 * alignment * FLOOR * step + step**2)


def aligned_within(dts: np.ndarray, errors: np.ndarray, curve: Curve, more: float) -> Allowed:
    (allowed,) = within(dts, errors, curve, [more], ALIGNMENTS)
    return allowed


@pytest.mark.parametrize("alignment", [-0.5, 0.0, 0.3, 0.7, 1.0])
@pytest.mark.parametrize("order", [1.0, 1.65, 2.5])
def test_the_true_floor_and_order_are_allowed_whatever_the_alignment(
    alignment: float, order: float
) -> None:
    curve = added(DTS, errors(alignment, order))
    found = aligned_within(DTS, errors(alignment, order), curve, 0.024**2)
    assert found.floor[0] <= FLOOR <= found.floor[1]
    assert found.order[0] - 0.05 <= order <= found.order[1] + 0.05  # tried every 0.05


def test_points_that_tell_the_alignment_allow_little() -> None:
    curve = added(DTS, errors(1.0, 2.0))
    narrow, wide = (aligned_within(DTS, errors(1.0, 2.0), curve, more**2) for more in (0.01, 0.05))
    assert 0.97 * FLOOR < narrow.floor[0] < narrow.floor[1] < 1.06 * FLOOR
    assert wide.floor[0] < narrow.floor[0]
    assert narrow.floor[1] < wide.floor[1]


def test_what_is_found_is_allowed_where_no_curve_of_the_grid_is() -> None:
    curve = added(DTS, errors(1.0, 1.234))
    found = aligned_within(DTS, errors(1.0, 1.234), curve, 0.0)
    assert found.floor[0] <= curve.floor <= found.floor[1]
    assert found.order[0] <= curve.order <= found.order[1]


def test_errors_and_steps_may_come_in_any_unit() -> None:
    exact = errors(0.3, 2.0)
    one = aligned_within(DTS, exact, added(DTS, exact), 0.02**2)
    other = aligned_within(1e3 * DTS, 1e3 * exact, added(1e3 * DTS, 1e3 * exact), 0.02**2)
    assert other.floor == pytest.approx([1e3 * floor for floor in one.floor], rel=1e-4)
    assert other.order == pytest.approx(one.order, rel=1e-4)
