"""Lines of known order, floor and scatter are read as what they are, with honest uncertainty, also
where floor and step work against each other; the step that reaches a target error lies on the fit,
between steps that were run."""

import math

import numpy as np
import pytest

from reports.judge.three_steps import AT_ROUNDING
from reports.results.floor_fit import ALIGNMENTS, added, opposed, reach, within
from reports.results.line_fit import FitKind, fit_line
from tests.worlds.tiers import slowly

STEPS = 1e-2 / 2.0 ** np.arange(6)


def line(order: float, floor: float = 0.0, dts: np.ndarray = STEPS, c: float = 10.0) -> np.ndarray:
    return floor + c * dts**order


def scattered(errors: np.ndarray, scatter: float, rng: np.random.Generator) -> np.ndarray:
    return errors * np.exp(scatter * rng.standard_normal(len(errors)))


@pytest.mark.parametrize("number", [3, 6])
@pytest.mark.parametrize("order", [0.8, 1.0, 4.0])
def test_a_power_of_the_step_has_its_order_and_no_floor(order: float, number: int) -> None:
    found = fit_line(STEPS[:number], line(order)[:number], rounding=0.0)
    assert (found.kind, found.order) == ("order", pytest.approx(order))
    assert found.curve.coefficient == pytest.approx(10.0)
    assert found.order_error < 0.1
    assert all(found.used)
    assert math.isnan(found.floor)
    assert 0.0 < found.floor_below < line(order)[number - 1]


@pytest.mark.parametrize(("order", "share"), [(1.0, 2.0), (2.0, 10.0), (3.5, 1e5)])
def test_a_floor_under_a_power_of_the_step_is_found(order: float, share: float) -> None:
    """``share``: the floor over what still falls with the step at the finest."""
    floor = share * line(order)[-1]
    found = fit_line(STEPS, line(order, floor), rounding=0.0)
    assert (found.kind, found.floor) == ("floor", pytest.approx(floor, rel=1e-3))
    assert found.order == pytest.approx(order, abs=0.01)
    assert found.curve.coefficient == pytest.approx(10.0, rel=0.05)
    assert found.floor_error < 0.2 * floor
    assert floor < found.floor_below < 1.5 * floor


def test_a_floor_that_has_only_just_come_up_is_not_claimed_and_not_excluded() -> None:
    floor = 0.5 * line(2.0)[-1]
    found = fit_line(STEPS, line(2.0, floor))
    assert math.isnan(found.floor)
    assert found.floor_below > 0.8 * floor
    rng = np.random.default_rng(22)  # nor on first-order lines with scatter
    kinds = {fit_line(STEPS, scattered(line(1.0), 0.05, rng)).kind for _ in range(25)}
    assert "floor" not in kinds


def test_an_error_that_no_step_changes_or_that_comes_up_to_its_floor_is_a_floor() -> None:
    found = fit_line(STEPS, [7.5e-4] * 6)
    assert (found.kind, found.floor) == ("floor", pytest.approx(7.5e-4))
    assert found.floor_error < 0.05 * 7.5e-4
    assert math.isnan(found.order)
    found = fit_line(STEPS, 1e-2 * (1.0 - 20.0 * STEPS))
    assert (found.kind, found.floor) == ("floor", pytest.approx(1e-2, rel=1e-3))
    assert found.curve.coefficient < 0.0


def test_what_has_neither_an_order_nor_a_floor_says_why() -> None:
    for kind, errors in (
        ("irregular", [*line(2.0)[:-1], 2.0 * line(2.0)[-1]]),  # leaves its order at the finest
        ("irregular", [1e-3, 5e-4, 9e-4]),  # jumps about one level in so many steps
        ("irregular", [1.06e-3, 5.7e-4, 3.8e-4, 7.1e-4]),
        ("irregular", [9.6e-4, 1.07e-3, 6.9e-4, 5.4e-4, 9.1e-4]),
        ("at rounding", [1e-6, 1e-9, 4e-12, 5e-12, 5e-12, 6e-12]),
    ):
        found = fit_line(STEPS[: len(errors)], errors)
        assert (found.kind, found.curve) == (kind, None)
        assert not any(found.used)
        assert math.isnan(found.floor)


