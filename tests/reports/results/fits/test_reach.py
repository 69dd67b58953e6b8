"""The step that reaches a target error lies on the fit, between steps that were run."""

from __future__ import annotations

import functools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from reports.results.fits.line import LineFit, fit_line
from reports.results.fits.reach import interpolate, reach

STEPS = 1e-2 / 2.0 ** np.arange(6)


@functools.cache
def parabola(floor: float) -> LineFit:
    """The fit of errors of second order over a floor."""
    return fit_line(STEPS, floor + 10.0 * STEPS**2)


@settings(max_examples=30, deadline=None, derandomize=True, database=None)
@given(at=st.floats(STEPS[-1] * 1.001, STEPS[0] * 0.999), floor=st.sampled_from([0.0, 1e-5, 1e-3]))
def test_the_step_of_a_target_has_the_target_for_its_error(at: float, floor: float) -> None:
    fit = parabola(floor)
    target = fit.error_at(at)
    assert target == pytest.approx(floor + 10.0 * at**2, rel=1e-3)
    assert fit.error_at(fit.dt_for(target)) == pytest.approx(target)


def test_nothing_is_extrapolated() -> None:
    errors, fit = 10.0 * STEPS**2, parabola(0.0)
    assert fit.dt_for(1.01 * errors[0]) is fit.dt_for(0.99 * errors[-1]) is None
    assert fit.error_at(1.01 * STEPS[0]) is fit.error_at(0.99 * STEPS[-1]) is None
    assert fit.error_at(STEPS[0] * (1.0 + 1e-15)) == pytest.approx(errors[0])


def test_no_step_reaches_what_is_below_the_floor() -> None:
    fit = parabola(1e-3)
    assert fit.dt_for(0.9e-3) is None
    assert fit.dt_for(1.2e-3) == pytest.approx(math.sqrt(2e-5), rel=0.01)


def test_coarse_points_off_the_fit_are_reached_between_what_was_measured() -> None:
    errors = 10.0 * STEPS
    errors[0] *= 10.0
    fit = fit_line(STEPS, errors)
    assert not fit.used[0]
    found = fit.dt_for(0.2)
    assert STEPS[1] < found < STEPS[0]
    assert math.log(0.2 / errors[1]) / math.log(errors[0] / errors[1]) == pytest.approx(
        math.log(found / STEPS[1]) / math.log(2.0), rel=0.02
    )


def test_a_target_that_a_dip_reaches_but_finer_steps_do_not_is_not_reached() -> None:
    errors = [1e-2, 5e-3, 1e-4, 3e-3, 4e-3, 4.5e-3]
    fit = fit_line(STEPS, errors)
    assert fit.dt_for(1e-3) is None
    assert STEPS[1] < fit.dt_for(7e-3) < STEPS[0]


def test_points_that_wander_are_reached_where_they_rise_over_the_target_first() -> None:
    knots = [(1.0, 1e-3), (2.0, 3e-3), (4.0, 2e-3), (8.0, 9e-3)]
    assert 1.0 < reach(knots, 2.5e-3) < 2.0
    assert reach(knots, 0.9e-3) is reach(knots, 1e-2) is None
    assert reach(knots, 9e-3) == pytest.approx(8.0)


def test_runs_that_failed_are_no_steps_to_reach_anything_with() -> None:
    fit = fit_line(STEPS, 10.0 * STEPS**2, statuses=["diverged", "diverged", *["ok"] * 4])
    assert fit.dt_for(10.0 * STEPS[1] ** 2) is None
    assert fit.dt_for(9.0 * STEPS[2] ** 2) == pytest.approx(math.sqrt(0.9) * STEPS[2])


def test_times_are_interpolated_and_not_extrapolated() -> None:
    errors, seconds = [4e-3, 2e-3, 1e-3], [1.0, 2.0, 4.0]
    assert interpolate(errors, seconds, 1.5e-3) == pytest.approx(4.0 / 1.5)
    assert interpolate(errors, seconds, 2e-3) == pytest.approx(2.0)
    assert interpolate(errors, seconds, 0.9e-3) is interpolate(errors, seconds, 4.1e-3) is None
