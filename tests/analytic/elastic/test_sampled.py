"""A motion with elastic links at many instants is the same as at each of them."""

from __future__ import annotations

import numpy as np
import pytest

from analytic.elastic import sampled as module
from analytic.elastic.discretisation import Modes
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.elastic.sampled import bent, sampled
from models.files import load_scene


@pytest.fixture(scope="module")
def motion() -> DrivenElasticMotion:
    return DrivenElasticMotion(load_scene("fourbar-elastic"), 1.0, Modes(1), "periodic", True)


def test_some_at_a_time_and_in_any_order_it_is_the_same(
    motion: DrivenElasticMotion, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "TOGETHER", 3)
    time_s = np.array([0.7, 0.1, 0.3, 0.0, 0.9, 0.5, 0.2])
    whole, each = motion.at(time_s), sampled(motion, time_s)
    for found, wanted in (
        (each.time_s, whole.time_s),
        (each.forces.time_s, whole.forces.time_s),
        (each.links["rocker"].alpha, whole.links["rocker"].alpha),
        (each.points["C"].position, whole.points["C"].position),
        (each.elastic["coupler"].middle, whole.elastic["coupler"].middle),
        (each.forces.torque, whole.forces.torque),
    ):
        np.testing.assert_allclose(found, wanted, rtol=1e-12, atol=1e-13)


def test_the_shape_goes_through_both_pins_and_the_middle(motion: DrivenElasticMotion) -> None:
    time_s = np.array([0.1, 0.2])
    shape = bent(motion, time_s, np.linspace(0.0, 1.0, 5))["coupler"]
    assert np.max(np.abs(shape[:, [0, -1]])) < 1e-17
    np.testing.assert_allclose(shape[:, 2], motion.at(time_s).elastic["coupler"].middle, rtol=1e-12)
