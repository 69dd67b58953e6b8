"""The course of a free run as a store keeps it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from models.files import load_scene
from reports.compare.free.energy_drift import drift, window_means, window_s
from reports.store.reader import read_store
from tests.worlds.free_store import LASTS_S


def test_a_free_run_is_kept_from_its_start_to_its_end(free_store: Path) -> None:
    stored = read_store(free_store)
    for row in stored.cells.itertuples():
        trace = stored.trace(str(row.key))
        assert trace["time_s"][0] == 0.0
        assert trace["time_s"][-1] == pytest.approx(LASTS_S)
        assert {len(each) for each in trace.values()} == {len(trace["time_s"])}
        judged = np.max(np.abs(trace["phase"] / trace["growth"]))
        assert judged == pytest.approx(row.phase_pure, rel=0.05)
        assert trace["energy"][0] == 0.0


def test_means_over_windows_begin_and_end_with_those_of_the_drift() -> None:
    scene, time_s = load_scene("fourbar-swing"), np.linspace(0.0, 10.0, 1001)
    series = 0.1 * time_s + np.sin(7.0 * time_s)
    means = window_means(scene, time_s, series)
    known = means[np.isfinite(means)]
    over_s = window_s(scene, 10.0)
    assert known[-1] - known[0] == pytest.approx(drift(series, time_s, over_s), abs=0.02)
    assert np.isnan(means[0])
    assert np.isnan(means[-1])
