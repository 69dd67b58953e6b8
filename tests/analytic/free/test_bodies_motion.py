"""Free motion of several freedoms: positions beside a run, what leads to the start, its error."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.free.bodies_motion import BodiesMotion
from analytic.free.free_motion import FreeMotion
from analytic.free.machine_motion import MachineMotion
from analytic.free.release import release
from analytic.multibody.multibody_motion import Projection
from models.errors import StructureError
from models.files import load_scene
from models.motion import Motion
from tests.analytic.multibody.scenes import DOUBLE_PENDULUM, scene
from tests.worlds.tiers import slowly


@pytest.fixture(scope="module", params=[0.15, slowly(0.3, reason="errors that grow with time")])
def pendulum(request: pytest.FixtureRequest) -> FreeMotion:
    return release(scene(DOUBLE_PENDULUM), request.param)


def moved(motion: Motion, by_rad: float, by_m: float) -> Motion:
    """A run whose lower rod is turned, and whose pins are open."""
    lower = motion.links["lower"]
    links = {**motion.links, "lower": replace(lower, theta=lower.theta + by_rad)}
    points = {
        name: replace(point, position=point.position + by_m * (name == "C"))
        for name, point in motion.points.items()
    }
    return replace(motion, links=links, points=points)


def test_several_freedoms_go_by_all_bodies_and_windows_by_their_driver(
    pendulum: FreeMotion,
) -> None:
    assert isinstance(pendulum, BodiesMotion)
    assert (pendulum.freedoms, pendulum.by_dyads, pendulum.passages) == (2, False, ())
    assert isinstance(release(load_scene("fourbar-chain"), 0.01), MachineMotion)


def test_beside_a_run_both_its_angles_stay_and_its_pins_are_closed(pendulum: FreeMotion) -> None:
    run = moved(pendulum.at(np.linspace(0.0, pendulum.until_s, 7)), 0.2, 1e-3)
    beside = pendulum.beside(run)
    for name, link in run.links.items():
        assert np.abs(beside.links[name].theta - link.theta).max() < 1e-14
    theta = [run.links[name].theta for name in ("upper", "lower")]
    x = 0.3 * np.cos(theta[0]) + 0.2 * np.cos(theta[1])
    assert np.abs(beside.points["C"].position[:, 0] - x).max() < 1e-14


def test_beside_nothing_there_is_nothing(pendulum: FreeMotion) -> None:
    run = pendulum.at(np.linspace(0.0, pendulum.until_s, 3))
    run.links["lower"].theta[1] = math.nan
    found = pendulum.beside(run).points["C"].position
    assert np.isnan(found[1]).all()
    assert np.isfinite(found[[0, 2]]).all()


def test_what_leads_to_the_start_goes_on_through_it(pendulum: FreeMotion) -> None:
    h = 1e-3
    before = pendulum.outside(np.array([-h])).links
    after = pendulum.at(np.array([0.0, h])).links
    for name, link in after.items():
        second = (before[name].theta[0] - 2.0 * link.theta[0] + link.theta[1]) / h**2
        assert second == pytest.approx(link.alpha[0], rel=1e-3)
        # A central difference is off by the third derivative, some 1e4 rad/s^4.
        steady = (link.omega[1] - before[name].omega[0]) / (2.0 * h)
        assert steady == pytest.approx(link.alpha[0], abs=1e-2)


def test_its_own_error_covers_that_of_a_coarser_integration(pendulum: FreeMotion) -> None:
    assert isinstance(pendulum, BodiesMotion)
    rough = BodiesMotion(replace(pendulum.bodies, method=Projection(1e-10)))
    time_s = np.linspace(0.0, pendulum.until_s, 31)
    own, other = rough.at(time_s), pendulum.at(time_s)
    for name, link in own.links.items():
        off = np.abs(link.theta - other.links[name].theta)
        assert np.all(off <= own.bound.links[name].theta)
        assert np.all(own.bound.links[name].theta <= rough.error_rad(time_s))
    assert float(pendulum.error_rad(time_s).max()) < 1e-10


def test_energy_of_it_balances(pendulum: FreeMotion) -> None:
    energy = pendulum.energy(np.linspace(0.0, pendulum.until_s, 31))
    assert np.ptp(energy.balance) < 1e-11 * energy.kinetic.max()


def test_what_can_not_be_let_go_is_told_both_ways() -> None:
    unnamed = DOUBLE_PENDULUM.split("[start]")[0]
    with pytest.raises(StructureError, match=r"mobility W = .* lower start is not named"):
        release(scene(unnamed.replace("speed_rad_s = 1.0", "")), 0.1)