def test_points_at_rounding_are_left_out() -> None:
    errors = np.maximum(line(4.0), [0.0, 0.0, 0.0, 0.0, 8e-12, 1.4e-11])
    found = fit_line(STEPS, errors)
    assert found.used == (True, True, True, True, False, False)
    assert found.order == pytest.approx(4.0)
    dts = 1e-2 / 2.0 ** np.arange(9)
    found = fit_line(dts, line(4.0, 3e-11, dts=dts, c=1e3))  # a floor just above it is taken for it
    assert (found.kind, found.order) == ("order", pytest.approx(4.0, abs=0.1))
    assert fit_line(STEPS, line(2.0, 5e-9), rounding=1e-3).kind == "at rounding"  # as of a drive


def test_runs_that_did_not_end_well_are_left_out_with_all_coarser_ones() -> None:
    statuses = ["ok", "diverged", "ok", "ok", "ok", "ok"]
    found = fit_line(STEPS, line(2.0), statuses=statuses)
    assert found.used == (False, False, True, True, True, True)
    assert (found.stable_from_s, found.fails_from_s) == (STEPS[2], STEPS[1])
    for bad in (math.nan, math.inf):
        found = fit_line(STEPS, [bad, *line(2.0)[1:]])
        assert (found.kind, found.failed, found.stable_from_s) == ("order", "diverged", STEPS[1])
    found = fit_line(STEPS, line(2.0), statuses=["ok"] * 5 + ["diverged"])
    assert found.kind == "diverges"
    assert math.isnan(found.stable_from_s)


@pytest.mark.parametrize("status", ["timeout", "unsupported"])
def test_a_run_without_end_says_nothing_about_the_step(status: str) -> None:
    found = fit_line(STEPS, line(2.0), statuses=["ok", "ok", "ok", "ok", "ok", status])
    assert (found.kind, found.failed) == ("order", "")
    assert found.used == (True, True, True, True, True, False)
    assert fit_line(STEPS, [math.nan] * 6, statuses=[status] * 6).kind == "not run"


def test_what_is_no_line_is_refused() -> None:
    wrong = ([1e-2], [1.0, 2.0]), ([0.0], [1.0]), ([math.nan], [1.0]), ([1e-2], [-1.0])
    for dts, errors in wrong:
        with pytest.raises(ValueError, match="steps"):
            fit_line(dts, errors)
    with pytest.raises(ValueError, match="steps"):
        fit_line([1e-2], [1.0], statuses=["ok", "ok"])


def test_the_stated_uncertainty_of_an_order_holds_two_times_in_three() -> None:
    rng = np.random.default_rng(20)
    seen, held, count = 0, 0, 60
    for k in range(count):
        order = (1.0, 2.0, 4.0)[k % 3]
        found = fit_line(STEPS, scattered(line(order), 0.05, rng), rounding=0.0)
        seen += found.kind == "order"
        held += abs(found.order - order) <= found.order_error
    assert seen > 0.99 * count
    # Three standard deviations of a count.
    assert held / count == pytest.approx(0.683, abs=3.0 * math.sqrt(0.683 * 0.317 / count))


ERRORS: dict[str, tuple[FitKind, np.ndarray]] = {
    "order": ("order", scattered(line(2.0), 0.05, np.random.default_rng(1))),
    "floor": ("floor", scattered(line(1.0, 1e-2), 0.02, np.random.default_rng(1))),
    "against": ("floor", np.sqrt(1e-6 - 1.4e-3 * (0.1 * STEPS) + (0.1 * STEPS) ** 2 * 1e0)),
}


@pytest.mark.parametrize("name", ERRORS)
@pytest.mark.parametrize(("error", "dt"), [(1e-3, 1e3), slowly(700.0, 300.0, reason="other units")])
def test_units_and_the_order_of_runs_do_not_matter(name: str, error: float, dt: float) -> None:
    (kind, errors), mixed = ERRORS[name], [3, 5, 0, 1, 4, 2]
    fit = fit_line(STEPS, errors)
    other = fit_line(dt * STEPS[mixed], error * errors[mixed], rounding=error * AT_ROUNDING)
    assert (fit.kind, other.kind) == (kind, kind)
    assert tuple(np.array(other.used)[np.argsort(mixed)]) == fit.used
    for number in ("order", "order_error", "floor", "floor_error", "floor_below", "scatter"):
        expected = (error if "floor" in number else 1.0) * getattr(fit, number)
        assert getattr(other, number) == pytest.approx(expected, rel=1e-4, nan_ok=True), number
    for own, others in zip(fit.used_range_s, other.used_range_s, strict=True):
        assert other.curve.at(others) == pytest.approx(error * fit.curve.at(own), rel=1e-4)
        assert others == pytest.approx(dt * own)


