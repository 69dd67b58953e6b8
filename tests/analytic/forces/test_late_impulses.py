"""What impulses that come a step late make of the energy, against motions worked out by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from analytic.forces.late_impulses import ON_TIME, LateImpulses, late_impulses
from analytic.kinematics import solve
from models.files import parse_scene
from models.scene import Scene

DT_S = 1e-3
ROTOR = """
name = "rotor"
source = "a test"
[ground]
points = { A = [0.0, 0.0] }
[links.crank]
points = { A = [0.0, 0.0], B = [1.0, 0.0] }
mass_kg = 3.0
centre_m = [0.5, 0.0]
inertia_kg_m2 = 0.25
[driver]
link = "crank"
speed_rad_s = 2.0
"""


def rotor() -> Scene:
    return parse_scene(ROTOR, "rotor")


def of_steps(every: int) -> LateImpulses:
    times = every * DT_S * np.arange(3000 // every + 1)
    return late_impulses(rotor(), solve(rotor(), times), DT_S, 0.3)


def test_a_body_that_turns_evenly_has_the_accelerations_of_its_centre_alone() -> None:
    """T = (m r^2 + I) w^2 / 2 = 2 J; S = m r^2 w^4 / 2 = 6 J/s^2; and the acceleration turns by
    w dt in a step, so that over 3 s its differences make m r^2 w^6 / 2 dt^2 3000 = 24 dt^2 3000."""
    late = of_steps(1)
    assert late.start == pytest.approx(2.0 * 6.0 * DT_S**2 / 2.0)
    assert late.offset == pytest.approx(late.start)
    assert late.loss == pytest.approx(2.0 * 24.0 * DT_S**4 * 3000 / 2.0, rel=1e-5)


def test_a_log_of_every_tenth_step_says_the_same() -> None:
    assert of_steps(10).loss == pytest.approx(of_steps(1).loss, rel=1e-4)
    assert of_steps(10).offset == pytest.approx(of_steps(1).offset)


def test_what_does_not_move_has_none() -> None:
    motion = solve(rotor(), DT_S * np.arange(10))
    still = {
        name: replace(link, omega=0.0 * link.omega, alpha=0.0 * link.alpha)
        for name, link in motion.links.items()
    }
    points = {
        name: replace(point, velocity=0.0 * point.velocity, acceleration=0.0 * point.acceleration)
        for name, point in motion.points.items()
    }
    stopped = replace(motion, links=still, points=points)
    assert late_impulses(rotor(), stopped, DT_S, 0.3) == ON_TIME


def test_what_comes_and_goes_counts_by_its_mean_over_the_first_or_the_last_while() -> None:
    times = DT_S * np.arange(1001)
    even = solve(rotor(), times)
    links = {
        name: replace(link, alpha=np.where(times == 0.5, 1e6, link.alpha))
        for name, link in even.links.items()
    }
    whole = late_impulses(rotor(), replace(even, links=links), DT_S, 0.1)
    assert whole.offset == pytest.approx(late_impulses(rotor(), even, DT_S, 0.1).offset)
