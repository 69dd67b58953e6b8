"""Where friction locks a mechanism, and what it costs where it does not; and Coulomb's equations of
several joints: one solution, none, or two, and what is said of it."""

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.forces import friction, kinetostatics
from analytic.forces.efficiency import efficiency, self_locking
from analytic.forces.friction import CoulombSystem, solve_coulomb
from models.errors import CrankcheckError
from models.files.reading import parse_scene
from models.scene import Driver, Scene
from models.scene.laws import Accelerating, Oscillating
from models.scene.loads import ConstantFriction, CoulombFriction
from tests.worlds.tiers import slow, slowly

STEEP = """
name = "slider-crank-self-locking"
source = "a steep rod against a rubbing guide; closed form: rod's angle + friction angle = 90 deg"
ground = { points = { A = [0.0, 0.0] } }
sliders = { P = { point = "C", on = "ground", mass_kg = 0.001 } }
driver = { link = "crank", speed_rad_s = 1.0, start_deg = 10.0 }
friction = { P = { mu = 0.5 } }
[links]
crank = { bar = ["A", "B"], length_m = 0.1 }
rod = { bar = ["B", "C"], length_m = 0.11, mass_kg = 0.0, inertia_kg_m2 = 0.0 }
[loads]
out = { block = "P", direction_deg = 180.0, force_n = 100.0, slider = "P", stroke = "forward" }
back = { block = "P", force_n = 100.0, slider = "P", stroke = "backward" }
"""
"""The loads are against the motion on both strokes, and inertia is next to nothing."""


def steep(mu: float = 0.5) -> Scene:
    return parse_scene(STEEP.replace("mu = 0.5", f"mu = {mu}"), "steep")


def helped(scene: Scene) -> Scene:
    """Its loads with the motion."""
    turned = {n: replace(one, direction_rad=one.direction_rad + math.pi)
              for n, one in scene.loads.items()}  # fmt: skip
    return replace(scene, loads=turned)


def limit(mu: float) -> float:
    """The crank angle from the dead point at which psi = 90 deg - atan(mu), sin psi = r sin / l."""
    return math.asin(0.11 / 0.1 * math.sin(math.pi / 2 - math.atan(mu)))


@pytest.mark.parametrize("mu", [0.4591, 1.0])
def test_a_slider_crank_locks_where_the_rod_leans_by_the_complement(mu: float) -> None:
    found, begin = self_locking(steep(mu)), limit(mu)
    told = [end for each in found for end in (each.begin_rad, each.end_rad)]
    wanted = [begin, math.pi - begin, math.pi + begin, math.tau - begin]
    assert all(each.locks for each in found)
    assert told == pytest.approx(wanted, abs=1e-13)
    ends = math.degrees(begin), 180.0 - math.degrees(begin)
    assert found[0].words == f"locks itself from {ends[0]:.6g} to {ends[1]:.6g} deg"


@slow("a second: limits are found above without them, and pins that rub solved below")
def test_pins_that_rub_move_the_limit_by_a_tangents_lean() -> None:
    """The rod's force runs along a tangent of both friction circles, which leans from the rod by
    asin((c_B +- c_C)/l), and that counts in place of the rod's angle. Beyond 90 deg the rod turns
    back, and rubs the other way in C."""
    scene, radii = steep(), {"B": 0.02, "C": 0.01}
    circles = [radius * math.sin(math.atan(0.3)) for radius in radii.values()]
    pins = {joint: CoulombFriction(joint, 0.3, radius) for joint, radius in radii.items()}
    first = self_locking(replace(scene, friction={**scene.friction, **pins}), 24)[0]
    before, after = (math.asin((circles[0] + sign * circles[1]) / 0.11) for sign in (1, -1))
    steepest = math.pi / 2 - math.atan(0.5)
    wanted = [math.asin(1.1 * math.sin(steepest - lean)) for lean in (before, after)]
    assert first.locks
    assert first.begin_rad == pytest.approx(wanted[0], abs=1e-8)
    assert first.end_rad == pytest.approx(math.pi - wanted[1], abs=1e-8)


def test_with_less_friction_it_never_locks_and_with_much_everywhere_in_one_range() -> None:
    """psi reaches 65.4 deg, so below mu = tan(24.6 deg) = 0.4583 there is nothing to find."""
    assert self_locking(steep(0.4582)) == ()
    assert self_locking(replace(steep(), friction={})) == ()
    constant = {"P": ConstantFriction("P", 1e6)}
    assert self_locking(replace(steep(), friction=constant)) == ()
    law = Oscillating(math.radians(90.0), math.radians(20.0), 2.0)
    found = self_locking(replace(steep(5.0), driver=Driver("crank", law)))
    assert found
    assert all(each.locks for each in found)


