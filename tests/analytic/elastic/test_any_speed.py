"""The linearised equations at any speed are those at that speed."""

from __future__ import annotations

from dataclasses import replace

import pytest

from analytic.elastic.any_speed import AnySpeed, apart, at_speed
from analytic.elastic.discretisation import Modes
from analytic.elastic.linearised import linearise
from analytic.elastic.natural import lowest_rad_s, natural_modes
from models.characteristics import Polynomial
from models.errors import CrankcheckError
from models.laws import FromRest
from models.loads import Load
from models.scene import Scene
from tests.analytic.elastic.turning import form_of, fourbar

BY = Modes(2, 0)


def off(scene: Scene, speed: float) -> float:
    """What the equations at a speed are off those that are made there."""
    found = AnySpeed(scene, BY, 5.0, 40.0).linear(speed)
    form = form_of(at_speed(scene, speed), BY)
    exact = linearise(form, found.time_s, 1e-4)
    return apart(found, exact)


def test_they_are_polynomials_of_the_speed() -> None:
    scene = replace(fourbar(damping_s=1e-3), gravity_m_s2=(0.0, -9.81))
    assert AnySpeed(scene, BY, 5.0, 40.0)._series is not None
    assert off(scene, 11.0) < 1e-7


def test_a_load_that_goes_with_the_speed_otherwise_is_met_as_well() -> None:
    drag = Load("drag", "rocker", None, Polynomial((0.0, 0.0, 0.0, -1e-3)), over="omega")
    scene = replace(fourbar(), loads={"drag": drag})
    assert AnySpeed(scene, BY, 5.0, 40.0)._series is None
    assert off(scene, 11.0) < 1e-7


def test_other_laws_are_refused() -> None:
    scene = fourbar()
    law = FromRest(0.0, 10.0, 0.2)
    with pytest.raises(CrankcheckError, match="at a constant one; found another law"):
        at_speed(replace(scene, driver=replace(scene.driver, law=law)), 10.0)


def test_held_still_it_vibrates_as_its_coupler_alone() -> None:
    """A coupler that bends moves its pins by squares of its deflection alone."""
    scene = fourbar()
    modes = natural_modes(*AnySpeed(scene, BY, 5.0, 40.0).still())
    assert modes.frequency_rad_s[:, 0] == pytest.approx(lowest_rad_s(scene), rel=1e-6)
    assert modes.frequency_rad_s[:, 1] == pytest.approx(4.0 * lowest_rad_s(scene), rel=1e-6)