@pytest.mark.parametrize("floor", [0.0, 1e-5, 1e-3])
def test_the_step_of_a_target_has_it_for_its_error_and_is_in_the_range(floor: float) -> None:
    errors = floor + 10.0 * STEPS**2
    fit = fit_line(STEPS, errors)
    for at in np.geomspace(STEPS[-1] * 1.001, STEPS[0] * 0.999, 9):
        target = fit.error_at(at)
        assert target == pytest.approx(floor + 10.0 * at**2, rel=1e-3)
        assert fit.error_at(fit.dt_for(target)) == pytest.approx(target)
    assert fit.dt_for(1.01 * errors[0]) is fit.dt_for(0.99 * errors[-1]) is None
    assert fit.error_at(1.01 * STEPS[0]) is fit.error_at(0.99 * STEPS[-1]) is None
    assert fit.error_at(STEPS[0] * (1.0 + 1e-15)) == pytest.approx(fit.error_at(STEPS[0]))


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


def test_points_that_wander_are_reached_where_they_rise_over_the_target_first() -> None:
    knots = [(1.0, 1e-3), (2.0, 3e-3), (4.0, 2e-3), (8.0, 9e-3)]
    assert 1.0 < reach(knots, 2.5e-3) < 2.0
    assert reach(knots, 0.9e-3) is reach(knots, 1e-2) is None
    assert reach(knots, 9e-3) == pytest.approx(8.0)


def test_runs_that_failed_are_no_steps_to_reach_anything_with() -> None:
    fit = fit_line(STEPS, 10.0 * STEPS**2, statuses=["diverged", "diverged", *["ok"] * 4])
    assert fit.dt_for(10.0 * STEPS[1] ** 2) is None
    assert fit.dt_for(9.0 * STEPS[2] ** 2) == pytest.approx(math.sqrt(0.9) * STEPS[2])


DTS = 1e-2 / 2.0 ** np.arange(6)[::-1]
FLOOR = 1e-3


def opposing(alignment: float, order: float, largest: float = 10.0) -> np.ndarray:
    """Those of a floor and a part of the step, which is so many floors at the coarsest."""
    step = largest * (DTS / DTS[-1]) ** order * FLOOR
    return np.sqrt(FLOOR**2 + 2.0 * alignment * FLOOR * step + step**2)


@pytest.mark.parametrize(("alignment", "order"), [(-0.95, 2.0), (0.3, 1.0)])
def test_floor_order_and_alignment_are_found(alignment: float, order: float) -> None:
    curve = opposed(DTS, opposing(alignment, order))
    assert (curve.floor, curve.order) == (pytest.approx(FLOOR), pytest.approx(order))
    assert curve.alignment == pytest.approx(alignment)
    assert [curve.at(dt) for dt in DTS] == pytest.approx(opposing(alignment, order))
    slope = np.log(curve.at(1.001 * DTS[0]) / curve.at(DTS[0])) / np.log(1.001)
    assert curve.slope == pytest.approx(slope, rel=0.01)


@pytest.mark.parametrize(("alignment", "order"), [(-0.5, 1.0), (0.3, 1.65), (1.0, 2.5)])
def test_true_floor_and_order_are_allowed_at_any_alignment(alignment: float, order: float) -> None:
    # The part of the step is a third of the floor at the finest.
    made = opposing(alignment, order, 0.3 * (DTS[-1] / DTS[0]) ** order)
    curve = added(DTS, made)
    exact, near_it, found = within(DTS, made, curve, [0.0, 0.01**2, 0.024**2], ALIGNMENTS)
    assert exact.floor[0] <= curve.floor <= exact.floor[1]  # though no curve of the grid is
    assert found.floor[0] < near_it.floor[0] <= near_it.floor[1] < found.floor[1]
    assert found.order[0] <= near_it.order[0] <= near_it.order[1] <= found.order[1]
    assert found.floor[0] <= FLOOR <= found.floor[1]
    assert alignment < 1.0 or 0.97 * FLOOR < near_it.floor[0] < near_it.floor[1] < 1.06 * FLOOR
    assert found.order[0] - 0.05 <= order <= found.order[1] + 0.05  # tried every 0.05
