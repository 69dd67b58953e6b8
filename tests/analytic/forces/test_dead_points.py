"""Dead points, and motions that lack something."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from analytic.forces import kinetostatics
from analytic.kinematics import reach, solve, solve_driven
from models.characteristics import Polynomial
from models.errors import CrankcheckError
from models.files import load_scene
from models.loads import Load
from tests.analytic.dyads.test_redundant import parallelogram
from tests.analytic.forces.beside import series


def test_a_dead_point_is_told_with_its_place() -> None:
    scene = parallelogram(1)
    scene = replace(scene, gravity_m_s2=(0.0, -9.81))
    angles = np.radians([30.0, 0.0])
    with pytest.raises(CrankcheckError, match=r"crank at 0 deg .* dead point: the dyad at B1"):
        kinetostatics.forces(scene, solve_driven(scene, angles, np.array(1.0), np.array(0.0)))


def test_a_dead_point_may_be_left_out() -> None:
    scene = replace(parallelogram(1), gravity_m_s2=(0.0, -9.81))
    motion = solve_driven(scene, np.radians([30.0, 0.0]), np.array(1.0), np.array(0.0))
    found = kinetostatics.forces(scene, motion, skip_dead_points=True)
    for _, array in series(found):
        assert np.isnan(array).reshape(2, -1).all(axis=1).tolist() == [False, True]
    assert np.isinf(found.bound.torque).tolist() == [False, True]
    assert np.isinf(found.bound.pins["B1"]["coupler"]).tolist() == [False, True]


def test_beside_a_dead_point_nothing_is_certain() -> None:
    scene = load_scene("fourbar-double-rocker")
    low, _ = reach(scene)[0]
    near = solve_driven(scene, np.array([low + 1e-14]), np.array(1.0), np.array(0.0))
    found = kinetostatics.forces(scene, near)
    assert np.isinf(found.bound.torque).all()
    assert np.isinf(found.bound.pins["C"]["coupler"]).all()


def test_the_end_of_a_range_is_a_dead_point() -> None:
    scene = load_scene("fourbar-double-rocker")
    end = solve_driven(scene, np.array([reach(scene)[0][0]]), np.array(1.0), np.array(0.0))
    with pytest.raises(CrankcheckError, match=r"driver at -65.3757 deg .* the dyad at C"):
        kinetostatics.forces(scene, end)


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda m: replace(m, points={}), "point A is not in it; solve it without a choice"),
        (lambda m: replace(m, sliders={}), "slider C is not in it"),
        (lambda m: replace(m, bound=None), "carries no bounds"),
        (
            lambda m: replace(m.each_series(lambda a: np.full_like(a, np.nan)), conditioning={}),
            "no acceleration of link crank",
        ),
    ],
)
def test_a_motion_that_lacks_something_is_refused(spoil: object, words: str) -> None:
    scene = load_scene("slider-crank-central")
    motion = solve(scene, np.array([0.1, 0.2]))
    with pytest.raises(CrankcheckError, match=words):
        kinetostatics.forces(scene, spoil(motion))  # type: ignore[operator]


def test_forces_beyond_all_numbers_are_no_dead_point() -> None:
    scene = load_scene("slider-crank-central")
    pull = Load("pull", "rod", "B", Polynomial((0.0,) * 19 + (1e15,)))
    with pytest.raises(CrankcheckError, match=r"t = 1e\+20 s\): forces are larger than numbers go"):
        kinetostatics.forces(replace(scene, loads={"pull": pull}), np.array([1e20]))
