"""What is drawn of a long log has its spikes."""

from __future__ import annotations

import numpy as np
import pytest

from reports.page.extremes import extreme_rows


def test_a_short_log_is_drawn_whole() -> None:
    series = np.sin(np.arange(100.0))
    assert extreme_rows((series, -series), 100).tolist() == list(range(100))


@pytest.mark.parametrize("number", [101, 1000, 99_991])
@pytest.mark.parametrize("row", [0, 1, 77, -1])
def test_a_spike_of_one_row_stays_in_either_series(number: int, row: int) -> None:
    for sign in (-1.0, 1.0):
        calm, spiked = np.sin(0.01 * np.arange(number)), np.zeros(number)
        spiked[row] = sign
        rows = extreme_rows((calm, spiked), 100)
        assert rows.size <= 110
        assert row % number in rows
        assert (rows[0], rows[-1]) == (0, number - 1)
        assert np.all(np.diff(rows) > 0)
        assert np.max(calm[rows]) == np.max(calm)
        assert np.min(calm[rows]) == np.min(calm)


def test_missing_samples_hide_no_spike_and_what_is_infinite_is_drawn() -> None:
    series = np.zeros(1000)
    series[100:300] = np.nan
    series[250], series[700] = 3.0, -np.inf
    rows = extreme_rows((series,), 50)
    assert {250, 700} <= set(rows.tolist())
