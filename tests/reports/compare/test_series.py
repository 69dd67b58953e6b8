"""Error series: whole turns, size, differencing, tracks of what a run logged and lacks; and the
last turn of a run, with what it was off by."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from models.array import Array
from models.scene import Scene
from reports.compare.compare import Beside, Truth, compare
from reports.compare.last_turn import trace
from reports.compare.tracks import angle_error, length, size, tracks
from sim.engine import Run
from tests.worlds.fake.engine import turned_link

Disturbed = Callable[..., Run]
LINE, LONG = np.linspace(0.0, 1.0, 20), np.linspace(0.0, 20.0, 500)


def with_one(at: int, value: float) -> Array:
    series = LINE.copy()
    series[at] = value
    return series


@pytest.mark.parametrize(
    ("angle", "reference", "error"),
    [
        (LINE + 3 * math.tau + 1e-6, LINE, 1e-6),
        (np.remainder(LONG + 1e-5 + math.pi, math.tau) - math.pi, LONG, 3 * math.tau - 1e-5),
        *((with_one(at, LINE[at] + math.tau), LINE, math.tau) for at in (0, 7, 19)),
        (math.tau * LINE, 0.0 * LINE, math.tau),
    ],
    ids=["at the start", "wrapped", "first sample", "one sample", "last sample", "gained slowly"],
)
def test_whole_turns_are_errors_but_at_starts(angle: Array, reference: Array, error: float) -> None:
    assert size(angle_error(angle, reference)).maximum == pytest.approx(error)


@pytest.mark.parametrize(("at", "bad"), [(0, math.nan), (7, -math.inf), (19, math.inf)])
def test_one_sample_that_is_no_number_is_never_skipped(at: int, bad: float) -> None:
    measured = size(with_one(at, bad))
    assert math.isnan(measured.maximum)
    assert math.isnan(measured.rms)
    assert measured.index == at


def test_size_of_known_series() -> None:
    measured = size(np.array([3.0, -4.0, 0.0, 1.0]))
    assert (measured.maximum, measured.final, measured.index) == (4.0, 1.0, 1)
    assert measured.rms == pytest.approx(math.sqrt(26 / 4))
    assert size(np.array([1e200, 1e200])).rms == pytest.approx(1e200)  # does not overflow
    assert length(np.array([[3.0, 4.0], [0.0, -2.0]])).tolist() == [5.0, 2.0]


def test_what_a_run_lacks_is_one_nan_for_all_samples(fourbar: Scene, disturbed: Disturbed) -> None:
    run = disturbed(fourbar)
    rocker = run.motion.links["rocker"]
    silent = replace(rocker, omega=np.full_like(rocker.omega, np.nan))
    part = replace(run, motion=replace(run.motion, links={"coupler": rocker, "rocker": silent}))
    found = tracks(fourbar, part, Truth(fourbar).at(run.motion.time_s), ("velocity",))
    errors = {track.body: track.error for track in found if track.body_kind == "link"}
    assert errors["coupler"].strides == (8,)
    for body in ("crank", "rocker"):
        assert errors[body].shape == run.motion.time_s.shape
        assert errors[body].strides == (0,)
        assert np.isnan(errors[body]).all()


def traced(run: Run, scene: Scene) -> dict[str, Array]:
    return trace(Truth(scene, bound=False), run)


def test_the_last_turn_is_at_equal_parts(fourbar: Scene, disturbed: Disturbed) -> None:
    found = traced(disturbed(fourbar, steps=1440), fourbar)
    assert found["time_s"].size == 91
    turns = np.diff(found["driver_rad"]) * 90 / math.tau
    np.testing.assert_allclose(turns, 1.0, rtol=1e-12)
    assert found["time_s"][-1] == pytest.approx(2.0 * fourbar.driver.law.period_s)


def test_its_errors_keep_their_signs_and_are_no_larger_than_those_of_the_whole_run(
    fourbar: Scene, disturbed: Disturbed
) -> None:
    run = disturbed(fourbar, turned_link("rocker", lambda _: -1e-3))
    found = traced(run, fourbar)
    np.testing.assert_allclose(found["angle.rocker"], -1e-3, rtol=1e-6)
    for name in ("angle.coupler", "drive"):
        np.testing.assert_allclose(found[name], 0.0, atol=1e-12)
    worst = compare(Beside.of(Truth(fourbar), run)).worst("gap")
    assert 0.0 < np.max(found["gap"]) <= worst.maximum


def test_a_late_crank_is_drive_and_not_geometry(fourbar: Scene, disturbed: Disturbed) -> None:
    late = turned_link("crank", lambda _: 1e-3)
    found = traced(disturbed(fourbar, late), fourbar)
    np.testing.assert_allclose(found["drive"], 1e-3, rtol=1e-9)
    assert np.max(np.abs(found["angle.rocker"])) < 1e-12
    assert np.max(np.abs(found["geometric.angle.rocker"])) > 1e-4


def test_a_run_cut_short_gives_what_there_is(fourbar: Scene, disturbed: Disturbed) -> None:
    found = traced(disturbed(fourbar, steps=100), fourbar)
    assert 10 <= found["time_s"].size <= 14
    assert found["time_s"][0] == 0.0
    assert traced(replace(disturbed(fourbar), motion=None), fourbar) == {}
