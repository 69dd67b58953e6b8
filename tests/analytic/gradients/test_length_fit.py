"""Lengths from readings: deviations that are right, ratios where only they are determined, and logs
that no lengths explain."""

import math
from collections.abc import Sequence

import numpy as np
import pytest

from analytic.gradients.dimensions import dimensions, with_dimensions
from analytic.gradients.gradient import gradient_at
from analytic.gradients.length_fit import LengthFit, LoggedSeries, fit_lengths
from analytic.kinematics import solve_driven
from models.array import Array
from models.errors import CrankcheckError
from models.files.reading import load_scene
from models.motion import Motion
from models.scene import Scene
from tests.worlds.tiers import slowly

NOISE = math.radians(0.1)
REAL = load_scene("fourbar-lecture-1")
START = with_dimensions(REAL, {"crank": 0.09, "coupler": 0.27, "rocker": 0.21})


def angle(link: str, values: Array, name: str = "") -> LoggedSeries:
    return LoggedSeries(name or link, values, lambda motion: motion.links[link].theta, True)


def logged(scene: Scene, link: str, seed: int, rows: int = 360) -> tuple[Array, Array]:
    """Angles of the driver over two turns, and of a link, both with noise."""
    rng, theta = np.random.default_rng(seed), np.linspace(0.1, 0.1 + 4.0 * math.pi, rows)
    motion = solve_driven(scene, theta, np.ones(1), np.zeros(1), bound=False)
    noise = rng.normal(0.0, NOISE, (2, rows))
    return theta + noise[0], motion.links[link].theta + noise[1]


def fitted(seed: int) -> LengthFit:
    drive, rocker = logged(REAL, "rocker", seed)
    return fit_lengths(START, drive, [angle("rocker", rocker)])


def own_by_theory() -> dict[str, float]:
    """Deviations of independent noise of one size, of both angles."""
    names, theta = ["crank", "coupler", "rocker"], np.linspace(0.1, 0.1 + 4.0 * math.pi, 360)
    _, by = gradient_at(REAL, theta, [*names, "driver.angle"])
    each = {name: motion.links["rocker"].theta for name, motion in by.items()}
    noise = NOISE * np.sqrt(1.0 + each.pop("driver.angle") ** 2)
    columns = np.array(list(each.values())) / noise
    inverse = np.linalg.inv(columns @ columns.T)
    return dict(zip(names, np.sqrt(np.diag(inverse)).tolist(), strict=True))


@pytest.mark.parametrize("count", [2, slowly(100, reason="the spread of deviations")])
def test_ratios_are_within_three_of_their_own_deviations_which_are_right(count: int) -> None:
    every = [fitted(seed) for seed in range(count)]
    assert {one.unit_length for one in every} == {"ground"}
    within = np.ones(count, dtype=bool)
    for name in ("crank", "coupler", "rocker"):
        off = np.array([one.values[name] - dimensions(REAL)[name].value for one in every])
        own = np.array([one.deviations[name] for one in every])
        within &= np.abs(off) < 3.0 * own
        assert own == pytest.approx(own_by_theory()[name], rel=0.5)
        if count == 100:
            assert 1 / 1.5 < float(np.sqrt(np.mean(off**2)) / np.median(own)) < 1.5
    assert within.sum() >= 0.95 * count - 1
    assert all(one.is_explained(0) for one in every)


def test_exact_readings_give_ratios_and_a_place_or_a_given_length_gives_all_lengths() -> None:
    theta = np.linspace(0.0, 6.0, 60)
    motion = solve_driven(REAL, theta, np.ones(1), np.zeros(1), bound=False)
    rocker = angle("rocker", motion.links["rocker"].theta)

    def x_of_c(one: Motion) -> Array:
        return np.asarray(one.points["C"].position[:, 0])

    place = LoggedSeries("x of C", x_of_c(motion), x_of_c, False)
    readings: Sequence[Sequence[LoggedSeries]] = ([rocker], [rocker], [rocker, place])
    for given, series in zip(({}, {"ground": 0.3}, {}), readings, strict=True):
        found = fit_lengths(START, theta, series, given=given)
        assert (found.unit_length == "") == (bool(given) or len(series) == 2)
        for name, value in found.values.items():
            assert value == pytest.approx(dimensions(REAL)[name].value, rel=1e-9)


def test_zeros_of_sensors_are_found_with_the_lengths() -> None:
    drive, rocker = logged(REAL, "rocker", 5, 720)
    series = [angle("rocker", rocker + 0.2)]
    found = fit_lengths(START, drive + 0.1, series, zeros=True)
    assert found.values["zero of rocker"] == pytest.approx(0.2, abs=0.02)
    assert found.values["zero of the driver"] == pytest.approx(0.1, abs=0.02)
    for name in ("crank", "coupler", "rocker"):
        off = found.values[name] - dimensions(REAL)[name].value
        assert abs(off) < 4.0 * found.deviations[name]


@pytest.mark.parametrize(
    ("other", "link"),
    [
        slowly("slider-crank-offset", "rod", reason="a second: as of another mechanism"),
        ("sixbar-watt", "lever"),
    ],
)
def test_a_log_of_another_mechanism_is_not_explained(other: str, link: str) -> None:
    drive, values = logged(load_scene(other), link, 3)
    found = fit_lengths(REAL, drive, [angle("rocker", values)])
    assert not found.is_explained(0)
    part, chance = found.orderly(0)
    assert part > 3.0 * NOISE
    assert chance > 10.0


def test_another_four_bar_is_fitted_and_dimensions_that_nothing_shows_are_held() -> None:
    other = with_dimensions(REAL, {"crank": 0.08, "coupler": 0.21, "rocker": 0.24})
    drive, rocker = logged(other, "rocker", 2)
    scene = load_scene("sixbar-watt")
    found = fit_lengths(scene, drive, [angle("rocker", rocker)])
    assert set(found.values) == {"crank", "coupler", "rocker"}
    assert found.held["lever"] == "no reading depends on it"
    assert found.is_explained(0)
    for name, value in found.values.items():
        assert abs(value - dimensions(other)[name].value) < 4.0 * found.deviations[name]


def test_faulty_fits_are_refused() -> None:
    drive, rocker = logged(REAL, "rocker", 1)
    with pytest.raises(CrankcheckError, match="no dimension lid"):
        fit_lengths(REAL, drive, [angle("rocker", rocker)], ["lid"])
    with pytest.raises(CrankcheckError, match="2 readings and 4 unknowns"):
        fit_lengths(REAL, drive[:2], [angle("rocker", rocker[:2])])
    with pytest.raises(CrankcheckError, match="and 0 unknowns"):
        fit_lengths(REAL, drive, [angle("crank", drive)])
