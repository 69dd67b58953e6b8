"""Two integrations of one motion beside each other, in charts about different limits too."""

from __future__ import annotations

import numpy as np
import pytest

from analytic.free.doubt import _moved
from analytic.free.machine_motion import MachineMotion
from tests.analytic.free.mechanisms import past_limits, released


def test_a_state_is_the_same_in_the_chart_of_another_limit() -> None:
    """Its acceleration too, so that no difference of that goes unseen where charts change."""
    free = released(past_limits(), 0.9)
    assert isinstance(free, MachineMotion)
    history = free.history
    changes = [first for _, first, _ in history.legs()][1:]
    assert changes
    for k in changes:
        before, after = history.windows[k - 1], history.windows[k]
        share = (before.end_s - before.start_s) / before.long_s
        left = np.array(history.at(np.array([k - 1]), np.array([share])))
        entered = np.array(history.at(np.array([k]), np.zeros(1)))
        moved = _moved(before.chart, after.chart, left, entered[0])
        assert moved[:, 0] == pytest.approx(entered[:, 0], rel=1e-9)
