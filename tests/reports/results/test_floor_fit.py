"""A floor and a part of the step that work against each other, and what curves of any alignment
allow."""

import numpy as np
import pytest

from reports.results.floor_fit import ALIGNMENTS, Allowed, ErrorCurve, added, opposed, within

DTS = 1e-2 / 2.0 ** np.arange(6)[::-1]
FLOOR = 1e-3


def errors(alignment: float, order: float, largest: float = 10.0) -> np.ndarray:
    """Those of a floor and a part of the step, which is so many floors at the coarsest."""
    step = largest * (DTS / DTS[-1]) ** order * FLOOR
    return np.sqrt(FLOOR**2 + 2.0 * alignment * FLOOR * step + step**2)


def near(alignment: float, order: float) -> np.ndarray:
    """The same where the part of the step is a third of the floor at the finest."""
    return errors(alignment, order, 0.3 * (DTS[-1] / DTS[0]) ** order)


@pytest.mark.parametrize("alignment", [-0.95, -0.5, 0.3])
@pytest.mark.parametrize("order", [1.0, 2.0])
def test_floor_order_and_alignment_are_found(alignment: float, order: float) -> None:
    curve = opposed(DTS, errors(alignment, order))
    assert (curve.floor, curve.order) == (pytest.approx(FLOOR), pytest.approx(order))
    assert curve.alignment == pytest.approx(alignment)
    assert [curve.at(dt) for dt in DTS] == pytest.approx(errors(alignment, order))
    slope = np.log(curve.at(1.001 * DTS[0]) / curve.at(DTS[0])) / np.log(1.001)
    assert curve.slope == pytest.approx(slope, rel=0.01)


def test_parts_that_point_the_same_way_add_up() -> None:
    """Full alignment is floor + C dt^p, for which there is `added`."""
    curve = added(DTS, errors(1.0, 2.0))
    assert curve.floor == pytest.approx(FLOOR, rel=1e-3)
    assert curve.order == pytest.approx(2.0, abs=1e-3)
    assert curve.misfit < 1e-6


def test_a_larger_misfit_allows_more_orders_and_floors() -> None:
    exact = errors(-0.5, 1.0)
    curve = opposed(DTS, exact)
    narrow, wide = within(DTS, exact, curve, [0.02**2, 0.06**2], ALIGNMENTS)
    assert wide.floor[0] < narrow.floor[0] < FLOOR < narrow.floor[1] < wide.floor[1]
    assert wide.order[0] < narrow.order[0] <= 1.0 <= narrow.order[1] < wide.order[1]


def aligned(errors: np.ndarray, *more: float) -> tuple[ErrorCurve, list[Allowed]]:
    """The curve of errors, and what is allowed where its misfit may be so much larger."""
    curve = added(DTS, errors)
    return curve, within(DTS, errors, curve, [each**2 for each in more], ALIGNMENTS)


@pytest.mark.parametrize("alignment", [-0.5, 0.0, 0.3, 0.7, 1.0])
@pytest.mark.parametrize("order", [1.0, 1.65, 2.5])
def test_the_true_floor_and_order_are_allowed_whatever_the_alignment(
    alignment: float, order: float
) -> None:
    _, (found,) = aligned(near(alignment, order), 0.024)
    assert found.floor[0] <= FLOOR <= found.floor[1]
    assert found.order[0] - 0.05 <= order <= found.order[1] + 0.05  # tried every 0.05


def test_points_that_tell_the_alignment_allow_little() -> None:
    _, (narrow, wide) = aligned(near(1.0, 2.0), 0.01, 0.05)
    assert 0.97 * FLOOR < narrow.floor[0] < narrow.floor[1] < 1.06 * FLOOR
    assert wide.floor[0] < narrow.floor[0]
    assert narrow.floor[1] < wide.floor[1]


def test_what_is_found_is_allowed_where_no_curve_of_the_grid_is() -> None:
    curve, (found,) = aligned(near(1.0, 1.234), 0.0)
    assert found.floor[0] <= curve.floor <= found.floor[1]
    assert found.order[0] <= curve.order <= found.order[1]