def test_with_a_load_that_helps_it_may_jam_on_over_the_start_of_the_cycle() -> None:
    law = replace(steep().driver.law, start_rad=math.radians(90.0))
    found = self_locking(replace(helped(steep()), driver=Driver("crank", law)))
    assert [each.locks for each in found] == [False, False]
    assert {each.words[:8] for each in found} == {"may jam "}
    ends = sorted((each.begin_rad, each.end_rad) for each in found)
    begin = limit(0.5)
    assert ends[0] == pytest.approx((math.pi + begin, math.tau - begin), abs=1e-13)
    assert ends[1] == pytest.approx((math.tau + begin, math.tau + math.pi - begin), abs=1e-13)


def test_locked_instants_are_refused_by_their_angle_or_left_out() -> None:
    scene = steep()
    with pytest.raises(CrankcheckError, match=r"crank at 85 deg .* locks itself: friction in P"):
        kinetostatics.forces(scene, [math.radians(75.0)])
    time_s = np.radians([0.0, 75.0])
    found = kinetostatics.forces(scene, time_s, skip_dead_points=True)
    for value, bound in (
        (found.torque, found.bound.torque),
        (found.friction["P"], found.bound.friction["P"]),
    ):
        assert np.isnan(value).tolist() == np.isinf(bound).tolist() == [False, True]
    assert found.friction_solution.solutions.tolist() == [1, 0]


def test_beside_locking_the_torque_grows_past_all_bounds_and_so_does_its_own() -> None:
    phi = limit(0.5) - np.array([1e-2, 1e-5, 1e-8])
    found = kinetostatics.forces(steep(), phi - math.radians(10.0))
    assert np.all(np.diff(np.abs(found.torque)) > 0.0)
    assert np.all(np.diff(found.bound.torque) > 0.0)
    assert np.all(found.bound.torque < 1e-3 * np.abs(found.torque))
    psi = np.arcsin(np.sin(phi) / 1.1)
    rod = 100.0 / (np.cos(psi) - 0.5 * np.sin(psi))
    assert np.abs(found.torque) == pytest.approx(rod * 0.1 * np.sin(phi + psi), rel=1e-4)


def test_an_instantaneous_efficiency_is_that_of_the_textbook() -> None:
    """Torque without friction over that with it: 1 - mu tan psi, psi the rod's lean."""
    found = efficiency(steep(0.1))
    wanted = 1.0 - 0.1 * np.abs(np.tan(np.arcsin(np.sin(found.theta) / 1.1)))
    assert found.instantaneous == pytest.approx(wanted, abs=2e-4)
    assert found.locked == ()
    assert found.put_in == pytest.approx(found.useful + found.wasted, rel=1e-12)
    assert found.useful == pytest.approx(2 * 100.0 * 0.2, rel=1e-4)  # the force over two strokes
    lossless = efficiency(replace(steep(), friction={}), 90)
    assert (lossless.cycle, lossless.wasted) == (pytest.approx(1.0, abs=1e-12), 0.0)
    assert np.nanmin(lossless.instantaneous) == 1.0


def test_a_machine_that_its_loads_drive_that_locks_or_speeds_up_has_no_efficiency() -> None:
    found = efficiency(helped(steep(0.1)))
    assert math.isnan(found.cycle)
    assert found.useful < 0.0
    assert found.put_in == pytest.approx(found.useful + found.wasted, rel=1e-12)
    assert math.isnan(efficiency(replace(steep(0.1), loads={})).cycle)
    locked = efficiency(steep())
    assert math.isnan(locked.cycle)
    assert len(locked.locked) == 2
    assert np.isnan(locked.power).sum() > 50
    scene = replace(steep(), driver=Driver("crank", Accelerating(0.0, 1.0, 0.3)))
    with pytest.raises(CrankcheckError, match="speeds up, so no cycle is like the next"):
        efficiency(scene)


def drawn(count: int, m: int, gain: float, *, pins: bool, seed: int) -> CoulombSystem:
    """Random equations whose gains have about that spectral radius."""
    chance = np.random.default_rng(seed)
    alone, influence = chance.normal(size=(count, m, 2)), chance.normal(size=(count, m, m, 2))
    if not pins:
        alone[..., 1], influence[..., 1] = 0.0, 0.0
    return CoulombSystem(alone, influence, np.full(m, gain / m))


@pytest.mark.parametrize(
    ("alone", "influence", "solutions", "g", "rel"),
    [
        (10.0, 4.0, 0, np.nan, 1e-14),  # 0.5 (10 + 4 g) runs ahead of g
        (-10.0, 4.0, 2, 5.0 / 3.0, 1e-14),  # 0.5 (10 - 4 g), or 0.5 (4 g - 10) = 5
        (10.0, 2.0 - 1e-9, 1, 1e10, 1e-6),  # just short of contracting no more
        (np.inf, 1.0, 1, np.nan, 1e-14),  # where reactions are no numbers nothing is said of it
    ],
)
def test_a_slider_has_one_solution_none_or_two(
    alone: float, influence: float, solutions: int, g: float, rel: float
) -> None:
    """It rubs by g = 0.5 |alone + influence g|."""
    reactions = np.array([[[alone, 0.0]]]), np.array([[[[influence, 0.0]]]])
    found = solve_coulomb(CoulombSystem(*reactions, np.array([0.5])))
    assert found.solutions[0] == solutions
    assert found.g[0, 0] == pytest.approx(g, rel=rel, nan_ok=True)


