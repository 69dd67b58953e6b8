"""Collocation with Radau's nodes: exact as high as it says; what is stiff is gone in a step."""

from __future__ import annotations

import numpy as np
import pytest

from analytic.elastic.radau_nodes import radau


@pytest.mark.parametrize("count", [2, 3, 10])
def test_polynomials_up_to_its_order_are_exact(count: int) -> None:
    rule = radau(count)
    assert rule.places[-1] == 1.0
    for power in range(2 * count - 1):
        assert rule.end_once @ rule.places**power == pytest.approx(1.0 / (power + 1), rel=1e-12)
    for power in range(count):
        whole = rule.places ** (power + 1) / (power + 1)
        np.testing.assert_allclose(rule.once @ rule.places**power, whole, atol=1e-13)
        np.testing.assert_allclose(
            rule.twice @ rule.places**power, whole * rule.places / (power + 2), atol=1e-13
        )


def test_with_two_and_three_nodes_they_are_those_of_the_book() -> None:
    """Hairer and Wanner, table 5.5 and 5.6."""
    np.testing.assert_allclose(radau(2).places, [1.0 / 3.0, 1.0], rtol=1e-14)
    np.testing.assert_allclose(radau(2).once, [[5.0 / 12.0, -1.0 / 12.0], [0.75, 0.25]], rtol=1e-13)
    root = np.sqrt(6.0)
    np.testing.assert_allclose(
        radau(3).places, [(4.0 - root) / 10.0, (4.0 + root) / 10.0, 1.0], rtol=1e-13
    )


def test_what_is_stiff_is_gone_after_a_step() -> None:
    """u' = -z u: the end of a step of 1 goes to 0 with 1/z, where Gauss' nodes keep it."""
    rule = radau(10)
    for z in (1e4, 1e6):
        slopes = np.linalg.solve(np.eye(10) + z * rule.once, -z * np.ones(10))
        assert abs(1.0 + rule.end_once @ slopes) < 100.0 / z
