"""Error series: whole turns, size, differencing; and the tracks of what a run logged and lacks."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from models.scene import Scene
from reports.compare.beside import Truth
from reports.compare.series import angle_error, length, rate, second_rate, size
from reports.compare.tracks import tracks
from sim.engine import Run


def test_whole_turns_at_the_start_are_no_error() -> None:
    reference = np.linspace(0.0, 1.0, 50)
    assert size(angle_error(reference + 3 * math.tau + 1e-6, reference)).maximum == pytest.approx(
        1e-6
    )


def test_a_whole_turn_gained_slowly_on_the_way_is_an_error() -> None:
    reference = np.zeros(200)
    engine = np.linspace(0.0, math.tau, 200)
    assert size(angle_error(engine, reference)).final == pytest.approx(math.tau)


def test_a_wrapped_angle_is_an_error_of_whole_turns() -> None:
    reference = np.linspace(0.0, 20.0, 500)
    wrapped = np.remainder(reference + 1e-5 + math.pi, math.tau) - math.pi
    assert size(angle_error(wrapped, reference)).maximum == pytest.approx(3 * math.tau, rel=1e-5)


@pytest.mark.parametrize("at", [0, 7, 19])
def test_a_whole_turn_at_one_sample_alone_is_an_error(at: int) -> None:
    reference = np.linspace(0.0, 1.0, 20)
    engine = reference.copy()
    engine[at] += math.tau
    assert size(angle_error(engine, reference)).maximum == pytest.approx(math.tau)


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("at", [0, 7, 19])
def test_one_sample_that_is_no_number_is_never_skipped(bad: float, at: int) -> None:
    series = np.linspace(0.0, 1.0, 20)
    series[at] = bad
    measured = size(series)
    assert math.isnan(measured.maximum)
    assert math.isnan(measured.rms)
    assert measured.index == at


def test_size_of_a_known_series() -> None:
    measured = size(np.array([3.0, -4.0, 0.0, 1.0]))
    assert (measured.maximum, measured.final, measured.index) == (4.0, 1.0, 1)
    assert measured.rms == pytest.approx(math.sqrt(26 / 4))


def test_rms_of_huge_errors_does_not_overflow() -> None:
    assert size(np.array([1e200, 1e200])).rms == pytest.approx(1e200)


def test_length_of_vectors_is_euclidean() -> None:
    assert length(np.array([[3.0, 4.0], [0.0, -2.0]])).tolist() == [5.0, 2.0]


def test_differences_are_exact_for_a_parabola_and_drop_both_ends() -> None:
    time_s = 0.1 * np.arange(11)
    series = 2.0 + 3.0 * time_s + 4.0 * time_s**2
    assert rate(series, 0.1) == pytest.approx(3.0 + 8.0 * time_s[1:-1])
    assert second_rate(series, 0.1) == pytest.approx(np.full(9, 8.0))


def test_what_a_run_lacks_is_one_nan_for_all_its_samples(
    fourbar: Scene, disturbed: Callable[..., Run]
) -> None:
    run = disturbed(fourbar)
    rocker = run.motion.links["rocker"]
    lacking = {
        "coupler": rocker,
        "rocker": replace(rocker, omega=np.full_like(rocker.omega, np.nan)),
    }
    part = replace(run, motion=replace(run.motion, links=lacking))
    reference = Truth(fourbar).at(run.motion.time_s)
    errors = {
        track.body: track.error
        for track in tracks(fourbar, part, reference, ("velocity",))
        if track.body_kind == "link"
    }
    assert errors["coupler"].strides == (8,)
    for body in ("crank", "rocker"):
        assert errors[body].shape == run.motion.time_s.shape
        assert errors[body].strides == (0,)
        assert np.isnan(errors[body]).all()