def test_a_pin_has_as_many_solutions_as_its_quadratic_equation() -> None:
    """(1 - rho^2 c^2) g^2 - 2 rho^2 (R c) g - rho^2 R^2 = 0 with g > 0."""
    system = drawn(400, 1, 1.5, pins=True, seed=3)
    found, rho = solve_coulomb(system), float(system.mu[0])
    for i, (r, c) in enumerate(zip(system.alone[:, 0], system.influence[:, 0, 0], strict=True)):
        roots = np.roots([1.0 - rho**2 * (c @ c), -2.0 * rho**2 * (r @ c), -(rho**2) * (r @ r)])
        real = sorted(x.real for x in roots if abs(x.imag) < 1e-12 and x.real > 0.0)
        assert found.solutions[i] == len(real), i
        if real:
            assert found.g[i, 0] == pytest.approx(real[0], rel=1e-9)
    assert {0.0, 1.0, 2.0} == set(found.solutions)


def test_sliders_have_the_solutions_that_trying_all_signs_finds() -> None:
    m = 3
    system = drawn(300, m, 1.3, pins=False, seed=m)
    found = solve_coulomb(system)
    for i in range(300):
        alone, influence = system.alone[i, :, 0], system.influence[i, :, :, 0]
        right = []
        for signs in itertools.product((1.0, -1.0), repeat=m):
            factor = system.mu * signs
            g = np.linalg.solve(np.eye(m) - factor[:, None] * influence, factor * alone)
            if np.all(g >= 0.0):
                right.append(g)
        assert found.solutions[i] == min(len(right), 2), i
        if right:
            least = min(right, key=np.sum)
            np.testing.assert_allclose(found.g[i], least, rtol=1e-8)
    assert {0.0, 1.0, 2.0} == set(found.solutions)


@pytest.mark.parametrize("gain", [0.3, 0.7])
def test_where_they_contract_substitution_leads_to_the_same(gain: float) -> None:
    system = drawn(100, 4, gain, pins=True, seed=1)
    inside = np.all(friction.weights(system.gains()) > 0.0, axis=1)
    radius = np.abs(np.linalg.eigvals(system.gains())).max(axis=1)
    np.testing.assert_array_equal(inside, radius < 1.0)
    system = system.at(inside)
    assert inside.sum() > 20
    found = solve_coulomb(system)
    g = np.zeros_like(found.g)
    for _ in range(1500):
        g = system.friction(g)
    np.testing.assert_allclose(found.g, g, rtol=1e-11)
    assert np.all(found.solutions == 1)
    assert np.all(found.change <= 1e-13)
    assert np.max(found.iterations) < 30


def test_a_singular_system_spoils_no_other() -> None:
    matrices = np.array([np.eye(2), np.ones((2, 2)), 2.0 * np.eye(2)])
    x = friction.solve_small(matrices, np.ones((3, 2)))
    np.testing.assert_array_equal(x[[0, 2]], [[1.0, 1.0], [0.5, 0.5]])
    assert np.isnan(x[1]).all()


@pytest.mark.parametrize("gain", [0.3, slowly(0.8, reason="nearer to where friction locks")])
def test_no_bound_is_broken_by_equations_that_are_as_wrong_as_said(gain: float) -> None:
    chance, error = np.random.default_rng(7), 1e-3
    system = drawn(60, 3, gain, pins=True, seed=5)
    found = solve_coulomb(system)
    errors = friction.CoulombErrors(
        np.full((60, 3), error), np.full((60, 3, 3), error), np.zeros((60, 3))
    )
    sizes = np.hypot(system.influence[..., 0], system.influence[..., 1])
    bound = friction.coulomb_bound(system, errors, found.g, sizes)
    most = np.zeros_like(found.g)
    for _ in range(12):
        angles = chance.uniform(-np.pi, np.pi, (2, 60, 3, 4))
        push = error * np.stack([np.cos(angles), np.sin(angles)], -1)
        alone, influence = system.alone + push[0, :, :, 0], system.influence + push[1, :, :, :3]
        wrong = solve_coulomb(CoulombSystem(alone, influence, system.mu))
        most = np.fmax(most, np.abs(wrong.g - found.g))
    assert np.all(most <= bound)
    told = np.isfinite(bound)
    assert told.mean() > 0.3
    assert np.median(bound[told] / most[told]) < 30.0
